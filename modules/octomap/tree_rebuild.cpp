// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/tree_rebuild.hpp"

#include <algorithm>
#include <utility>

namespace planemap::octomap {

TreeRebuild::TreeRebuild(const KeptKeyframes& keyframes, BlockSet dirty)
    : dirty_(std::move(dirty)),
      // When most of them moved, to look for what they did not touch costs more than it saves.
      everything_(2 * keyframes.misplaced() > keyframes.size()) {
    for (const auto& [id, keyframe] : keyframes.all()) {
        if (!keyframe.inside && !keyframe.misplaced) continue;  // will be inserted into both trees
        plan_.push_back({id, keyframe.scan, keyframe.world_from_camera, keyframe.blocks});
        plan_.back().moved = keyframe.misplaced;
        if (!keyframe.misplaced) continue;
        for (const Voxel& block : keyframe.blocks) dirty_.insert(block);
    }
}

void TreeRebuild::append(ScanId id, const KeptKeyframe& keyframe) {
    plan_.push_back({id, keyframe.scan, keyframe.world_from_camera, keyframe.blocks});
    plan_.back().is_new = tree_ != nullptr;
}

void TreeRebuild::note_frozen_aside(ScanId id) {
    for (Planned& planned : plan_) planned.frozen_aside = planned.frozen_aside || planned.id == id;
}

bool TreeRebuild::advance(KeyframeTracer& tracer, const ::octomap::OcTree& tree,
                          const ::octomap::OcTree* base, const std::stop_token& stop) {
    const auto first_from = [this](std::size_t start, const auto& is_due) {
        const auto found =
            std::find_if(plan_.begin() + static_cast<std::ptrdiff_t>(start), plan_.end(), is_due);
        return static_cast<std::size_t>(found - plan_.begin());
    };
    surveyed_ = first_from(surveyed_, [](const Planned& planned) { return planned.moved; });
    if (tree_ == nullptr && !everything_ && surveyed_ < plan_.size()) {
        survey(plan_[surveyed_], tracer, tree, stop);
        return true;
    }
    if (tree_ == nullptr) {
        begin_tree(tree, base, stop);
        return true;
    }
    inserted_ = first_from(inserted_, [this](const Planned& planned) { return is_touched(planned); });
    if (inserted_ == plan_.size()) return false;
    insert_again(plan_[inserted_], tracer, stop);
    return true;
}

void TreeRebuild::survey(Planned& planned, KeyframeTracer& tracer, const ::octomap::OcTree& tree,
                         const std::stop_token& stop) {
    tracer.trace(tree, *planned.scan, planned.world_from_camera, stop);
    planned.blocks = tracer.blocks();
    planned.moved = false;
    for (const Voxel& block : planned.blocks) dirty_.insert(block);
}

void TreeRebuild::begin_tree(const ::octomap::OcTree& tree, const ::octomap::OcTree* base,
                             const std::stop_token& stop) {
    if (!everything_) {
        tree_ = composed(tree, base, dirty_, stop);
    } else if (base != nullptr) {
        tree_ = std::make_unique<::octomap::OcTree>(*base);
    } else {
        tree_ = std::make_unique<::octomap::OcTree>(tree.getResolution());
    }
}

bool TreeRebuild::is_touched(const Planned& planned) const {
    return everything_ || planned.is_new ||
           std::any_of(planned.blocks.begin(), planned.blocks.end(),
                       [this](const Voxel& block) { return dirty_.contains(block); });
}

void TreeRebuild::insert_again(Planned& planned, KeyframeTracer& tracer, const std::stop_token& stop) {
    tracer.trace(*tree_, *planned.scan, planned.world_from_camera, stop);
    const bool whole = everything_ || planned.is_new;
    tracer.apply(*tree_, whole ? nullptr : &dirty_, stop);
    planned.blocks = tracer.blocks();
    ++inserted_;
    ++reinserted_;
}

}  // namespace planemap::octomap
