// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/pose.hpp"

namespace planemap {

/// Space that was seen to be empty, in voxels of 10 cm: what is in none of them nobody saw, or something is
/// there. World frame. Blocks of voxels are kept where some are free: 72 bytes of memory for half a cubic
/// metre.
class SeenSpace {
  public:
    static constexpr double kVoxel_m = 0.1;
    static constexpr int kSide = 8;  ///< voxels along a block's edge
    static constexpr double kBlock_m = kSide * kVoxel_m;
    /// As many are kept: 134,000 cubic metres, 18 MB.
    static constexpr std::size_t kMostBlocks = std::size_t{1} << 18;

    struct Block {
        std::array<std::int16_t, 3> at{};         ///< in blocks from the world's origin, x, y, z
        std::array<std::uint64_t, kSide> free{};  ///< of each layer along z: bit x + 8 y

        bool is_full() const;
        friend bool operator==(const Block&, const Block&) = default;
    };

    SeenSpace() = default;
    /// Sorts blocks. Throws std::invalid_argument if one comes twice or there are too many.
    explicit SeenSpace(std::vector<Block> blocks);

    bool empty() const { return blocks_.empty(); }
    /// Whether the voxel that holds the point was seen to be empty. A point that is not finite, or farther
    /// than blocks are counted (26 km), is not.
    bool is_free(const Eigen::Vector3d& p_world) const;
    /// Ascending by z, then y, then x.
    const std::vector<Block>& blocks() const { return blocks_; }
    /// Cubic metres.
    double volume() const;
    std::size_t memory_bytes() const { return blocks_.capacity() * sizeof(Block); }

    /// The block that holds a point; nothing where is_free() is never true.
    static std::optional<std::array<std::int16_t, 3>> block_at(const Eigen::Vector3d& p_world);
    /// The corner of a block with the smallest coordinates, metres.
    static Eigen::Vector3d corner_of(const std::array<std::int16_t, 3>& at) {
        return kBlock_m * Eigen::Vector3d(at[0], at[1], at[2]);
    }

    friend bool operator==(const SeenSpace&, const SeenSpace&) = default;

  private:
    std::vector<Block> blocks_;
};

}  // namespace planemap
