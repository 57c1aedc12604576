// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/scan_insertion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "octomap/tree_update.hpp"

namespace planemap::octomap {

namespace {

using ::octomap::OcTree;
using ::octomap::OcTreeKey;
using ::octomap::point3d;

Voxel voxel(const OcTreeKey& key) {
    return {key[0], key[1], key[2]};
}

point3d centre_of(const OcTree& tree, const Voxel& v) {
    return tree.keyToCoord(OcTreeKey{static_cast<::octomap::key_type>(v.x),
                                     static_cast<::octomap::key_type>(v.y),
                                     static_cast<::octomap::key_type>(v.z)});
}

/// The bits of a place in its block that are an axis's.
constexpr std::array<unsigned, 3> kAxisBits{spread(7), spread(7) << 1, spread(7) << 2};

}  // namespace

/// The way from cell to cell of OctoMap's computeRayKeys(), with its arithmetic to the last bit, so that it
/// passes the same cells; but a cell is known by its block and its place there, and a step changes a few
/// bits of the place.
class ScanInserter::Ray {
  public:
    Ray(const OcTree& tree, const point3d& origin, const OcTreeKey& from, const point3d& end,
        const OcTreeKey& to)
        : block_{from[0] & ~7, from[1] & ~7, from[2] & ~7}, place_(place_of(voxel(from))) {
        point3d direction = end - origin;
        length_ = static_cast<float>(direction.norm());
        direction /= length_;
        for (unsigned i = 0; i < 3; ++i) {
            steps_to_end_ += std::abs(to[i] - from[i]);
            const bool ahead = direction(i) > 0;
            const int step = ahead ? 1 : direction(i) < 0 ? -1 : 0;
            edge_[i] = ahead ? kAxisBits[i] : 0;
            // Less the lowest bit is one back; less all bits is one on, as carries run through the others'.
            less_[i] = ahead ? kAxisBits[i] : 1U << i;
            block_step_[i] = 8 * step;
            if (step == 0) continue;
            double border = tree.keyToCoord(from[i]);
            border += static_cast<float>(step * tree.getResolution() * 0.5);
            next_[i] = (border - origin(i)) / direction(i);
            apart_[i] = tree.getResolution() / std::fabs(direction(i));
        }
        to_ = voxel(to);
    }

    /// Calls pass(block, place) for the cells in between: from the first on, but for the last, or what would
    /// lie beyond the ray's length. Three lengths in registers, and a branch for each axis: what is passed
    /// next is guessed right more often than an index of the least can be waited for.
    template <typename Enter, typename Pass>
    void walk(const Enter& enter, const Pass& pass) {
        double x = next_[0], y = next_[1], z = next_[2];
        enter(block_);
        while (true) {
            pass(place_);
            bool leaves = false;
            if (x < y && x < z) {
                x += apart_[0];
                leaves = advance<0>();
            } else if (!(x < y) && y < z) {
                y += apart_[1];
                leaves = advance<1>();
            } else {
                z += apart_[2];
                leaves = advance<2>();
            }
            if (--steps_to_end_ == 0 && is_at_end()) return;
            if (std::min(std::min(x, y), z) > length_) return;
            if (leaves) enter(block_);
        }
    }

  private:
    static constexpr double kNever = std::numeric_limits<double>::max();

    /// One cell on; true when it is another block's.
    template <unsigned kAxis>
    bool advance() {
        constexpr unsigned kBits = kAxisBits[kAxis];
        const unsigned own = place_ & kBits;
        place_ = (place_ & ~kBits) | ((own - less_[kAxis]) & kBits);
        if (own != edge_[kAxis]) return false;
        std::int32_t& c = kAxis == 0 ? block_.x : kAxis == 1 ? block_.y : block_.z;
        c = (c + block_step_[kAxis]) & std::numeric_limits<::octomap::key_type>::max();
        return true;
    }
    bool is_at_end() const {
        return place_ == place_of(to_) && block_ == Voxel{to_.x & ~7, to_.y & ~7, to_.z & ~7};
    }

    Voxel block_;  ///< its lowest cell
    unsigned place_;
    float length_ = 0;
    std::array<double, 3> next_{kNever, kNever,
                                kNever};  ///< length at which the next cell along an axis begins
    std::array<double, 3> apart_{kNever, kNever, kNever};  ///< and those after it
    std::array<unsigned, 3> edge_{}, less_{};
    std::array<int, 3> block_step_{};
    int steps_to_end_ = 0;  ///< it is reached after exactly as many, or never
    Voxel to_;
};

/// One ray to the centre of each cell that was hit, as OctoMap's computeUpdate() casts them.
void ScanInserter::trace(const OcTree& tree, std::span<const point3d> points, const point3d& origin,
                         double max_range, const std::stop_token& stop) {
    cells_.clear();
    Voxel last{-1, -1, -1};
    for (const point3d& p : points) {
        OcTreeKey end;
        if (!tree.coordToKeyChecked(p, end)) continue;
        const Voxel v = voxel(end);
        if (v == last) continue;  // as its neighbour in the image mostly is
        last = v;
        const unsigned place = place_of(v);
        cells_.at(v).hit[word_of(place)] |= bit_of(place);
    }
    // Rays add blocks, which hold no ends.
    for (std::size_t i = 0, blocks = cells_.size(); i < blocks && !stop.stop_requested(); ++i) {
        const BlockBits ends = cells_[i].hit;
        for_each_voxel(cells_.low(i), ends, [&](const Voxel& v) {
            point3d end = centre_of(tree, v);
            if (max_range >= 0 && (end - origin).norm() > max_range) {
                const unsigned place = place_of(v);
                cells_[i].hit[word_of(place)] &= ~bit_of(place);
                end = origin + (end - origin).normalized() * static_cast<float>(max_range);
            }
            cast(tree, origin, end);
        });
    }
}

void ScanInserter::cast(const OcTree& tree, const point3d& origin, const point3d& end) {
    OcTreeKey from, to;
    if (!tree.coordToKeyChecked(origin, from) || !tree.coordToKeyChecked(end, to) || from == to) return;
    BlockBits* passed = nullptr;
    Ray(tree, origin, from, end, to)
        .walk([&](const Voxel& block) { passed = &cells_.at(block).passed; },
              [&](unsigned place) { (*passed)[word_of(place)] |= bit_of(place); });
}

void ScanInserter::apply(OcTree& tree, const BlockSet* only, const std::stop_token& stop) const {
    TreeUpdate update(tree);
    for (std::size_t i = 0; i < cells_.size() && !stop.stop_requested(); ++i) {
        const Voxel low = cells_.low(i);
        if (only != nullptr && !only->contains(block_of(low))) continue;
        BlockBits missed = cells_[i].passed;
        for (std::size_t word = 0; word < missed.size(); ++word) missed[word] &= ~cells_[i].hit[word];
        update.update(low, missed, cells_[i].hit);
    }
}

std::vector<Voxel> ScanInserter::blocks() const {
    BlockSet blocks;
    for (std::size_t i = 0; i < cells_.size(); ++i)
        if (any(cells_[i].passed) || any(cells_[i].hit)) blocks.insert(block_of(cells_.low(i)));
    std::vector<Voxel> list;
    list.reserve(blocks.size());
    blocks.for_each([&](const Voxel& block) { list.push_back(block); });
    return list;
}

}  // namespace planemap::octomap
