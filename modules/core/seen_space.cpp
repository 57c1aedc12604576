// SPDX-License-Identifier: BSD-3-Clause
#include "core/seen_space.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace planemap {

namespace {

bool is_before(const std::array<std::int16_t, 3>& a, const std::array<std::int16_t, 3>& b) {
    return std::array{a[2], a[1], a[0]} < std::array{b[2], b[1], b[0]};
}

}  // namespace

bool SeenSpace::Block::is_full() const {
    return std::all_of(free.begin(), free.end(), [](std::uint64_t layer) { return ~layer == 0; });
}

SeenSpace::SeenSpace(std::vector<Block> blocks) : blocks_(std::move(blocks)) {
    if (blocks_.size() > kMostBlocks)
        throw std::invalid_argument("SeenSpace: " + std::to_string(blocks_.size()) + " blocks, at most " +
                                    std::to_string(kMostBlocks) + " are kept");
    std::sort(blocks_.begin(), blocks_.end(),
              [](const Block& a, const Block& b) { return is_before(a.at, b.at); });
    const auto twice = std::adjacent_find(blocks_.begin(), blocks_.end(),
                                          [](const Block& a, const Block& b) { return a.at == b.at; });
    if (twice != blocks_.end()) throw std::invalid_argument("SeenSpace: a block comes twice");
}

std::optional<std::array<std::int16_t, 3>> SeenSpace::block_at(const Eigen::Vector3d& p_world) {
    constexpr double kMost = 32767;
    std::array<std::int16_t, 3> at{};
    for (int i = 0; i < 3; ++i) {
        const double block = std::floor(p_world[i] / kBlock_m);
        if (!(std::abs(block) <= kMost)) return std::nullopt;
        at[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(block);
    }
    return at;
}

bool SeenSpace::is_free(const Eigen::Vector3d& p_world) const {
    const auto at = block_at(p_world);
    if (!at) return false;
    const auto block = std::lower_bound(
        blocks_.begin(), blocks_.end(), *at,
        [](const Block& b, const std::array<std::int16_t, 3>& wanted) { return is_before(b.at, wanted); });
    if (block == blocks_.end() || block->at != *at) return false;
    const Eigen::Vector3d within = (p_world - corner_of(*at)) / kVoxel_m;
    const auto voxel = [&](int axis) {
        return static_cast<unsigned>(std::clamp(static_cast<int>(within[axis]), 0, kSide - 1));
    };
    return block->free[voxel(2)] >> (voxel(0) + kSide * voxel(1)) & 1;
}

double SeenSpace::volume() const {
    double voxels = 0;
    for (const Block& block : blocks_)
        for (const std::uint64_t layer : block.free) voxels += std::popcount(layer);
    return voxels * kVoxel_m * kVoxel_m * kVoxel_m;
}

}  // namespace planemap
