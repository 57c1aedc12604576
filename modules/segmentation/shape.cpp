// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/shape.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace planemap::segmentation {

namespace {

/// A block of the label image; kSide > 0 is its width and height, which the compiler then knows.
template <int kSide>
struct Block {
    const std::uint16_t* first;
    std::ptrdiff_t stride;
    int given_width, given_height;

    int width() const { return kSide > 0 ? kSide : given_width; }
    int height() const { return kSide > 0 ? kSide : given_height; }
    std::uint16_t at(int u, int v) const { return first[v * stride + u]; }

    bool uniform() const {
        std::uint16_t changes = 0;
        for (int v = 0; v < height(); ++v) {
            for (int u = 0; u < width(); ++u) changes |= static_cast<std::uint16_t>(at(u, v) ^ at(0, 0));
        }
        return changes == 0;
    }
    int count(std::uint16_t label) const {
        std::uint16_t total = 0;
        for (int v = 0; v < height(); ++v) {
            for (int u = 0; u < width(); ++u) total = static_cast<std::uint16_t>(total + (at(u, v) == label));
        }
        return total;
    }
    /// The label that more than half of the pixels carry, else 0.
    std::uint16_t majority() const {
        const int pixels = width() * height();
        const std::uint16_t middle = at(width() / 2, height() / 2), corner = at(0, 0);
        if (2 * count(middle) > pixels) return middle;
        if (corner != middle && 2 * count(corner) > pixels) return corner;
        std::uint16_t candidate = 0;
        int votes = 0;  // Boyer and Moore: what outweighs all others together is left over
        for (int v = 0; v < height(); ++v) {
            for (int u = 0; u < width(); ++u) {
                if (votes == 0) candidate = at(u, v);
                votes += at(u, v) == candidate ? 1 : -1;
            }
        }
        return 2 * count(candidate) > pixels ? candidate : std::uint16_t{0};
    }
};

/// As four labels are compared at once.
template <>
bool Block<4>::uniform() const {
    std::array<std::uint64_t, 4> rows;
    for (std::size_t v = 0; v < 4; ++v)
        std::memcpy(&rows[v], first + static_cast<std::ptrdiff_t>(v) * stride, sizeof(rows[v]));
    const std::uint64_t all = *first * std::uint64_t{0x0001000100010001};
    return ((rows[0] ^ all) | (rows[1] ^ all) | (rows[2] ^ all) | (rows[3] ^ all)) == 0;
}

template <>
int Block<4>::count(std::uint16_t label) const {
    // The highest bit of each 16 is set where a label is another, after x | (x without it + 0x7fff).
    constexpr std::uint64_t kLow = 0x7fff7fff7fff7fff, kOne = 0x0001000100010001;
    int others = 0;
    for (int v = 0; v < 4; ++v) {
        std::uint64_t row;
        std::memcpy(&row, first + v * stride, sizeof(row));
        row ^= label * kOne;
        others += std::popcount((row | ((row & kLow) + kLow)) & ~kLow);
    }
    return 16 - others;
}

/// True when 16 columns of four rows carry one label.
bool uniform_strip(const std::uint16_t* first, std::ptrdiff_t stride) {
    std::array<std::uint16_t, 16> all, changes{};
    all.fill(*first);
    for (int v = 0; v < 4; ++v) {
        for (std::size_t u = 0; u < 16; ++u)
            changes[u] |=
                static_cast<std::uint16_t>(first[v * stride + static_cast<std::ptrdiff_t>(u)] ^ all[u]);
    }
    std::array<std::uint64_t, 4> any;
    std::memcpy(any.data(), changes.data(), sizeof(any));
    return (any[0] | any[1] | any[2] | any[3]) == 0;
}

/// Where the ray through a pixel meets the plane; the point of the plane nearest to the ray's point at
/// `farthest_m` along the optical axis if that is nearer or there is no meeting.
Eigen::Vector3d ray_on_plane(const PinholeCamera& camera, const Plane& plane, const Eigen::Vector2d& pixel,
                             double farthest_m) {
    const Eigen::Vector3d ray = camera.unproject(pixel.x(), pixel.y(), 1.0);
    const double inverse_depth = -plane.normal.dot(ray) / plane.d;
    return plane.project(ray / std::max(inverse_depth, 1.0 / farthest_m));
}

}  // namespace

