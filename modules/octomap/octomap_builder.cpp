// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_builder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/angle.hpp"
#include "core/validation.hpp"

namespace planemap {

void OctomapOptions::validate() const {
    FieldErrors errors("OctomapOptions");
    errors.require(resolution_m >= 0.001 && resolution_m <= 10, "resolution_m", resolution_m, "0.001 to 10");
    errors.require(max_range_m >= 0 && max_range_m <= 1000, "max_range_m", max_range_m, "0 to 1000");
    errors.require(subsample >= 1 && subsample <= 64, "subsample", subsample, "1 to 64");
    errors.require(max_keyframes >= 1, "max_keyframes", static_cast<double>(max_keyframes), "at least 1");
    errors.require(moved_m >= 0 && moved_m <= 10, "moved_m", moved_m, "0 to 10");
    errors.require(moved_deg >= 0 && moved_deg <= 180, "moved_deg", moved_deg, "0 to 180");
    errors.throw_if_any();
}

OctomapBuilder::OctomapBuilder(OctomapOptions options) : options_(options) {
    options_.validate();
    tree_ = std::make_unique<octomap::OcTree>(options_.resolution_m);
}

bool OctomapBuilder::add(int keyframe_id, const DepthImage& depth, const CameraInfo& camera,
                         const Pose& world_from_camera) {
    camera.validate();
    if (depth.width != camera.depth.width || depth.height != camera.depth.height) return false;
    if (!keep(keyframe_id, std::make_shared<StoredScan>(depth, camera), world_from_camera)) return false;
    if (!rebuild_due()) {
        while (insert_next({})) continue;
    }
    while (is_full()) freeze_oldest({});
    return true;
}

bool OctomapBuilder::keep(int keyframe_id, std::shared_ptr<const StoredScan> scan,
                          const Pose& world_from_camera) {
    if (!is_valid(world_from_camera) || (last_frozen_ && keyframe_id <= *last_frozen_)) return false;
    Keyframe& keyframe = keyframes_[keyframe_id];
    keyframe.scan = std::move(scan);
    keyframe.world_from_camera = world_from_camera;
    if (last_inserted_ && keyframe_id <= *last_inserted_) mark_misplaced(keyframe);
    return true;
}

bool OctomapBuilder::update(const KeyframeTrajectory& trajectory) {
    poses_.update(trajectory.keyframes);
    poses_.keep_replaced([this](int id) { return keyframes_.contains(id); });
    for (auto& [id, keyframe] : keyframes_) {
        const std::optional<Pose> now = poses_.pose_of(id);
        if (!now || !is_valid(*now)) continue;
        const Pose change = keyframe.world_from_camera.inverse(Eigen::Isometry) * *now;
        if (change.translation().norm() <= options_.moved_m &&
            rotation_angle(change) <= radians(options_.moved_deg)) {
            continue;
        }
        keyframe.world_from_camera = *now;
        if (keyframe.inside) mark_misplaced(keyframe);
    }
    return rebuild_due();
}

void OctomapBuilder::mark_misplaced(Keyframe& keyframe) {
    misplaced_ += !keyframe.misplaced;
    keyframe.misplaced = true;
}

void OctomapBuilder::mark_dirty(const std::vector<Voxel>& blocks) {
    for (const Voxel& block : blocks) dirty_.insert(block);
}

void OctomapBuilder::flush() {
    while (rebuild_next({})) continue;
    while (insert_next({})) continue;
    tidy();
}

bool OctomapBuilder::advance(bool may_rebuild, const std::stop_token& stop) {
    // First what bounds the memory; but a keyframe goes into the tree before it is frozen.
    if (is_full() && last_inserted_ && keyframes_.begin()->first <= *last_inserted_) {
        freeze_oldest(stop);
        return true;
    }
    return insert_next(stop) || (may_rebuild && rebuild_next(stop));
}

void OctomapBuilder::tidy(const std::stop_token& stop) {
    if (!stale_) return;
    bring_up_to_date(*tree_, stop);
    stale_ = false;
}

std::size_t OctomapBuilder::waiting() const {
    const auto next = last_inserted_ ? keyframes_.upper_bound(*last_inserted_) : keyframes_.begin();
    return static_cast<std::size_t>(std::distance(next, keyframes_.end()));
}

std::size_t OctomapBuilder::keyframes_in_tree() const {
    return frozen_ + static_cast<std::size_t>(std::count_if(keyframes_.begin(), keyframes_.end(),
                                                            [](const auto& k) { return k.second.inside; }));
}

void OctomapBuilder::trace(const StoredScan& scan, const Pose& world_from_camera,
                           const std::stop_token& stop) {
    const double max_range = options_.max_range_m > 0 ? options_.max_range_m : scan.camera().depth_max_m;
    inserter_.trace(*tree_, scan.points(world_from_camera, options_.subsample),
                    scan.origin(world_from_camera), max_range, stop);
}

bool OctomapBuilder::insert_next(const std::stop_token& stop) {
    const auto next = last_inserted_ ? keyframes_.upper_bound(*last_inserted_) : keyframes_.begin();
    if (next == keyframes_.end()) return false;
    Keyframe& keyframe = next->second;
    trace(*keyframe.scan, keyframe.world_from_camera, stop);
    inserter_.apply(*tree_, nullptr, stop);
    keyframe.blocks = inserter_.blocks();
    keyframe.inside = true;
    last_inserted_ = next->first;
    stale_ = true;
    if (rebuild_) {
        rebuild_->plan.push_back({next->first, keyframe.scan, keyframe.world_from_camera, keyframe.blocks});
        rebuild_->plan.back().is_new = rebuild_->tree != nullptr;
    }
    return true;
}

bool OctomapBuilder::rebuild_next(const std::stop_token& stop) {
    if (!rebuild_due()) return false;
    if (!rebuild_) {
        begin_rebuild();
        return true;
    }
    Rebuild& rebuild = *rebuild_;
    const auto to_survey = std::find_if(rebuild.plan.begin() + rebuild.surveyed, rebuild.plan.end(),
                                        [](const Planned& planned) { return planned.moved; });
    rebuild.surveyed = to_survey - rebuild.plan.begin();
    if (rebuild.tree == nullptr && !rebuild.everything && to_survey != rebuild.plan.end()) {
        survey(*to_survey, stop);
    } else if (rebuild.tree == nullptr) {
        begin_tree(stop);
    } else {
        const auto to_insert = std::find_if(rebuild.plan.begin() + rebuild.inserted, rebuild.plan.end(),
                                            [&](const Planned& planned) { return is_touched(planned); });
        rebuild.inserted = to_insert - rebuild.plan.begin();
        if (to_insert == rebuild.plan.end()) {
            end_rebuild();
        } else {
            insert_again(*to_insert, stop);
        }
    }
    return true;
}

/// From here on, "misplaced" says what is to be done after this rebuild.
void OctomapBuilder::begin_rebuild() {
    Rebuild& rebuild = rebuild_.emplace();
    // When most of them moved, to look for what they did not touch costs more than it saves.
    rebuild.everything = 2 * misplaced_ > keyframes_.size();
    std::swap(rebuild.dirty, dirty_);
    for (auto& [id, keyframe] : keyframes_) {
        if (!keyframe.inside && !keyframe.misplaced) continue;  // will be inserted into both trees
        rebuild.plan.push_back({id, keyframe.scan, keyframe.world_from_camera, keyframe.blocks});
        rebuild.plan.back().moved = keyframe.misplaced;
        if (!std::exchange(keyframe.misplaced, false)) continue;
        for (const Voxel& block : keyframe.blocks) rebuild.dirty.insert(block);
    }
    misplaced_ = 0;
}

void OctomapBuilder::survey(Planned& planned, const std::stop_token& stop) {
    trace(*planned.scan, planned.world_from_camera, stop);
    planned.blocks = inserter_.blocks();
    planned.moved = false;
    for (const Voxel& block : planned.blocks) rebuild_->dirty.insert(block);
}

void OctomapBuilder::begin_tree(const std::stop_token& stop) {
    if (!rebuild_->everything) {
        rebuild_->tree = composed(*tree_, base_.get(), rebuild_->dirty, stop);
    } else if (base_) {
        rebuild_->tree = std::make_unique<octomap::OcTree>(*base_);
    } else {
        rebuild_->tree = std::make_unique<octomap::OcTree>(options_.resolution_m);
    }
}

bool OctomapBuilder::is_touched(const Planned& planned) const {
    const Rebuild& rebuild = *rebuild_;
    return rebuild.everything || planned.is_new ||
           std::any_of(planned.blocks.begin(), planned.blocks.end(),
                       [&](const Voxel& block) { return rebuild.dirty.contains(block); });
}

void OctomapBuilder::insert_again(Planned& planned, const std::stop_token& stop) {
    Rebuild& rebuild = *rebuild_;
    trace(*planned.scan, planned.world_from_camera, stop);
    const bool whole = rebuild.everything || planned.is_new;
    inserter_.apply(*rebuild.tree, whole ? nullptr : &rebuild.dirty, stop);
    planned.blocks = inserter_.blocks();
    ++rebuild.inserted;
    ++reinserted_;
}

void OctomapBuilder::end_rebuild() {
    tree_ = std::move(rebuild_->tree);
    for (Planned& planned : rebuild_->plan) {
        const auto found = keyframes_.find(planned.id);
        if (found != keyframes_.end()) {
            found->second.blocks = std::move(planned.blocks);
            found->second.inside = true;
        } else if (planned.frozen_aside) {
            mark_dirty(planned.blocks);
        }
    }
    rebuild_.reset();
    stale_ = true;
    ++rebuilds_;
}

void OctomapBuilder::freeze_oldest(const std::stop_token& stop) {
    const auto oldest = keyframes_.begin();
    const Keyframe& keyframe = oldest->second;
    if (!base_) base_ = std::make_unique<octomap::OcTree>(options_.resolution_m);
    trace(*keyframe.scan, keyframe.world_from_camera, stop);
    inserter_.apply(*base_, nullptr, stop);
    if (!keyframe.inside || keyframe.misplaced) {
        // The tree does not hold it, or where it was: the blocks of both places are built anew from base_.
        mark_dirty(keyframe.blocks);
        mark_dirty(inserter_.blocks());
        if (rebuild_) {
            for (Planned& planned : rebuild_->plan)
                planned.frozen_aside = planned.frozen_aside || planned.id == oldest->first;
        }
    }
    misplaced_ -= keyframe.misplaced;
    last_frozen_ = oldest->first;
    keyframes_.erase(oldest);
    ++frozen_;
}

std::vector<Eigen::Vector3d> OctomapBuilder::occupied_voxels() const {
    std::vector<Eigen::Vector3d> centres;
    const double edge = options_.resolution_m;
    for (auto leaf = tree_->begin_leafs(), end = tree_->end_leafs(); leaf != end; ++leaf) {
        if (!tree_->isNodeOccupied(*leaf)) continue;
        const int n = 1 << (tree_->getTreeDepth() - leaf.getDepth());
        const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
        const Eigen::Vector3d first = centre - Eigen::Vector3d::Constant(0.5 * edge * (n - 1));
        for (int i = 0; i < n * n * n; ++i)
            centres.push_back(first + edge * Eigen::Vector3d(i % n, i / n % n, i / (n * n)));
    }
    return centres;
}

std::size_t OctomapBuilder::voxel_cloud_size(double voxel_m) const {
    VoxelSet voxels;
    for (const auto& [id, keyframe] : keyframes_) {
        for (const octomap::point3d& p :
             keyframe.scan->points(keyframe.world_from_camera, options_.subsample)) {
            const Eigen::Array3d cell = (Eigen::Array3d(p.x(), p.y(), p.z()) / voxel_m).floor();
            if (!((cell.abs() < VoxelSet::kMaxCoordinate).all())) continue;
            voxels.insert(
                {static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())});
        }
    }
    return voxels.size();
}

std::size_t OctomapBuilder::stored_bytes() const {
    std::size_t bytes = 0;
    for (const auto& [id, keyframe] : keyframes_)
        bytes += sizeof keyframe + keyframe.scan->bytes() + keyframe.blocks.capacity() * sizeof(Voxel);
    return bytes;
}

std::size_t OctomapBuilder::working_bytes() const {
    std::size_t bytes = stored_bytes() + inserter_.memory_bytes() + tree_->memoryUsage();
    if (base_) bytes += base_->memoryUsage();
    if (rebuild_ && rebuild_->tree) bytes += rebuild_->tree->memoryUsage();
    return bytes;
}

}  // namespace planemap
