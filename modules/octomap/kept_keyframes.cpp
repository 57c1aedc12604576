// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/kept_keyframes.hpp"

#include <algorithm>
#include <iterator>
#include <set>

#include "core/geometry/angle.hpp"

namespace planemap::octomap {

bool KeptKeyframes::keep(ScanId id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera,
                         const ScanAnchor& anchor) {
    if (!is_valid(world_from_camera) || (last_gone_ && id <= *last_gone_)) return false;
    KeptKeyframe& keyframe = keyframes_[id];
    keyframe.scan = std::move(scan);
    keyframe.world_from_camera = world_from_camera;
    keyframe.anchor = anchor;
    if (last_entered_ && id <= *last_entered_) mark_misplaced(keyframe);
    return true;
}

void KeptKeyframes::move(const KeyframeTrajectory& trajectory) {
    poses_.update(trajectory.keyframes);
    std::set<int> anchors;
    for (const auto& [id, keyframe] : keyframes_) anchors.insert(keyframe.anchor.keyframe_id);
    poses_.keep_replaced([&](int id) { return anchors.contains(id); });
    for (auto& [id, keyframe] : keyframes_) {
        const std::optional<Pose> anchor = poses_.pose_of(keyframe.anchor.keyframe_id);
        if (!anchor || !is_valid(*anchor)) continue;
        const Pose now = *anchor * keyframe.anchor.keyframe_from_camera;
        const Pose change = keyframe.world_from_camera.inverse(Eigen::Isometry) * now;
        if (change.translation().norm() <= moved_m_ && rotation_angle(change) <= radians(moved_deg_)) {
            continue;
        }
        keyframe.world_from_camera = now;
        if (keyframe.inside) mark_misplaced(keyframe);
    }
}

void KeptKeyframes::mark_misplaced(KeptKeyframe& keyframe) {
    misplaced_ += !keyframe.misplaced;
    keyframe.misplaced = true;
}

KeptKeyframes::ById::const_iterator KeptKeyframes::first_waiting() const {
    return last_entered_ ? keyframes_.upper_bound(*last_entered_) : keyframes_.begin();
}

std::size_t KeptKeyframes::waiting() const {
    return static_cast<std::size_t>(std::distance(first_waiting(), keyframes_.end()));
}

std::size_t KeptKeyframes::inside() const {
    return static_cast<std::size_t>(
        std::count_if(keyframes_.begin(), keyframes_.end(), [](const auto& k) { return k.second.inside; }));
}

bool KeptKeyframes::has_oldest_entered() const {
    return last_entered_ && !keyframes_.empty() && keyframes_.begin()->first <= *last_entered_;
}

std::size_t KeptKeyframes::bytes() const {
    std::size_t bytes = 0;
    for (const auto& [id, keyframe] : keyframes_)
        bytes += sizeof keyframe + keyframe.scan->bytes() + keyframe.blocks.capacity() * sizeof(Voxel);
    return bytes;
}

VoxelSet KeptKeyframes::voxel_cloud(double voxel_m, int subsample) const {
    VoxelSet voxels;
    for (const auto& [id, keyframe] : keyframes_) {
        for (const ::octomap::point3d& p : keyframe.scan->points(keyframe.world_from_camera, subsample)) {
            const Eigen::Array3d cell = (Eigen::Array3d(p.x(), p.y(), p.z()) / voxel_m).floor();
            if (!((cell.abs() < VoxelSet::kMaxCoordinate).all())) continue;
            voxels.insert(
                {static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())});
        }
    }
    return voxels;
}

const KeptKeyframes::ById::value_type* KeptKeyframes::next_waiting() const {
    const auto next = first_waiting();
    return next == keyframes_.end() ? nullptr : &*next;
}

void KeptKeyframes::enter(ScanId id, std::vector<Voxel> blocks) {
    rebuilt(id, std::move(blocks));
    last_entered_ = id;
}

void KeptKeyframes::take_misplaced() {
    for (auto& [id, keyframe] : keyframes_) keyframe.misplaced = false;
    misplaced_ = 0;
}

void KeptKeyframes::rebuilt(ScanId id, std::vector<Voxel> blocks) {
    KeptKeyframe& keyframe = keyframes_.at(id);
    keyframe.blocks = std::move(blocks);
    keyframe.inside = true;
}

std::pair<ScanId, KeptKeyframe> KeptKeyframes::let_oldest_go() {
    auto oldest = keyframes_.extract(keyframes_.begin());
    misplaced_ -= oldest.mapped().misplaced;
    last_gone_ = oldest.key();
    return {oldest.key(), std::move(oldest.mapped())};
}

}  // namespace planemap::octomap