DepthRange::DepthRange(const CameraInfo& camera) {
    const double first = std::ceil(camera.depth_min_m * camera.depth_units_per_metre);
    const double last = std::floor(camera.depth_max_m * camera.depth_units_per_metre);
    if (first > 65534.0 || last < 1.0) return;
    low = static_cast<std::uint16_t>(std::max(first, 1.0));
    high = static_cast<std::uint16_t>(std::min(last, 65534.0));
}

void ShapeTracer::recycle(std::vector<PlanarRegion>& regions) {
    for (PlanarRegion& region : regions) {
        std::vector<Ring>& rings = region.outline.rings;
        if (rings.capacity() == 0) continue;
        for (Ring& ring : rings) spare_rings_.push_back(std::move(ring));
        rings.clear();
        spare_lists_.push_back(std::move(rings));
        rings = {};
    }
}

template <int kSide>
void ShapeTracer::find_blocks(const Image<std::uint16_t>& labels) {
    for (int y = 0; y < blocks_.height - 2; ++y) {
        std::uint16_t* out = blocks_.row(y + 1) + 1;
        const int v = y * block_px_, height = std::min(block_px_, labels.height - v);
        const std::uint16_t* row = labels.row(v);
        const int whole = height == block_px_ ? labels.width / block_px_ : 0;
        int x = 0;
        while (x < whole) {
            const std::uint16_t* first = row + static_cast<std::ptrdiff_t>(x) * block_px_;
            if constexpr (kSide == 4) {
                // Most of the image is the inside of regions: four blocks at once.
                if (x + 4 <= whole && uniform_strip(first, labels.width)) {
                    std::fill_n(out + x, 4, *first);
                    x += 4;
                    continue;
                }
            }
            const Block<kSide> block{first, labels.width, block_px_, block_px_};
            out[x++] = block.uniform() ? *block.first : block.majority();
        }
        for (; x < blocks_.width - 2; ++x) {
            const int u = x * block_px_, width = std::min(block_px_, labels.width - u);
            out[x] = Block<0>{row + u, labels.width, width, height}.majority();
        }
    }
}

void ShapeTracer::find_blocks(const Image<std::uint16_t>& labels, int block_px) {
    block_px_ = block_px;
    blocks_.width = (labels.width + block_px - 1) / block_px + 2;
    blocks_.height = (labels.height + block_px - 1) / block_px + 2;
    blocks_.pixels.assign(static_cast<std::size_t>(blocks_.width) * static_cast<std::size_t>(blocks_.height),
                          0);
    switch (block_px) {
        case 2:
            return find_blocks<2>(labels);
        case 4:
            return find_blocks<4>(labels);
        case 8:
            return find_blocks<8>(labels);
        default:
            return find_blocks<0>(labels);
    }
}

