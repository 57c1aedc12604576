// SPDX-License-Identifier: BSD-3-Clause
#include "map/seen_through.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace planemap::map {

namespace {

constexpr double kFarthest_m = 15;
/// Views that look at a block and see through no voxel more of it, before it is asked no more.
constexpr int kMostInVain = 16;
/// Blocks that are looked at, most of which are behind something.
constexpr std::size_t kMostLookedAt = 4 * SeenSpace::kMostBlocks;

using Block = SeenSpace::Block;
constexpr int kSide = SeenSpace::kSide;

std::uint64_t key_of(const std::array<std::int16_t, 3>& at) {
    std::uint64_t key = 0;
    for (const std::int16_t i : at) key = key << 16 | static_cast<std::uint16_t>(i);
    return key;
}

/// Around the pyramid of the image, down to its reach. World frame.
Eigen::AlignedBox3d bounds(const Viewpoint& view) {
    const Sight& sight = view.keyframe->sight;
    const Pose world_from_camera = view.camera_from_world.inverse(Eigen::Isometry);
    const double reach = std::min(sight.reach(), kFarthest_m);
    Eigen::AlignedBox3d box(Eigen::Vector3d(world_from_camera.translation()));
    for (const double u : {sight.low().x(), sight.high().x()})
        for (const double v : {sight.low().y(), sight.high().y()})
            box.extend(world_from_camera * (reach * Eigen::Vector3d(u, v, 1)));
    return box;
}

}  // namespace

void SeenThrough::start_from(const SeenSpace& before) {
    for (const Block& block : before.blocks()) {
        index_.emplace(key_of(block.at), blocks_.size());
        blocks_.push_back({block, 0});
    }
}

void SeenThrough::look(const Viewpoint& view) {
    const Sight& sight = view.keyframe->sight;
    if (!(sight.reach() > 0)) return;
    const Eigen::AlignedBox3d box = bounds(view);
    const auto from = SeenSpace::block_at(box.min()), to = SeenSpace::block_at(box.max());
    if (!from || !to) return;
    const double radius = 0.5 * std::sqrt(3.0) * SeenSpace::kBlock_m;
    const Eigen::Vector3d middle_from_corner =
        view.camera_from_world.linear() * Eigen::Vector3d::Constant(0.5 * SeenSpace::kBlock_m);
    for (int z = (*from)[2]; z <= (*to)[2]; ++z) {
        for (int y = (*from)[1]; y <= (*to)[1]; ++y) {
            for (int x = (*from)[0]; x <= (*to)[0]; ++x) {
                const At at{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y),
                            static_cast<std::int16_t>(z)};
                const Eigen::Vector3d corner = view.camera_from_world * SeenSpace::corner_of(at);
                if (!sight.may_hold(corner + middle_from_corner, radius)) continue;
                LookedAt* block = looked_at(at);
                if (block != nullptr && !see_through(view, corner, block->block)) ++block->in_vain;
            }
        }
    }
}

/// Nothing where no view is asked any more.
SeenThrough::LookedAt* SeenThrough::looked_at(const At& at) {
    const auto [known, is_new] = index_.try_emplace(key_of(at), blocks_.size());
    if (is_new) {
        if (blocks_.size() >= kMostLookedAt) {
            index_.erase(known);
            return nullptr;
        }
        blocks_.push_back({{at, {}}, 0});
    }
    LookedAt& block = blocks_[known->second];
    return block.in_vain >= kMostInVain || block.block.is_full() ? nullptr : &block;
}

/// Whether the view sees through voxels of it that none saw through before.
bool SeenThrough::see_through(const Viewpoint& view, const Eigen::Vector3d& corner, Block& block) const {
    const Eigen::Matrix3d step = SeenSpace::kVoxel_m * view.camera_from_world.linear();
    const Eigen::Vector3d first = corner + step * Eigen::Vector3d::Constant(0.5);
    bool sees = false;
    for (int z = 0; z < kSide; ++z) {
        std::uint64_t& layer = block.free[static_cast<std::size_t>(z)];
        const std::uint64_t was = layer;
        for (int y = 0; y < kSide; ++y) {
            const Eigen::Vector3d row = first + z * step.col(2) + y * step.col(1);
            for (int x = 0; x < kSide; ++x) {
                const std::uint64_t bit = std::uint64_t{1} << (x + kSide * y);
                if ((was & bit) == 0 && is_before_region(view, row + x * step.col(0))) layer |= bit;
            }
        }
        sees = sees || layer != was;
    }
    return sees;
}

bool SeenThrough::is_before_region(const Viewpoint& view, const Eigen::Vector3d& p) const {
    const std::uint8_t region = view.keyframe->sight.region_at(p);
    if (region == Sight::kNone || p.squaredNorm() > kFarthest_m * kFarthest_m) return false;
    const Plane& plane = view.planes[region];
    const double depth = -plane.d / plane.normal.dot(p) * p.z();
    return rules_.is_past(p, plane.normal, depth, view.keyframe->noise).value_or(false);
}

SeenSpace SeenThrough::space() const {
    std::vector<Block> seen;
    for (const LookedAt& at : blocks_)
        if (at.block.free != decltype(at.block.free){} && seen.size() < SeenSpace::kMostBlocks)
            seen.push_back(at.block);
    return SeenSpace(std::move(seen));
}

std::size_t SeenThrough::memory_bytes() const {
    constexpr std::size_t kEntry = 4 * sizeof(void*);  // of the index, about
    return blocks_.capacity() * sizeof(LookedAt) + index_.size() * kEntry;
}

SeenSpace seen_through(SeenThrough known, const std::vector<Viewpoint>& views,
                       const std::function<bool()>& goes_on) {
    constexpr std::size_t kPasses = 16;  // so that those that are looked at are spread over the map
    for (std::size_t pass = 0; pass < kPasses; ++pass) {
        for (std::size_t i = pass; i < views.size(); i += kPasses) {
            if (goes_on && !goes_on()) return known.space();
            known.look(views[i]);
        }
    }
    return known.space();
}

}  // namespace planemap::map
