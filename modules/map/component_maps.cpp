// SPDX-License-Identifier: BSD-3-Clause
#include "map/component_maps.hpp"

#include <algorithm>
#include <utility>

#include "core/components.hpp"

namespace planemap::map {

namespace {
constexpr std::size_t kMaxUnplaced = 4096, kMaxUnplacedLooks = 64;
}

ComponentMaps::ComponentMaps(const MapOptions& options) : options_(options) {
    maps_.try_emplace(kNotNamed, options_, ids_, told_);
    order_ = {kNotNamed};
    // A component that is joined later moves as a whole: what is folded could not.
    options_.fold_after = 0;
}

void ComponentMaps::start_from(const PlaneMap& map, const SeenSpace& seen) {
    maps_.begin()->second.start_from(map, seen);
}

void ComponentMaps::add(const Keyframe& keyframe) {
    const std::optional<int> component = component_of(keyframe.id);
    if (!component) return wait(keyframe);
    map_of(*component).add(keyframe);
}

std::optional<int> ComponentMaps::component_of(int keyframe_id) const {
    const auto named =
        std::lower_bound(last_.keyframes.begin(), last_.keyframes.end(), keyframe_id,
                         [](const KeyframePose& pose, int wanted) { return pose.id < wanted; });
    if (named == last_.keyframes.end() || named->id != keyframe_id) return std::nullopt;
    return named->component;
}

void ComponentMaps::wait(const Keyframe& keyframe) {
    if (is_far_ahead(keyframe.id, newest_id_)) {
        ++losses_.keyframes_far_ahead;
        return;
    }
    newest_id_ = std::max(newest_id_, keyframe.id);
    told_->came(keyframe.id, keyframe.utime);
    if (const auto earlier = waiting_.find(keyframe.id);
        earlier != waiting_.end() && earlier->second.keyframe.utime == keyframe.utime) {
        ++losses_.keyframes_again;
        return;
    }
    Waiting& waiting = waiting_[keyframe.id] = {keyframe, {}};
    waiting.keyframe.features = {};
    if (waiting_.size() <= kMaxUnplaced) return;
    waiting_.erase(waiting_.begin());
    ++losses_.keyframes_unplaced;
}

bool ComponentMaps::add(const Look& look) {
    if (const auto waiting = waiting_.find(look.keyframe_id); waiting != waiting_.end()) {
        if (waiting->second.looks.size() < kMaxUnplacedLooks)
            waiting->second.looks.push_back(look);
        else
            ++losses_.looks_refused;
        return false;
    }
    for (auto& [component, map] : maps_)
        if (map.knows(look)) return map.add(look);
    ++losses_.looks_refused;
    return false;
}

void ComponentMaps::update(const KeyframeTrajectory& trajectory) {
    if (trajectory.keyframes.empty()) return;
    if (auto first = maps_.extract(kNotNamed)) {
        first.key() = trajectory.keyframes.front().component;
        maps_.insert(std::move(first));
    }
    join(trajectory);
    order_ = components(trajectory);
    last_ = trajectory;
    std::erase_if(waiting_, [&](const auto& entry) {
        const auto& [id, came] = entry;
        const std::optional<int> component = component_of(id);
        if (!component) return false;
        map_of(*component).add(came.keyframe);
        for (const Look& look : came.looks) map_of(*component).add(look);
        return true;
    });
    for (const int component : order_)
        if (const auto map = maps_.find(component); map != maps_.end())
            map->second.update(of_component(trajectory, component));
}

/// Maps of components that are part of another one now go over to that.
void ComponentMaps::join(const KeyframeTrajectory& trajectory) {
    std::map<int, int> now_in;  // by the component before
    for (const KeyframePose& keyframe : trajectory.keyframes)
        if (const std::optional<int> before = component_of(keyframe.id)) now_in[*before] = keyframe.component;
    for (const auto& [before, now] : now_in) {
        const auto joined = maps_.find(before);
        if (before == now || joined == maps_.end()) continue;
        PlaneMapper map = std::move(joined->second);
        maps_.erase(joined);
        map_of(now).absorb(std::move(map));
    }
}

PlaneMapper& ComponentMaps::map_of(int component) {
    const auto [map, is_new] = maps_.try_emplace(component, options_, ids_, told_);
    if (is_new) map->second.update(of_component(last_, component));
    return map->second;
}

void ComponentMaps::restore_ids(const Surfaces& surfaces) {
    for (auto& [component, map] : maps_) map.restore_ids(surfaces);
}

void ComponentMaps::settle() {
    for (auto& [component, map] : maps_) map.settle();
}

std::vector<const PlaneMapper*> ComponentMaps::all() const {
    std::vector<const PlaneMapper*> all;
    for (const int component : order_)
        if (const auto map = maps_.find(component); map != maps_.end()) all.push_back(&map->second);
    if (all.empty()) all.push_back(&maps_.begin()->second);
    return all;
}

Surfaces ComponentMaps::surfaces() const {
    Surfaces surfaces;
    for (const auto& [component, map] : maps_) {
        Surfaces more = map.surfaces();
        surfaces.utime = std::max(surfaces.utime, more.utime);
        surfaces.keyframes.insert(surfaces.keyframes.end(), more.keyframes.begin(), more.keyframes.end());
    }
    std::sort(surfaces.keyframes.begin(), surfaces.keyframes.end(),
              [](const auto& a, const auto& b) { return a.id < b.id; });
    return surfaces;
}

MapLosses ComponentMaps::losses() const {
    MapLosses losses = losses_;
    for (const auto& [component, map] : maps_) losses += map.losses();
    return losses;
}

bool ComponentMaps::has_keyframe(int id) const {
    return waiting_.contains(id) || std::any_of(maps_.begin(), maps_.end(), [&](const auto& entry) {
               return entry.second.has_keyframe(id);
           });
}

std::size_t ComponentMaps::keyframes() const {
    std::size_t keyframes = waiting_.size();
    for (const auto& [component, map] : maps_) keyframes += map.keyframes();
    return keyframes;
}

std::size_t ComponentMaps::rebuilds() const {
    std::size_t rebuilds = 0;
    for (const auto& [component, map] : maps_) rebuilds += map.work().rebuilds;
    return rebuilds;
}

std::size_t ComponentMaps::working_bytes() const {
    std::size_t bytes = waiting_.size() * sizeof(Waiting);
    for (const auto& [component, map] : maps_) bytes += map.working_bytes();
    return bytes;
}

}  // namespace planemap::map
