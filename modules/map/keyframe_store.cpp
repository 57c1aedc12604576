// SPDX-License-Identifier: BSD-3-Clause
#include "map/keyframe_store.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "core/replacement.hpp"

namespace planemap::map {

namespace {

/// No depth camera sees a region that reaches further from its middle, nor more of them: a raster takes
/// memory.
constexpr double kMaxRegionReach_m = 25;
constexpr std::size_t kMaxRegions = 256;
constexpr std::size_t kMaxRingVertices = 32767;
constexpr double kMaxPoints = 1e9;

bool is_near(const Pose& world_from_camera) {
    return is_valid(world_from_camera) && is_near_origin(world_from_camera.translation());
}

bool is_in_map(const StoredKeyframe& keyframe) {
    return keyframe.world_from_camera.has_value();
}

}  // namespace

/// A valid region whose moments determine a plane, of a size and at a place that a sensor can see.
bool KeyframeStore::is_usable(const PlanarRegion& region) const {
    if (!is_valid(region) || !fit_plane(region.moments).valid) return false;
    const double reach = std::min(max_extent_m_ / 2, kMaxRegionReach_m);
    if (!(region.box.half_extents.norm() <= reach)) return false;
    if (!is_near_origin(region.box.frame_from_box.translation())) return false;
    // Moments, plane and box say the same.
    const Eigen::Vector3d mean = region.moments.mean();
    if (!(region.moments.count <= kMaxPoints)) return false;
    if (!((mean - region.box.frame_from_box.translation()).norm() <= region.box.half_extents.norm() + 1))
        return false;
    if (!(std::abs(region.plane.signed_distance(mean)) <= 1)) return false;
    return std::all_of(region.outline.rings.begin(), region.outline.rings.end(), [&](const Ring& ring) {
        return ring.size() <= kMaxRingVertices &&
               std::all_of(ring.begin(), ring.end(), [&](const auto& v) { return v.norm() <= reach; });
    });
}

/// Which of the regions, by falling number of points.
std::vector<std::size_t> KeyframeStore::usable_regions(const std::vector<PlanarRegion>& regions,
                                                       MapLosses& losses) const {
    std::vector<std::size_t> usable;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        if (!is_usable(regions[i])) {
            ++losses.regions_refused;
        } else if (usable.size() == kMaxRegions) {
            ++losses.regions_too_many;
        } else {
            usable.push_back(i);
        }
    }
    std::stable_sort(usable.begin(), usable.end(), [&](std::size_t a, std::size_t b) {
        return regions[a].moments.count > regions[b].moments.count;
    });
    return usable;
}

StoredKeyframe KeyframeStore::stored_view(int keyframe_id, std::int64_t utime,
                                          const std::vector<PlanarRegion>& regions, const DepthNoise& noise,
                                          MapLosses& losses) const {
    const std::vector<std::size_t> usable = usable_regions(regions, losses);
    std::vector<PlanarRegion> sorted;
    sorted.reserve(usable.size());
    for (const std::size_t i : usable) sorted.push_back(regions[i]);
    StoredKeyframe view = stored(utime, sorted);
    for (std::size_t i = 0; i < usable.size(); ++i) view.regions[i].number = static_cast<int>(usable[i]);
    view.noise = noise;
    view.id = keyframe_id;
    return view;
}

KeyframeStore::Arrival KeyframeStore::add(const Keyframe& keyframe, MapLosses& losses) {
    if (keyframe.id <= retired_up_to_) {  // what it saw is in the planes
        ++losses.keyframes_too_late;
        return Arrival::kRefused;
    }
    if (is_far_ahead(keyframe.id, newest_id_)) {
        ++losses.keyframes_far_ahead;
        return Arrival::kRefused;
    }
    const auto earlier = keyframes_.find(keyframe.id);
    if (earlier != keyframes_.end() && earlier->second.utime == keyframe.utime) {
        ++losses.keyframes_again;
        return Arrival::kRefused;
    }
    if (earlier != keyframes_.end() && is_in_map(earlier->second)) {
        // An odometry that started again: the pose is not its.
        ++losses.keyframes_of_others;
        return Arrival::kRefused;
    }
    newest_id_ = std::max(newest_id_, keyframe.id);
    keyframes_[keyframe.id] =
        stored_view(keyframe.id, keyframe.utime, keyframe.regions, keyframe.noise, losses);
    return Arrival::kNew;
}

