// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/shape.hpp"

#include <algorithm>
#include <cmath>

namespace planemap {

namespace {

/// Number of a block's pixels with a label.
int count(const Image<std::uint16_t>& labels, int u0, int v0, int u1, int v1, std::uint16_t label) {
    int total = 0;
    for (int v = v0; v < v1; ++v) {
        const std::uint16_t* row = labels.row(v);
        for (int u = u0; u < u1; ++u) total += row[u] == label;
    }
    return total;
}

/// The label that more than half of a block's pixels carry, else 0.
std::uint16_t majority(const Image<std::uint16_t>& labels, int u0, int v0, int u1, int v1) {
    const int pixels = (u1 - u0) * (v1 - v0);
    const std::uint16_t middle = labels((u0 + u1) / 2, (v0 + v1) / 2), corner = labels(u0, v0);
    if (2 * count(labels, u0, v0, u1, v1, middle) > pixels) return middle;
    if (corner != middle && 2 * count(labels, u0, v0, u1, v1, corner) > pixels) return corner;
    std::uint16_t candidate = 0;
    int votes = 0;  // Boyer and Moore: what outweighs all others together is left over
    for (int v = v0; v < v1; ++v) {
        const std::uint16_t* row = labels.row(v);
        for (int u = u0; u < u1; ++u) {
            if (votes == 0) candidate = row[u];
            votes += row[u] == candidate ? 1 : -1;
        }
    }
    return 2 * count(labels, u0, v0, u1, v1, candidate) > pixels ? candidate : std::uint16_t{0};
}

/// The midpoints of the unit edges of a ring with corners on the integer grid. A staircase becomes a straight
/// line, and parts of the boundary that are not neighbours end up at least sqrt(1/2) apart, so that a
/// simplification within half of that cannot make them cross.
Ring edge_midpoints(const Ring& corners) {
    Ring midpoints;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
        const double length = (b - a).lpNorm<1>();
        const Eigen::Vector2d step = (b - a) / length;
        // Only the ends of a straight edge: the midpoints between them are collinear.
        midpoints.push_back(a + 0.5 * step);
        if (length > 1.5) midpoints.push_back(b - 0.5 * step);
    }
    return midpoints;
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

void ShapeTracer::find_changes(const Image<std::uint16_t>& labels, int v0, int v1) {
    const auto width = static_cast<std::size_t>(labels.width);
    changes_.assign(width, 0);
    const std::uint16_t* top = labels.row(v0);
    for (std::size_t u = 0; u + 1 < width; ++u) changes_[u] = top[u] ^ top[u + 1];
    for (int v = v0 + 1; v < v1; ++v) {
        const std::uint16_t* row = labels.row(v);
        for (std::size_t u = 0; u < width; ++u) changes_[u] |= static_cast<std::uint16_t>(row[u] ^ top[u]);
    }
}

void ShapeTracer::find_blocks(const Image<std::uint16_t>& labels, std::size_t regions) {
    constexpr int kBlocksAcross = 160;
    block_px_ = std::max(1, (labels.width + kBlocksAcross / 2) / kBlocksAcross);
    blocks_.width = (labels.width + block_px_ - 1) / block_px_;
    blocks_.height = (labels.height + block_px_ - 1) / block_px_;
    blocks_.pixels.resize(static_cast<std::size_t>(blocks_.width) * static_cast<std::size_t>(blocks_.height));
    extents_.assign(regions, {blocks_.width, blocks_.height, 0, 0});
    for (int y = 0; y < blocks_.height; ++y) {
        const int v0 = y * block_px_, v1 = std::min(v0 + block_px_, labels.height);
        find_changes(labels, v0, v1);
        for (int x = 0; x < blocks_.width; ++x) {
            const int u0 = x * block_px_, u1 = std::min(u0 + block_px_, labels.width);
            std::uint16_t changes = 0;
            for (int u = u0; u < u1; ++u) changes |= changes_[static_cast<std::size_t>(u)];
            const std::uint16_t label = changes == 0 ? labels(u0, v0) : majority(labels, u0, v0, u1, v1);
            blocks_(x, y) = label;
            if (label == 0) continue;
            Extent& extent = extents_[label - 1u];
            extent.left = std::min(extent.left, x);
            extent.right = std::max(extent.right, x + 1);
            extent.top = std::min(extent.top, y);
            extent.bottom = std::max(extent.bottom, y + 1);
        }
    }
}

void ShapeTracer::shape(const PinholeCamera& camera, double farthest_m, std::uint16_t label,
                        PlanarRegion& region) {
    const Extent& extent = extents_[label - 1u];
    mask_.width = std::max(0, extent.right - extent.left);
    mask_.height = std::max(0, extent.bottom - extent.top);
    mask_.cells.assign(mask_.index(0, mask_.height), 0);
    for (int y = 0; y < mask_.height; ++y) {
        const std::uint16_t* row = blocks_.row(extent.top + y) + extent.left;
        for (int x = 0; x < mask_.width; ++x) mask_.cells[mask_.index(x, y)] = row[x] == label;
    }

    region.outline = trace(mask_);
    for (Ring& ring : region.outline.rings) ring = edge_midpoints(ring);
    constexpr double kTolerance = 0.35;  // of a block, see edge_midpoints()
    region.outline = simplified(region.outline, kTolerance);

    const Eigen::Matrix3d axes = principal_axes(region.plane, region.moments);
    std::vector<Eigen::Vector3d> corners;
    for (const Ring& ring : region.outline.rings) {
        for (const Eigen::Vector2d& corner : ring) {
            // Pixel centres are at integers, so a block's left edge lies half a pixel before its first pixel.
            const Eigen::Vector2d pixel =
                (corner + Eigen::Vector2d(extent.left, extent.top)) * block_px_ - Eigen::Vector2d(0.5, 0.5);
            const Eigen::Vector2d inside =
                pixel.cwiseMin(Eigen::Vector2d(camera.width - 0.5, camera.height - 0.5));
            corners.push_back(ray_on_plane(camera, region.plane, inside, farthest_m));
        }
    }
    if (corners.empty()) corners.push_back(region.plane.project(region.moments.mean()));
    region.box = bound(axes, corners);
    region.box.half_extents.z() = 3 * region.rms;

    const Pose box_from_camera = region.box.frame_from_box.inverse(Eigen::Isometry);
    auto corner = corners.begin();
    for (Ring& ring : region.outline.rings) {
        for (Eigen::Vector2d& vertex : ring) vertex = (box_from_camera * *corner++).head<2>();
        // Image rows grow downwards, the box's y axis does not: turn outer rings counter-clockwise again.
        std::reverse(ring.begin(), ring.end());
    }
}

void ShapeTracer::trace_all(const Image<std::uint16_t>& labels, const CameraInfo& camera,
                            std::vector<PlanarRegion>& regions) {
    if (regions.empty()) return;
    find_blocks(labels, regions.size());
    for (std::size_t i = 0; i < regions.size(); ++i)
        shape(camera.depth, 2 * camera.depth_max_m, static_cast<std::uint16_t>(i + 1), regions[i]);
}

}  // namespace planemap