// Not Bitmap::trace(): that follows corners of cells that are set or not, one shape at a time; this one
// follows the midpoints of edges, which make staircases straight, of all labels at once.
void ShapeTracer::follow(int x, int y, std::uint16_t label) {
    // From corner to corner of the blocks with the label to the left of the way (x right, y up), starting
    // along the upper edge (smallest y) of block (x, y). The ring goes through the midpoints of the edges: a
    // staircase becomes a straight line, and parts of the boundary that are not neighbours end up at least
    // sqrt(1/2) apart, so that a simplification within half of that cannot make them cross. Of a straight run
    // only the midpoints of the first and the last edge are kept.
    constexpr std::array<int, 4> kDx{1, 0, -1, 0}, kDy{0, 1, 0, -1};
    // The blocks in front of a corner, to the left and to the right of the way.
    constexpr std::array<int, 4> kLeftX{0, -1, -1, 0}, kLeftY{0, 0, -1, -1};
    constexpr std::array<int, 4> kRightX{0, 0, -1, -1}, kRightY{-1, 0, 0, -1};
    ring_.clear();
    const std::uint16_t* blocks = blocks_.pixels.data();
    const int width = blocks_.width, start_x = x, start_y = y;
    int direction = 0, run = 0;
    do {
        if (direction == 0) followed_[y * width + x] = 1;
        const Eigen::Vector2d middle(x + 0.5 * kDx[direction], y + 0.5 * kDy[direction]);
        x += kDx[direction];
        y += kDy[direction];
        const bool left = blocks[(y + kLeftY[direction]) * width + x + kLeftX[direction]] == label;
        const bool right = blocks[(y + kRightY[direction]) * width + x + kRightX[direction]] == label;
        // Blocks that touch at a corner stay apart.
        const int turn = !left ? 1 : !right ? 0 : 3;
        if (run == 0 || turn != 0) ring_.push_back(middle);
        run = turn == 0 ? run + 1 : 0;
        direction = (direction + turn) % 4;
    } while (x != start_x || y != start_y || direction != 0);
}

void ShapeTracer::add_ring(std::vector<PlanarRegion>& regions, std::uint16_t label) {
    constexpr double kTolerance = 0.35;  // of a block, see follow()
    simplifier_.simplify(ring_, kTolerance);
    if (ring_.empty()) return;
    longest_ring_ = std::max(longest_ring_, ring_.size());
    Ring ring;
    if (!spare_rings_.empty()) {
        ring = std::move(spare_rings_.back());
        spare_rings_.pop_back();
    }
    ring.reserve(longest_ring_);
    ring.assign(ring_.begin(), ring_.end());
    std::vector<Ring>& rings = regions[label - 1u].outline.rings;
    if (rings.capacity() == 0 && !spare_lists_.empty()) {
        rings = std::move(spare_lists_.back());
        spare_lists_.pop_back();
    }
    rings.push_back(std::move(ring));
}

void ShapeTracer::trace_rings(std::vector<PlanarRegion>& regions) {
    // Every ring has an upper edge of some block; the first in reading order starts a straight run.
    followed_.assign(blocks_.pixels.size(), 0);
    for (int y = 1; y < blocks_.height - 1; ++y) {
        const std::uint16_t *row = blocks_.row(y), *above = blocks_.row(y - 1);
        const std::uint8_t* followed = followed_.data() + static_cast<std::ptrdiff_t>(y) * blocks_.width;
        for (int x = 1; x < blocks_.width - 1; ++x) {
            if (row[x] == 0 || row[x] == above[x] || followed[x] != 0) continue;
            follow(x, y, row[x]);
            add_ring(regions, row[x]);
        }
    }
}

