// SPDX-License-Identifier: BSD-3-Clause
#include "map/keyframe_store.hpp"

#include <algorithm>
#include <set>
#include <type_traits>
#include <utility>

#include "core/heap_bytes.hpp"
#include "core/replacement.hpp"

namespace planemap::map {

namespace {

bool is_in_map(const StoredKeyframe& keyframe) {
    return keyframe.world_from_camera.has_value();
}

}  // namespace

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
        intake_.view(keyframe.id, keyframe.utime, keyframe.regions, keyframe.noise, losses);
    return Arrival::kNew;
}

void KeyframeStore::set_pose(int id, const Pose& world_from_camera) {
    if (is_placeable(world_from_camera)) poses_[id] = world_from_camera;
}

KeyframeStore::Motion KeyframeStore::update(const std::vector<KeyframePose>& named,
                                            const MotionLimits& limits, MapLosses& losses) {
    named_ = named;
    Motion motion;
    for (const KeyframePose& pose : named) {
        if (pose.id <= retired_up_to_) continue;
        if (!is_placeable(pose.world_from_camera)) {
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
    looks_.absorb(std::move(other.looks_));
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
    std::size_t bytes = node_bytes(poses_) + node_bytes(keyframes_) + looks_.memory_bytes() +
                        heap_bytes(named_.capacity() * sizeof(KeyframePose));
    for (const auto& [id, keyframe] : keyframes_) bytes += map::memory_bytes(keyframe) - sizeof keyframe;
    return bytes;
}

}  // namespace planemap::map
