// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/tree_blocks.hpp"

namespace planemap::octomap {

namespace {

using Node = ::octomap::OcTreeNode;
using Tree = ::octomap::OcTree;

/// A tree that is put together from two others. (To copy all and delete the blocks is no way: OctoMap's
/// deleteNode() leaks what is below an inner node and miscounts.)
class Composition : public Tree {
  public:
    Composition(const Tree& outside, const Tree* inside, const BlockSet& blocks, const std::stop_token& stop)
        : Tree(outside.getResolution()), blocks_(blocks), stop_(stop) {
        const Part all{outside.getRoot(), inside != nullptr ? inside->getRoot() : nullptr, {}, 0};
        if (!holds_any(all)) return;
        root = new Node;  // as OctoMap's own functions do; the base class owns it
        ++tree_size;
        compose(root, all);
    }

  private:
    /// A node of both trees at one place. A leaf stands for all that could be below it.
    struct Part {
        const Node *outside, *inside;
        Voxel low;  ///< its lowest cell
        unsigned depth;
    };

    Part child(const Part& part, unsigned i) const {
        const int half = 1 << (tree_depth - 1 - part.depth);
        const int x = i & 1 ? half : 0, y = i & 2 ? half : 0, z = i & 4 ? half : 0;
        return {child(part.outside, i),
                child(part.inside, i),
                {part.low.x + x, part.low.y + y, part.low.z + z},
                part.depth + 1};
    }
    const Node* child(const Node* node, unsigned i) const {
        if (node == nullptr || !nodeHasChildren(node)) return node;
        return nodeChildExists(node, i) ? getNodeChild(node, i) : nullptr;
    }
    bool is_block(const Part& part) const { return part.depth + kBlockBits == tree_depth; }
    const Node* content(const Part& block) const {
        return blocks_.contains(block_of(block.low)) ? block.inside : block.outside;
    }

    bool holds_any(const Part& part) const {
        if (part.outside == nullptr && part.inside == nullptr) return false;
        if (is_block(part)) return content(part) != nullptr;
        for (unsigned i = 0; i < 8; ++i) {
            if (holds_any(child(part, i))) return true;
        }
        return false;
    }
    void compose(Node* node, const Part& part) {
        if (is_block(part)) return copy(node, content(part));
        for (unsigned i = 0; i < 8; ++i) {
            const Part below = child(part, i);
            if (holds_any(below)) compose(createNodeChild(node, i), below);
        }
    }
    void copy(Node* node, const Node* from) {
        node->copyData(*from);
        if (!nodeHasChildren(from) || stop_.stop_requested()) return;
        for (unsigned i = 0; i < 8; ++i) {
            if (nodeChildExists(from, i)) copy(createNodeChild(node, i), getNodeChild(from, i));
        }
    }

    const BlockSet& blocks_;
    const std::stop_token& stop_;
};

void bring_up_to_date(Tree& tree, Node* node, unsigned depth, const std::stop_token& stop) {
    if (!tree.nodeHasChildren(node) || stop.stop_requested()) return;
    for (unsigned i = 0; i < 8; ++i) {
        if (tree.nodeChildExists(node, i))
            bring_up_to_date(tree, tree.getNodeChild(node, i), depth + 1, stop);
    }
    // OctoMap does not prune the root.
    if (depth == 0 || !tree.pruneNode(node)) node->updateOccupancyChildren();
}

}  // namespace

std::unique_ptr<Tree> composed(const Tree& outside, const Tree* inside, const BlockSet& blocks,
                               const std::stop_token& stop) {
    Composition composition(outside, inside, blocks, stop);
    auto tree = std::make_unique<Tree>(outside.getResolution());
    composition.swapContent(*tree);
    return tree;
}

void bring_up_to_date(Tree& tree, const std::stop_token& stop) {
    if (tree.getRoot() != nullptr) bring_up_to_date(tree, tree.getRoot(), 0, stop);
}

}  // namespace planemap::octomap