/// The keyframe that a look is from near of, or what took its place; none where that is not known.
KeyframeStore::Anchor KeyframeStore::anchor_of(const Look& look) {
    Anchor anchor{nullptr, look.keyframe_from_camera};
    if (!is_near(anchor.keyframe_from_camera)) return anchor;
    int id = look.keyframe_id;
    std::int64_t utime = look.keyframe_utime;
    for (std::size_t i = 0; i <= redirections_.size(); ++i) {
        const auto known = keyframes_.find(id);
        if (known != keyframes_.end()) {
            if (known->second.utime == utime) anchor.keyframe = &known->second;
            return anchor;
        }
        const auto heir = redirections_.find(id);
        if (heir == redirections_.end() || heir->second.utime != utime) return anchor;
        anchor.keyframe_from_camera = heir->second.heir_from_gone * anchor.keyframe_from_camera;
        id = heir->second.heir_id;
        utime = heir->second.heir_utime;
    }
    return anchor;
}

KeyframeStore::Looked KeyframeStore::add(const Look& look, MapLosses& losses) {
    const Anchor anchor = anchor_of(look);
    if (anchor.keyframe == nullptr) {
        ++losses.looks_refused;
        return {};
    }
    StoredKeyframe& keyframe = *anchor.keyframe;
    const auto view_of_look = [&]() -> StoredKeyframe* {
        StoredKeyframe* view = nullptr;
        for_each_view(keyframe, [&](StoredKeyframe& other) {
            if (other.id == look.keyframe_id && other.number == look.number) view = &other;
        });
        // What a keyframe that went saw is what its heir saw, where it was not kept.
        return view == nullptr && look.number == 0 ? &keyframe : view;
    };
    if (StoredKeyframe* view = view_of_look()) {
        const int before = view->looks;
        view->see_again(look.looks, look.utime);
        return {view, view->looks - before, false, keyframe.id};
    }
    if (!look.is_news()) {
        ++losses.looks_refused;
        return {};
    }
    StoredKeyframe news = stored_view(look.keyframe_id, look.utime, look.regions, keyframe.noise, losses);
    news.number = look.number;
    news.keyframe_from_camera = anchor.keyframe_from_camera;
    if (keyframe.world_from_camera)
        news.world_from_camera = *keyframe.world_from_camera * news.keyframe_from_camera;
    keyframe.take_later(std::move(news));
    StoredKeyframe* view = view_of_look();
    return {view, 1, view != nullptr, keyframe.id};
}

void KeyframeStore::redirect_looks(const StoredKeyframe& gone, const StoredKeyframe& heir) {
    constexpr std::size_t kMost = 64;
    redirections_[gone.id] = {gone.utime, heir.id, heir.utime,
                              heir.world_from_camera->inverse(Eigen::Isometry) * *gone.world_from_camera};
    if (redirections_.size() > kMost) redirections_.erase(redirections_.begin());
}

void KeyframeStore::set_pose(int id, const Pose& world_from_camera) {
    if (is_near(world_from_camera)) poses_[id] = world_from_camera;
}

KeyframeStore::Motion KeyframeStore::update(const std::vector<KeyframePose>& named,
                                            const MotionLimits& limits, MapLosses& losses) {
    named_ = named;
    Motion motion;
    for (const KeyframePose& pose : named) {
        if (pose.id <= retired_up_to_) continue;
        if (!is_near(pose.world_from_camera)) {
            ++losses.poses_refused;
            continue;
        }
        poses_[pose.id] = pose.world_from_camera;
        const auto kept = keyframes_.find(pose.id);
        if (kept == keyframes_.end() || !is_in_map(kept->second)) continue;
        const Pose change = kept->second.world_from_camera->inverse(Eigen::Isometry) * pose.world_from_camera;
        motion.any = motion.any || !kept->second.world_from_camera->isApprox(pose.world_from_camera, 0);
        motion.of_note = motion.of_note || change.translation().norm() > limits.distance_m ||
                         rotation_angle(change) > limits.angle_rad;
    }
    return motion;
}

