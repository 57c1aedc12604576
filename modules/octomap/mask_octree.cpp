// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/mask_octree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace planemap::octomap {

namespace {

/// Three bits a level: z, y, x.
std::uint64_t interleaved(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    std::uint64_t code = 0;
    for (unsigned bit = 0; bit < 21; ++bit)
        code |= std::uint64_t{x >> bit & 1} << 3 * bit | std::uint64_t{y >> bit & 1} << (3 * bit + 1) |
                std::uint64_t{z >> bit & 1} << (3 * bit + 2);
    return code;
}

void put_u32(std::uint32_t value, std::string& out) {
    for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>(value >> shift & 255);
}

/// The parents of a level's nodes, and a byte for each; the nodes ascend.
std::string masks_of(const std::vector<std::uint64_t>& nodes, std::vector<std::uint64_t>& parents) {
    std::string masks;
    parents.clear();
    for (const std::uint64_t node : nodes) {
        if (parents.empty() || parents.back() != node >> 3) {
            parents.push_back(node >> 3);
            masks += '\0';
        }
        masks.back() = static_cast<char>(static_cast<unsigned char>(masks.back()) | 1U << (node & 7));
    }
    return masks;
}

}  // namespace

std::string mask_octree(const std::vector<Voxel>& cells) {
    Voxel low{0, 0, 0}, high{0, 0, 0};
    if (!cells.empty()) low = high = cells.front();
    for (const Voxel& c : cells) {
        low = {std::min(low.x, c.x), std::min(low.y, c.y), std::min(low.z, c.z)};
        high = {std::max(high.x, c.x), std::max(high.y, c.y), std::max(high.z, c.z)};
    }
    const std::int32_t span = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    const int depth = std::bit_width(static_cast<std::uint32_t>(span));
    std::vector<std::uint64_t> nodes, parents;
    nodes.reserve(cells.size());
    for (const Voxel& c : cells)
        nodes.push_back(interleaved(static_cast<std::uint32_t>(c.x - low.x),
                                    static_cast<std::uint32_t>(c.y - low.y),
                                    static_cast<std::uint32_t>(c.z - low.z)));
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::vector<std::string> levels;
    for (int level = 0; level < depth; ++level) {
        levels.push_back(masks_of(nodes, parents));
        nodes.swap(parents);
    }
    std::string out;
    for (const std::int32_t c : {low.x, low.y, low.z}) put_u32(static_cast<std::uint32_t>(c), out);
    out += static_cast<char>(depth);
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) out += *level;
    return out;
}

std::vector<Voxel> cells_at(const std::vector<Eigen::Vector3d>& centres, double edge_m) {
    std::vector<Voxel> cells;
    cells.reserve(centres.size());
    for (const Eigen::Vector3d& centre : centres) {
        const Eigen::Array3d cell = (centre.array() / edge_m).floor();
        cells.push_back({static_cast<int>(cell.x()), static_cast<int>(cell.y()), static_cast<int>(cell.z())});
    }
    return cells;
}

std::unique_ptr<::octomap::OcTree> tree_of(const std::vector<Eigen::Vector3d>& centres, double resolution_m) {
    auto tree = std::make_unique<::octomap::OcTree>(resolution_m);
    for (const Eigen::Vector3d& c : centres)
        tree->setNodeValue(tree->coordToKey(c.x(), c.y(), c.z()), tree->getClampingThresMaxLog(), true);
    tree->updateInnerOccupancy();
    tree->prune();
    return tree;
}

}  // namespace planemap::octomap
