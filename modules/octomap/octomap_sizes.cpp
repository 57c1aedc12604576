// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_sizes.hpp"

#include <fstream>
#include <istream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/heap_bytes.hpp"

namespace planemap::octomap {

namespace {

constexpr char kBtKind[] = "# Octomap OcTree binary file", kOtKind[] = "# Octomap OcTree file";

/// What OctoMap's own write() and writeBinary() begin with; they are not used because they print.
std::string header(const char* kind, const ::octomap::OcTree& tree, std::size_t nodes) {
    std::ostringstream out;
    out << kind << "\n# (feel free to add / change comments, but leave the first line as it is!)\n#\nid "
        << tree.getTreeType() << "\nsize " << nodes << "\nres " << tree.getResolution() << "\ndata\n";
    return std::move(out).str();
}

/// A tree's nodes by kind.
struct Nodes {
    std::size_t inner = 0, leaves = 0;
    std::size_t count() const { return inner + leaves; }
    std::size_t memory_bytes(const ::octomap::OcTree& tree) const {
        using Tree = ::octomap::OcTreeBaseImpl<::octomap::OcTreeNode, ::octomap::AbstractOccupancyOcTree>;
        return sizeof(Tree) + tree.memoryUsageNode() * count() + inner * sizeof(::octomap::OcTreeNode* [8]);
    }
    std::size_t allocated_bytes() const {
        return heap_bytes(sizeof(::octomap::OcTree)) + heap_bytes(sizeof(::octomap::OcTreeNode)) * count() +
               heap_bytes(sizeof(::octomap::OcTreeNode* [8])) * inner;
    }
    /// A .bt file holds two bytes an inner node, and says nothing more of leaves.
    std::size_t bt_bytes(const ::octomap::OcTree& tree) const {
        return header(kBtKind, tree, count()).size() + 2 * inner;
    }
};

/// One walk over a tree counts it, the tree that its .bt file holds, and the occupied part of that.
class Census {
  public:
    explicit Census(const ::octomap::OcTree& tree) : tree_(tree) {
        if (tree.getRoot() != nullptr) count_inner(tree.getRoot(), 0);
    }

    OctomapSizes sizes() const {
        OctomapSizes sizes;
        sizes.memory_bytes = whole_.memory_bytes(tree_);
        sizes.allocated_bytes = whole_.allocated_bytes();
        sizes.bt_bytes = likely_.bt_bytes(tree_);
        sizes.bt_nodes = likely_.count();
        sizes.bt_leaves = likely_.leaves;
        sizes.bt_loaded_memory_bytes = likely_.memory_bytes(tree_);
        sizes.bt_loaded_allocated_bytes = likely_.allocated_bytes();
        sizes.bt_occupied_bytes = occupied_.bt_bytes(tree_);
        // A float and a byte that says which children there are.
        sizes.ot_bytes = header(kOtKind, tree_, whole_.count()).size() + 5 * whole_.count();
        sizes.nodes = whole_.count();
        sizes.leaves = whole_.leaves;
        sizes.occupied_leaves = occupied_leaves_;
        sizes.occupied_voxels = occupied_voxels_;
        return sizes;
    }

    /// Of the tree that the .bt file of the occupied space holds.
    const Nodes& occupied() const { return occupied_; }

  private:
    /// What a node is once each leaf is either free or occupied and equal siblings are one.
    struct Likely {
        bool is_leaf, holds_occupied;
    };

    Likely count(const ::octomap::OcTreeNode* node, unsigned depth) {
        if (tree_.nodeHasChildren(node)) return count_inner(node, depth);
        const bool occupied = tree_.isNodeOccupied(node);
        ++whole_.leaves;
        occupied_leaves_ += occupied;
        if (occupied) occupied_voxels_ += std::size_t{1} << 3 * (tree_.getTreeDepth() - depth);
        return {true, occupied};
    }

    Likely count_inner(const ::octomap::OcTreeNode* node, unsigned depth) {
        ++whole_.inner;
        std::size_t leaves = 0, occupied_leaves = 0;
        bool holds_occupied = false;
        for (unsigned i = 0; i < 8; ++i) {
            if (!tree_.nodeChildExists(node, i)) continue;
            const Likely child = count(tree_.getNodeChild(node, i), depth + 1);
            leaves += child.is_leaf;
            occupied_leaves += child.is_leaf && child.holds_occupied;
            holds_occupied = holds_occupied || child.holds_occupied;
        }
        // The root stays as it is: OctoMap does not prune it.
        if (depth > 0 && leaves == 8 && (occupied_leaves == 0 || occupied_leaves == 8))
            return {true, holds_occupied};
        ++likely_.inner;
        likely_.leaves += leaves;
        occupied_.inner += holds_occupied;
        occupied_.leaves += occupied_leaves;
        return {false, holds_occupied};
    }

