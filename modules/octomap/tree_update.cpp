// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/tree_update.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace planemap::octomap {

namespace {

::octomap::OcTreeKey first_of(const Voxel& low, const BlockBits& bits) {
    ::octomap::OcTreeKey key(0, 0, 0);
    bool found = false;
    for_each_voxel(low, bits, [&](const Voxel& v) {
        if (!std::exchange(found, true))
            key = {static_cast<::octomap::key_type>(v.x), static_cast<::octomap::key_type>(v.y),
                   static_cast<::octomap::key_type>(v.z)};
    });
    return key;
}

}  // namespace

void TreeUpdate::update(const Voxel& low, const BlockBits& misses, const BlockBits& hits) {
    const bool any_misses = any(misses), any_hits = any(hits);
    if (!any_misses && !any_hits) return;
    // A node that nothing is known of yet has 0: to set that is to make it, and the root above it.
    if (tree_.getRoot() == nullptr) tree_.setNodeValue(first_of(low, any_misses ? misses : hits), 0, true);
    if (!descend(low, any_misses, any_hits)) return;
    const Child block = path_[kBlockDepth];
    if (!open(block, any_misses, any_hits)) return;
    for (unsigned i = 0; i < 8; ++i)
        if ((misses[i] | hits[i]) != 0) update_octant(child(block.node, i), misses[i], hits[i]);
}

/// The path to the block; false where a leaf above it says already all that is to be said.
bool TreeUpdate::descend(const Voxel& low, bool any_misses, bool any_hits) {
    const auto apart = static_cast<unsigned>((low.x ^ last_.x) | (low.y ^ last_.y) | (low.z ^ last_.z));
    const auto shared = kTreeDepth - static_cast<unsigned>(std::bit_width(apart));
    unsigned depth = std::min(shared, reached_);
    path_[0] = {tree_.getRoot(), false};
    last_ = low;
    for (; depth < kBlockDepth; ++depth) {
        reached_ = depth;
        if (!open(path_[depth], any_misses, any_hits)) return false;
        const unsigned bit = kTreeDepth - 1 - depth;
        const auto i =
            static_cast<unsigned>((low.x >> bit & 1) | (low.y >> bit & 1) << 1 | (low.z >> bit & 1) << 2);
        path_[depth + 1] = child(path_[depth].node, i);
        path_[depth].is_new = false;
    }
    reached_ = depth;
    return true;
}

/// Makes room for children below a node. False for a leaf that stands for all that is below it and stays as
/// it is: what was seen is as sure already as it can be.
bool TreeUpdate::open(const Child& inner, bool any_misses, bool any_hits) {
    if (inner.is_new || tree_.nodeHasChildren(inner.node)) return true;
    const float log_odds = inner.node->getLogOdds();
    if ((!any_misses || log_odds <= tree_.getClampingThresMinLog()) &&
        (!any_hits || log_odds >= tree_.getClampingThresMaxLog()))
        return false;
    tree_.expandNode(inner.node);
    return true;
}

TreeUpdate::Child TreeUpdate::child(Node* node, unsigned i) {
    if (tree_.nodeChildExists(node, i)) return {tree_.getNodeChild(node, i), false};
    return {tree_.createNodeChild(node, i), true};
}

void TreeUpdate::update_octant(const Child& octant, std::uint64_t misses, std::uint64_t hits) {
    if (!open(octant, misses != 0, hits != 0)) return;
    for (unsigned i = 0; i < 8; ++i) {
        const auto missed = static_cast<unsigned>(misses >> 8 * i & 255);
        const auto hit = static_cast<unsigned>(hits >> 8 * i & 255);
        if ((missed | hit) != 0) update_cells(child(octant.node, i), missed, hit);
    }
}

void TreeUpdate::update_cells(const Child& parent, unsigned misses, unsigned hits) {
    if (!open(parent, misses != 0, hits != 0)) return;
    for (unsigned i = 0; i < 8; ++i) {
        if (((misses | hits) >> i & 1) == 0) continue;
        Node* cell = child(parent.node, i).node;
        const bool is_hit = (hits >> i & 1) != 0;
        const float log_odds = cell->getLogOdds() + (is_hit ? tree_.getProbHitLog() : tree_.getProbMissLog());
        cell->setLogOdds(
            std::clamp(log_odds, tree_.getClampingThresMinLog(), tree_.getClampingThresMaxLog()));
    }
}

}  // namespace planemap::octomap
