// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_builder.hpp"

#include <utility>

namespace planemap::octomap {

namespace {

OctomapOptions valid(OctomapOptions options) {
    options.validate();
    return options;
}

}  // namespace

OctomapBuilder::OctomapBuilder(OctomapOptions options)
    : options_(valid(options)),
      keyframes_(options_),
      tracer_(options_),
      tree_(std::make_unique<::octomap::OcTree>(options_.resolution_m)) {}

bool OctomapBuilder::add(ScanId id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera,
                         const ScanAnchor& anchor) {
    if (!keep(id, std::move(scan), world_from_camera, anchor)) return false;
    if (!rebuild_due()) {
        while (insert_next({})) continue;
    }
    while (is_full()) freeze_oldest({});
    return true;
}

bool OctomapBuilder::keep(ScanId id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera,
                          const ScanAnchor& anchor) {
    return keyframes_.keep(id, std::move(scan), world_from_camera, anchor);
}

bool OctomapBuilder::update(const KeyframeTrajectory& trajectory) {
    keyframes_.move(trajectory);
    return rebuild_due();
}

void OctomapBuilder::flush() {
    if (listener_ && rebuild_due() && frozen_ == 0) regrow();
    while (rebuild_next({})) continue;
    while (insert_next({})) continue;
    tidy();
}

bool OctomapBuilder::advance(bool may_rebuild, const std::stop_token& stop) {
    // First what bounds the memory; but a keyframe goes into the tree before it is frozen.
    if (is_full() && keyframes_.has_oldest_entered()) {
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

bool OctomapBuilder::insert_next(const std::stop_token& stop) {
    const KeptKeyframes::ById::value_type* next = keyframes_.next_waiting();
    if (next == nullptr) return false;
    const auto& [id, keyframe] = *next;
    insert(id, keyframe, stop);
    if (rebuild_) rebuild_->append(id, keyframe);
    return true;
}

void OctomapBuilder::insert(ScanId id, const KeptKeyframe& keyframe, const std::stop_token& stop) {
    if (listener_) listener_(id, *tree_, false);
    tracer_.trace(*tree_, *keyframe.scan, keyframe.world_from_camera, stop);
    tracer_.apply(*tree_, nullptr, stop);
    if (listener_) listener_(id, *tree_, true);
    keyframes_.enter(id, tracer_.blocks());
    stale_ = true;
}

/// All that is kept, each where it is, as a rebuild of all blocks. Precondition: nothing is frozen.
void OctomapBuilder::regrow() {
    rebuild_.reset();
    dirty_ = {};
    tree_ = std::make_unique<::octomap::OcTree>(options_.resolution_m);
    keyframes_.take_misplaced();
    for (const auto& [id, keyframe] : keyframes_.all()) insert(id, keyframe, {});
    ++rebuilds_;
}

bool OctomapBuilder::rebuild_next(const std::stop_token& stop) {
    if (!rebuild_due()) return false;
    if (!rebuild_) {
        begin_rebuild();
    } else if (!rebuild_->advance(tracer_, *tree_, base_.get(), stop)) {
        end_rebuild();
    }
    return true;
}

void OctomapBuilder::begin_rebuild() {
    rebuild_.emplace(keyframes_, std::exchange(dirty_, BlockSet{}));
    keyframes_.take_misplaced();
}

void OctomapBuilder::end_rebuild() {
    tree_ = rebuild_->take_tree();
    for (TreeRebuild::Planned& planned : rebuild_->plan()) {
        if (keyframes_.holds(planned.id)) {
            keyframes_.rebuilt(planned.id, std::move(planned.blocks));
        } else if (planned.frozen_aside) {
            mark_dirty(planned.blocks);
        }
    }
    rebuild_.reset();
    stale_ = true;
    ++rebuilds_;
}

void OctomapBuilder::freeze_oldest(const std::stop_token& stop) {
    const auto [id, keyframe] = keyframes_.let_oldest_go();
    if (!base_) base_ = std::make_unique<::octomap::OcTree>(options_.resolution_m);
    tracer_.trace(*base_, *keyframe.scan, keyframe.world_from_camera, stop);
    tracer_.apply(*base_, nullptr, stop);
    if (!keyframe.inside || keyframe.misplaced) {
        // The tree does not hold it, or where it was: the blocks of both places are built anew from base_.
        mark_dirty(keyframe.blocks);
        mark_dirty(tracer_.blocks());
        if (rebuild_) rebuild_->note_frozen_aside(id);
    }
    ++frozen_;
}

void OctomapBuilder::mark_dirty(const std::vector<Voxel>& blocks) {
    for (const Voxel& block : blocks) dirty_.insert(block);
}

std::unique_ptr<::octomap::OcTree> OctomapBuilder::tree_at(double resolution_m) const {
    if (frozen_ > 0) return nullptr;
    auto tree = std::make_unique<::octomap::OcTree>(resolution_m);
    KeyframeTracer tracer(options_);
    for (const auto& [id, keyframe] : keyframes_.all()) {
        tracer.trace(*tree, *keyframe.scan, keyframe.world_from_camera);
        tracer.apply(*tree);
    }
    bring_up_to_date(*tree);
    return tree;
}

std::size_t OctomapBuilder::working_bytes() const {
    std::size_t bytes = stored_bytes() + tracer_.memory_bytes() + tree_->memoryUsage();
    if (base_) bytes += base_->memoryUsage();
    if (rebuild_ && rebuild_->tree()) bytes += rebuild_->tree()->memoryUsage();
    return bytes;
}

}  // namespace planemap::octomap