    const ::octomap::OcTree& tree_;
    Nodes whole_, likely_, occupied_;
    std::size_t occupied_leaves_ = 0, occupied_voxels_ = 0;
};

}  // namespace

OctomapSizes sizes_of(const ::octomap::OcTree& tree) {
    return Census(tree).sizes();
}

std::string bt_of(const ::octomap::OcTree& tree) {
    ::octomap::OcTree likely(tree);
    likely.toMaxLikelihood();
    likely.prune();
    std::ostringstream out;
    out << header(kBtKind, likely, likely.size());
    if (likely.size() > 0) likely.writeBinaryData(out);
    return std::move(out).str();
}

namespace {

/// Two bytes an inner node, as OctoMap writes them: of each child two bits, 00 unknown, 01 free, 10 occupied
/// (the lower bit first), 11 an inner node, which follows.
void write_occupied(const ::octomap::OcTree& tree, const ::octomap::OcTreeNode* node, std::string& out) {
    unsigned bits = 0;
    std::vector<const ::octomap::OcTreeNode*> inner;
    for (unsigned i = 0; i < 8; ++i) {
        if (!tree.nodeChildExists(node, i)) continue;
        const ::octomap::OcTreeNode* child = tree.getNodeChild(node, i);
        // Of an inner node this is the most likely of its leaves: whether it holds an occupied one.
        if (!tree.isNodeOccupied(child)) continue;
        const bool is_inner = tree.nodeHasChildren(child);
        bits |= (is_inner ? 3U : 2U) << 2 * i;
        if (is_inner) inner.push_back(child);
    }
    out += static_cast<char>(bits & 255);
    out += static_cast<char>(bits >> 8);
    for (const ::octomap::OcTreeNode* child : inner) write_occupied(tree, child, out);
}

}  // namespace

std::string bt_occupied_of(const ::octomap::OcTree& tree) {
    ::octomap::OcTree likely(tree);
    likely.toMaxLikelihood();
    likely.prune();
    std::string out = header(kBtKind, likely, Census(tree).occupied().count());
    if (const ::octomap::OcTreeNode* root = likely.getRoot(); root != nullptr && likely.isNodeOccupied(root))
        write_occupied(likely, root, out);
    return out;
}

std::string ot_of(const ::octomap::OcTree& tree) {
    std::ostringstream out;
    out << header(kOtKind, tree, tree.size());
    tree.writeData(out);
    return std::move(out).str();
}

std::vector<Eigen::Vector3d> occupied_voxels_of(const ::octomap::OcTree& tree) {
    std::vector<Eigen::Vector3d> centres;
    const double edge = tree.getResolution();
    for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
        if (!tree.isNodeOccupied(*leaf)) continue;
        const int n = 1 << (tree.getTreeDepth() - leaf.getDepth());
        const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
        const Eigen::Vector3d first = centre - Eigen::Vector3d::Constant(0.5 * edge * (n - 1));
        for (int z = 0; z < n; ++z)
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) centres.push_back(first + edge * Eigen::Vector3d(x, y, z));
    }
    return centres;
}

namespace {

/// What stands before the nodes of a .bt file.
struct BtHeader {
    std::string id;
    std::size_t nodes = 0;
    double resolution = 0;
};

/// Nothing if there is none that is whole.
std::optional<BtHeader> read_header(std::istream& in) {
    BtHeader header;
    std::string word;
    if (!std::getline(in, word) || word != kBtKind) return std::nullopt;
    while (in >> word && word != "data") {
        if (word == "id")
            in >> header.id;
        else if (word == "size")
            in >> header.nodes;
        else if (word == "res")
            in >> header.resolution;
        std::getline(in, word);  // comments, and keywords of a later version
    }
    in.get();  // the end of its line
    return in && header.resolution > 0 ? std::optional(header) : std::nullopt;
}

/// Walks the nodes of a .bt file: two bytes for each inner node, two bits for each of its children, depth
/// first. OctoMap's own reader goes on behind the end of a file that is cut short.
class BtNodes {
  public:
    explicit BtNodes(std::string_view bytes) : bytes_(bytes) {}
    /// All of them, the root too; nothing if the bytes are not exactly one tree.
    std::optional<std::size_t> count() {
        if (bytes_.empty()) return 0;
        if (!walk(0) || at_ != bytes_.size()) return std::nullopt;
        return nodes_;
    }

  private:
    static constexpr int kDepth = 16, kInner = 3;

    bool walk(int depth) {
        if (depth == kDepth || bytes_.size() - at_ < 2) return false;
        const int children =
            static_cast<std::uint8_t>(bytes_[at_]) | static_cast<std::uint8_t>(bytes_[at_ + 1]) << 8;
        at_ += 2;
        for (int i = 0; i < 8; ++i) {
            const int child = children >> (2 * i) & 3;
            nodes_ += child != 0;
            if (child == kInner && !walk(depth + 1)) return false;
        }
        return true;
    }

    std::string_view bytes_;
    std::size_t at_ = 0, nodes_ = 1;
};

}  // namespace

/// Without OctoMap's own readBinary(), which prints.
std::unique_ptr<::octomap::OcTree> read_bt(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::optional<BtHeader> header = read_header(in);
    const std::string nodes{std::istreambuf_iterator<char>(in), {}};
    auto tree = std::make_unique<::octomap::OcTree>(header ? header->resolution : 1);
    if (!header || header->id != tree->getTreeType() || BtNodes(nodes).count() != header->nodes)
        throw std::runtime_error(file.string() + ": is no OctoMap (.bt), or a damaged one");
    if (nodes.empty()) return tree;
    std::istringstream bytes(nodes);
    tree->readBinaryData(bytes);
    return tree;
}

}  // namespace planemap::octomap
