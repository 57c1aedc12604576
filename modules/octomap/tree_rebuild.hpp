// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <octomap/OcTree.h>

#include <cstddef>
#include <memory>
#include <stop_token>
#include <vector>

#include "octomap/kept_keyframes.hpp"
#include "octomap/keyframe_tracer.hpp"
#include "octomap/tree_blocks.hpp"

namespace planemap::octomap {

/// One rebuild of an OctoMap beside the tree in use, which grows on meanwhile: the blocks that the misplaced
/// keyframes touched or touch now are built anew from all keyframes that see them. What moves after the start
/// is for the next rebuild. In three stages, a scan at a time: survey of the new places, the new tree
/// without those blocks' content, the scans that see them.
class TreeRebuild {
  public:
    /// A keyframe as the rebuild takes it, whatever becomes of it meanwhile.
    struct Planned {
        ScanId id;
        std::shared_ptr<const StoredScan> scan;
        Pose world_from_camera;
        std::vector<Voxel> blocks;  ///< that it touches, as far as is known
        bool moved = false;         ///< the blocks are those of its old place
        bool is_new = false;        ///< no block of the new tree holds it yet, the other ones neither
        bool frozen_aside = false;  ///< was frozen meanwhile, at another pose
    };

    /// Of the keyframes that are in the tree, or came too late for it; the blocks given are built anew too.
    TreeRebuild(const KeptKeyframes& keyframes, BlockSet dirty);

    /// A keyframe that entered the tree in use since the start: it is to be in the new tree too.
    void append(ScanId id, const KeptKeyframe& keyframe);
    /// A keyframe was frozen since the start, at another pose than it is planned with.
    void note_frozen_aside(ScanId id);
    /// Does the work of about one scan. `tree` is the one in use, `base` that of the frozen keyframes (null:
    /// there are none). Returns false when the new tree is complete.
    bool advance(KeyframeTracer& tracer, const ::octomap::OcTree& tree, const ::octomap::OcTree* base,
                 const std::stop_token& stop = {});

    /// The new tree; inner nodes are not brought up to date. Null until the survey is through.
    const std::unique_ptr<::octomap::OcTree>& tree() const { return tree_; }
    std::unique_ptr<::octomap::OcTree> take_tree() { return std::move(tree_); }
    /// The keyframes, ascending id; once the tree is complete, with the blocks that they touch in it.
    std::vector<Planned>& plan() { return plan_; }
    /// Scans inserted again so far.
    std::size_t reinserted() const { return reinserted_; }

  private:
    void survey(Planned& planned, KeyframeTracer& tracer, const ::octomap::OcTree& tree,
                const std::stop_token& stop);
    void begin_tree(const ::octomap::OcTree& tree, const ::octomap::OcTree* base,
                    const std::stop_token& stop);
    bool is_touched(const Planned& planned) const;
    void insert_again(Planned& planned, KeyframeTracer& tracer, const std::stop_token& stop);

    std::vector<Planned> plan_;
    BlockSet dirty_;           ///< blocks that are built anew
    bool everything_ = false;  ///< all are
    std::size_t surveyed_ = 0, inserted_ = 0;
    std::size_t reinserted_ = 0;
    std::unique_ptr<::octomap::OcTree> tree_;  ///< null while the dirty blocks are being found
};

}  // namespace planemap::octomap
