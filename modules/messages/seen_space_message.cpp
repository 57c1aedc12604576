// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "messages/checks.hpp"
#include "messages/convert.hpp"
#include "messages/zip.hpp"

namespace planemap::messages {

namespace {

constexpr std::size_t kVoxelBytes = std::size_t{SeenSpace::kSide} * SeenSpace::kSide,
                      kBlockBytes = 3 * 2 + kVoxelBytes;

/// Where a block's coordinates and voxels are in the bytes that are zipped.
std::size_t coordinate_at(std::size_t block, std::size_t axis, std::size_t blocks) {
    return 2 * (axis * blocks + block);
}
std::size_t voxels_at(std::size_t block, std::size_t blocks) {
    return 6 * blocks + kVoxelBytes * block;
}

}  // namespace

seen_space_t to_message(const SeenSpace& seen, std::int64_t utime, std::int32_t seq, std::int64_t session) {
    constexpr int kSmallest = 12;
    const std::vector<SeenSpace::Block>& blocks = seen.blocks();
    std::vector<std::uint8_t> bytes(kBlockBytes * blocks.size());
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto value = static_cast<std::uint16_t>(blocks[i].at[axis]);
            const std::size_t at = coordinate_at(i, axis, blocks.size());
            bytes[at] = static_cast<std::uint8_t>(value);
            bytes[at + 1] = static_cast<std::uint8_t>(value >> 8);
        }
        for (std::size_t k = 0; k < kVoxelBytes; ++k)
            bytes[voxels_at(i, blocks.size()) + k] =
                static_cast<std::uint8_t>(blocks[i].free[k / 8] >> (8 * (k % 8)));
    }
    seen_space_t message;
    message.utime = utime;
    message.seq = seq;
    message.session = session;
    message.voxel_m = static_cast<float>(SeenSpace::kVoxel_m);
    message.n_blocks = count32(blocks.size());
    message.zipped = zip(bytes, kSmallest);
    message.n_bytes = count32(message.zipped.size());
    return message;
}

SeenSpace from_message(const seen_space_t& message) {
    constexpr std::size_t kMostPacked = 1032;  // bytes that a byte of a zlib stream may stand for
    require(std::abs(message.voxel_m - static_cast<float>(SeenSpace::kVoxel_m)) < 1e-6f, "seen_space.voxel_m",
            "is not 0.1");
    const auto count = static_cast<std::size_t>(std::max(message.n_blocks, 0));
    require(message.n_blocks >= 0 && count <= SeenSpace::kMostBlocks &&
                kBlockBytes * count <= kMostPacked * message.zipped.size(),
            "seen_space.n_blocks", "is negative, or more than there can be");
    std::vector<std::uint8_t> bytes(kBlockBytes * count);
    require(unzip(message.zipped, bytes) == Unzipped::kWhole, "seen_space.zipped",
            "is no zlib stream of n_blocks");
    std::vector<SeenSpace::Block> blocks(count);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t at = coordinate_at(i, axis, count);
            blocks[i].at[axis] = static_cast<std::int16_t>(bytes[at] | bytes[at + 1] << 8);
        }
        for (std::size_t k = 0; k < kVoxelBytes; ++k)
            blocks[i].free[k / 8] |= std::uint64_t{bytes[voxels_at(i, count) + k]} << (8 * (k % 8));
    }
    try {
        return SeenSpace(std::move(blocks));
    } catch (const std::invalid_argument& error) {
        fail("seen_space.zipped", std::string("does not make sense: ") + error.what());
    }
}

}  // namespace planemap::messages