std::vector<StoredKeyframe> KeyframeStore::take_replaced(const std::vector<KeyframePose>& named) {
    const std::vector<Replacement> replaced = replacements(named_, named);
    std::set<int> gone;
    for (const Replacement& replacement : replaced) gone.insert(replacement.id);
    const bool some_stay = std::any_of(keyframes_.begin(), keyframes_.end(), [&](const auto& entry) {
        return is_in_map(entry.second) && !gone.contains(entry.first);
    });
    std::vector<StoredKeyframe> leaving;
    for (const Replacement& replacement : replaced) {
        const auto kept = keyframes_.find(replacement.id);
        const bool leaves = kept != keyframes_.end() && is_in_map(kept->second);
        if (leaves && !some_stay) continue;
        poses_.erase(replacement.id);
        if (!leaves) continue;
        leaving.push_back(std::move(kept->second));
        keyframes_.erase(kept);
    }
    return leaving;
}

std::vector<StoredKeyframe*> KeyframeStore::nearest(const Pose& world_from_camera, std::size_t count) {
    std::vector<std::pair<double, StoredKeyframe*>> near;
    for (auto& [id, keyframe] : keyframes_) {
        if (!is_in_map(keyframe)) continue;
        const Pose apart = world_from_camera.inverse(Eigen::Isometry) * *keyframe.world_from_camera;
        near.emplace_back(apart.translation().norm() + rotation_angle(apart), &keyframe);
    }
    count = std::min(count, near.size());
    const auto last = near.begin() + static_cast<std::ptrdiff_t>(count);
    std::partial_sort(near.begin(), last, near.end(), [](auto& a, auto& b) {
        return std::pair(a.first, a.second->id) < std::pair(b.first, b.second->id);
    });
    std::vector<StoredKeyframe*> result(count);
    std::transform(near.begin(), last, result.begin(), [](auto& a) { return a.second; });
    return result;
}

StoredKeyframe* KeyframeStore::place(int id) {
    const auto pose = poses_.find(id);
    const auto keyframe = keyframes_.find(id);
    if (pose == poses_.end() || keyframe == keyframes_.end()) return nullptr;
    for_each_view(keyframe->second, [&](StoredKeyframe& view) {
        view.world_from_camera = pose->second * view.keyframe_from_camera;
    });
    return &keyframe->second;
}

void KeyframeStore::place_all() {
    for (const auto& [id, keyframe] : keyframes_) place(id);
}

bool KeyframeStore::is_waiting(int id) const {
    const auto keyframe = keyframes_.find(id);
    return keyframe != keyframes_.end() && !is_in_map(keyframe->second);
}

std::size_t KeyframeStore::waiting() const {
    return static_cast<std::size_t>(std::count_if(
        keyframes_.begin(), keyframes_.end(), [](const auto& entry) { return !is_in_map(entry.second); }));
}

std::size_t KeyframeStore::drop_waiting(std::size_t most) {
    std::size_t dropped = 0;
    for (std::size_t n = waiting(); n > most; --n, ++dropped) {
        keyframes_.erase(std::find_if(keyframes_.begin(), keyframes_.end(),
                                      [](const auto& entry) { return !is_in_map(entry.second); }));
    }
    return dropped;
}

void KeyframeStore::absorb(KeyframeStore&& other) {
    keyframes_.merge(other.keyframes_);
    poses_.merge(other.poses_);
    redirections_.merge(other.redirections_);
    named_.insert(named_.end(), other.named_.begin(), other.named_.end());
    newest_id_ = std::max(newest_id_, other.newest_id_);
}

void KeyframeStore::retire_oldest() {
    const int id = keyframes_.begin()->first;
    retired_up_to_ = id;
    poses_.erase(id);
    keyframes_.erase(keyframes_.begin());
}

std::map<int, std::vector<int>> KeyframeStore::sightings() const {
    std::map<int, std::vector<int>> result;
    for (const auto& [id, keyframe] : keyframes_) {
        for_each_view(keyframe, [&, id = id](const StoredKeyframe& view) {
            for (const StoredRegion& region : view.regions) {
                if (region.plane < 0) continue;
                std::vector<int>& ids = result[region.plane];
                if (ids.empty() || ids.back() != id) ids.push_back(id);
            }
        });
    }
    return result;
}

std::size_t KeyframeStore::memory_bytes() const {
    std::size_t bytes = poses_.size() * sizeof(std::pair<int, Pose>);
    for (const auto& [id, keyframe] : keyframes_) bytes += map::memory_bytes(keyframe);
    return bytes;
}

}  // namespace planemap::map