/// The point p of a ring's corner (in blocks), no further from the nearest reading of the block that the
/// corner belongs to than it may be. A reading's place is its foot on the plane.
Eigen::Vector3d ShapeTracer::held(const Eigen::Vector2d& corner, const Eigen::Vector3d& p,
                                  const CameraInfo& camera, std::uint16_t label, const Plane& plane) const {
    constexpr double kReach = 0.9;  // of a block
    const double reach_per_z = kReach * block_px_ / std::max(camera.depth.fx, camera.depth.fy);
    double nearest = std::numeric_limits<double>::infinity();  // squared, over the squared reach
    Eigen::Vector3d at = p;
    const auto is_near = [&](int u, int v) {
        if ((*labels_)(u, v) != label) return false;
        const double z = camera.metres((*depth_)(u, v)), reach = reach_per_z * z;
        const Eigen::Vector3d foot = plane.project(camera.depth.unproject(u, v, z));
        const double distance2 = (foot - p).squaredNorm() / (reach * reach);
        if (distance2 < nearest) nearest = distance2, at = foot;
        return distance2 <= 1;
    };
    // Corners are midpoints of edges between a block with the label and one without.
    int x = static_cast<int>(corner.x()), y = static_cast<int>(corner.y());
    if (blocks_(x, y) != label) (corner.x() == x ? x : y) -= 1;
    const int u0 = (x - 1) * block_px_, u1 = std::min(u0 + block_px_, labels_->width);
    const int v0 = (y - 1) * block_px_, v1 = std::min(v0 + block_px_, labels_->height);
    // Most often the pixel beside the corner is one.
    if (is_near(std::clamp(static_cast<int>((corner.x() - 1) * block_px_), u0, u1 - 1),
                std::clamp(static_cast<int>((corner.y() - 1) * block_px_), v0, v1 - 1)))
        return p;
    for (int v = v0; v < v1; ++v) {
        for (int u = u0; u < u1; ++u)
            if (is_near(u, v)) return p;
    }
    return nearest < std::numeric_limits<double>::infinity()
               ? Eigen::Vector3d(at + (p - at) / std::sqrt(nearest))
               : p;
}

void ShapeTracer::shape(const CameraInfo& camera, std::uint16_t label, PlanarRegion& region) {
    const Eigen::Matrix3d axes = principal_axes(region.plane, region.moments);
    const Eigen::Vector2d last(camera.depth.width - 0.5, camera.depth.height - 0.5);
    // For rays that hardly meet the plane, or do not. The range that is trusted may be any; no reading is
    // farther than the largest.
    const double farthest_m = 2 * std::min(camera.depth_max_m, camera.metres(65534));
    bool moved = false;
    corners_.clear();
    for (const Ring& ring : region.outline.rings) {
        for (const Eigen::Vector2d& corner : ring) {
            // Pixel centres are at integers, so a block's left edge lies half a pixel before its first pixel;
            // and the first block is one of 0 that is not in the image.
            const Eigen::Vector2d pixel =
                (corner.array() - 1).matrix() * block_px_ - Eigen::Vector2d(0.5, 0.5);
            const Eigen::Vector3d p =
                ray_on_plane(camera.depth, region.plane, pixel.cwiseMin(last), farthest_m);
            corners_.push_back(held(corner, p, camera, label, region.plane));
            moved |= corners_.back() != p;
        }
    }
    if (corners_.empty()) corners_.push_back(region.plane.project(region.moments.mean()));
    region.box = bound(axes, corners_);
    region.box.half_extents.z() = 3 * region.rms;

    const Pose box_from_camera = region.box.frame_from_box.inverse(Eigen::Isometry);
    auto corner = corners_.begin();
    for (Ring& ring : region.outline.rings) {
        for (Eigen::Vector2d& vertex : ring) vertex = (box_from_camera * *corner++).head<2>();
        // Image rows grow downwards, the box's y axis does not: turn outer rings counter-clockwise again.
        std::reverse(ring.begin(), ring.end());
    }
    // The two sides of a thin strip may have passed each other.
    if (moved) crossing_remover_.remove(region.outline);
}

void ShapeTracer::trace_all(const DepthImage& depth, const Image<std::uint16_t>& labels,
                            const CameraInfo& camera, std::vector<PlanarRegion>& regions) {
    recycle(regions);
    if (regions.empty()) return;
    constexpr int kBlocksAcross = 160;
    find_blocks(labels, std::max(1, (labels.width + kBlocksAcross / 2) / kBlocksAcross));
    trace_rings(regions);
    depth_ = &depth;
    labels_ = &labels;
    for (std::size_t i = 0; i < regions.size(); ++i)
        shape(camera, static_cast<std::uint16_t>(i + 1), regions[i]);
}

}  // namespace planemap::segmentation
