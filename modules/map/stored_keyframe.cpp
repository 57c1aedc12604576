// SPDX-License-Identifier: BSD-3-Clause
#include "map/stored_keyframe.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/geometry/outline_frame.hpp"
#include "core/geometry/packed_outline.hpp"
#include "core/heap_bytes.hpp"

namespace planemap::map {

namespace {

/// The region's frame with z exactly its plane's normal and the origin on the plane, whatever its box says.
Pose level_box(const PlanarRegion& region) {
    Pose frame = Pose::Identity();
    frame.linear() = plane_axes(region.plane.normal, region.box.frame_from_box.linear().col(0));
    frame.translation() = region.plane.project(region.box.frame_from_box.translation());
    return frame;
}

/// Moments in the camera frame, kept in the axes of the region's box.
void set_moments(StoredRegion& region, const Moments& moments) {
    const Eigen::Matrix3d r =
        Eigen::Quaterniond(region.camera_from_box.cast<double>()).normalized().toRotationMatrix();
    const Eigen::Matrix3d c = r.transpose() * moments.covariance() * r;
    region.count = static_cast<float>(moments.count);
    region.mean = moments.mean().cast<float>();
    const std::array<double, 6> covariance{c(0, 0), c(1, 1), c(2, 2), c(0, 1), c(0, 2), c(1, 2)};
    std::transform(covariance.begin(), covariance.end(), region.covariance.begin(),
                   [](double value) { return static_cast<float>(value); });
}

}  // namespace

StoredKeyframe stored(std::int64_t utime, const std::vector<PlanarRegion>& regions) {
    StoredKeyframe keyframe;
    keyframe.utime = keyframe.seen_utime = utime;
    keyframe.sight = Sight(regions);
    keyframe.regions.reserve(regions.size());
    for (const PlanarRegion& region : regions) {
        StoredRegion& s = keyframe.regions.emplace_back();
        const Pose camera_from_box = level_box(region);
        s.camera_from_box = Eigen::Quaterniond(camera_from_box.linear()).normalized().cast<float>();
        s.utime = utime;
        set_moments(s, region.moments);
        s.center = camera_from_box.translation().cast<float>();
        s.half_extents = region.box.half_extents.head<2>().cast<float>();
        s.first = static_cast<std::uint32_t>(keyframe.vertices.size());
        const Pose box_from_outline = camera_from_box.inverse(Eigen::Isometry) * region.box.frame_from_box;
        s.unit = pack(projected(box_from_outline, region.outline), keyframe.vertices);
        s.last = static_cast<std::uint32_t>(keyframe.vertices.size());
    }
    keyframe.vertices.shrink_to_fit();
    return keyframe;
}

std::vector<Plane> seen_planes(const StoredKeyframe& keyframe) {
    if (!keyframe.sight_planes.empty()) return keyframe.sight_planes;
    std::vector<Plane> planes;
    for (const StoredRegion& region : keyframe.regions) {
        const Eigen::Quaterniond q = Eigen::Quaterniond(region.camera_from_box.cast<double>()).normalized();
        const Eigen::Vector3d normal = q * Eigen::Vector3d::UnitZ();
        planes.push_back({normal, -normal.dot(region.center.cast<double>())});
    }
    return planes;
}

PlacedRegion::PlacedRegion(const Pose& world_from_camera, const StoredRegion& region) {
    const Eigen::Quaterniond camera_from_box =
        Eigen::Quaterniond(region.camera_from_box.cast<double>()).normalized();
    const Eigen::Matrix3d world_from_box = world_from_camera.linear() * camera_from_box.toRotationMatrix();
    box.frame_from_box.linear() = world_from_box;
    box.frame_from_box.translation() = world_from_camera * region.center.cast<double>();
    box.half_extents << region.half_extents.cast<double>(), 0;
    plane.normal = world_from_box.col(2);
    plane.d = -plane.normal.dot(box.frame_from_box.translation());

    const auto& c = region.covariance;
    Eigen::Matrix3d covariance;
    covariance << static_cast<double>(c[0]), static_cast<double>(c[3]), static_cast<double>(c[4]),
        static_cast<double>(c[3]), static_cast<double>(c[1]), static_cast<double>(c[5]),
        static_cast<double>(c[4]), static_cast<double>(c[5]), static_cast<double>(c[2]);
    const Eigen::Vector3d mean = world_from_camera * region.mean.cast<double>();
    moments.count = static_cast<double>(region.count);
    moments.sum = moments.count * mean;
    moments.scatter =
        moments.count * (world_from_box * covariance * world_from_box.transpose() + mean * mean.transpose());
}

void outline_in(const Pose& a_from_box, const StoredRegion& region, const StoredKeyframe& owner,
                FlatPolygon& polygon) {
    polygon.clear();
    const Eigen::Vector2d origin = a_from_box.translation().head<2>();
    const Eigen::Matrix2d turn = a_from_box.linear().topLeftCorner<2, 2>();
    if (region.first == region.last) {
        const Eigen::Vector2d x = static_cast<double>(region.half_extents.x()) * turn.col(0);
        const Eigen::Vector2d y = static_cast<double>(region.half_extents.y()) * turn.col(1);
        for (const Eigen::Vector2d& corner : {Eigen::Vector2d(-x - y), Eigen::Vector2d(x - y),
                                              Eigen::Vector2d(x + y), Eigen::Vector2d(y - x)})
            polygon.vertices.push_back(origin + corner);
        polygon.ring_ends = {4};
        return;
    }
    const Eigen::Matrix2d steps = static_cast<double>(region.unit) * turn;
    const auto packed = std::span(owner.vertices).subspan(region.first, region.last - region.first);
    std::size_t end = 0;
    for_each_packed(
        packed, [&](std::size_t size) { polygon.ring_ends.push_back(end += size); },
        [&](std::int16_t x, std::int16_t y) {
            polygon.vertices.push_back(origin + x * steps.col(0) + y * steps.col(1));
        });
}

void take_points(StoredRegion& region, const StoredRegion& other, const Pose& camera_from_other) {
    Moments sum = PlacedRegion(Pose::Identity(), region).moments;
    sum += PlacedRegion(camera_from_other, other).moments;
    if (const PlaneFit fit = fit_plane(sum); fit.valid) {
        // The box lies on the plane of all points; it hardly turns.
        const Eigen::Quaterniond before =
            Eigen::Quaterniond(region.camera_from_box.cast<double>()).normalized();
        const Eigen::Matrix3d axes = plane_axes(fit.plane.normal, before * Eigen::Vector3d::UnitX());
        region.camera_from_box = Eigen::Quaterniond(axes).normalized().cast<float>();
        region.center = fit.plane.project(region.center.cast<double>()).cast<float>();
    }
    set_moments(region, sum);
    region.keyframes += other.keyframes;
}

void take_region(StoredKeyframe& keyframe, const StoredRegion& other, const StoredKeyframe& owner,
                 const Pose& camera_from_other) {
    StoredRegion& region = keyframe.regions.emplace_back(other);
    region.number = -1;
    const PlacedRegion placed(camera_from_other, other);
    region.camera_from_box =
        Eigen::Quaterniond(placed.box.frame_from_box.linear()).normalized().cast<float>();
    region.center = placed.box.frame_from_box.translation().cast<float>();
    set_moments(region, placed.moments);
    region.first = static_cast<std::uint32_t>(keyframe.vertices.size());
    keyframe.vertices.insert(keyframe.vertices.end(), owner.vertices.begin() + other.first,
                             owner.vertices.begin() + other.last);
    region.last = static_cast<std::uint32_t>(keyframe.vertices.size());
}

void StoredKeyframe::see_again(int looks_now, std::int64_t utime_now) {
    looks = std::clamp(looks_now, looks, kLooksThatCount);
    seen_utime = std::max(seen_utime, utime_now);
    for (StoredRegion& region : regions) {
        if (region.number < 0) continue;  // another one saw it
        region.looks = looks;
        region.utime = seen_utime;
    }
}

void StoredKeyframe::take_later(StoredKeyframe look) {
    const auto at = std::upper_bound(later.begin(), later.end(), look, [](const auto& a, const auto& b) {
        return a.seen_utime < b.seen_utime;
    });
    later.insert(at, std::move(look));
    if (later.size() > kMostLater) later.erase(later.begin());
}

std::size_t memory_bytes(const StoredKeyframe& keyframe) {
    std::size_t bytes = 0;
    for_each_view(keyframe, [&](const StoredKeyframe& view) {
        bytes += sizeof view + heap_bytes(view.regions.capacity() * sizeof(StoredRegion)) +
                 heap_bytes(view.vertices.capacity() * sizeof(std::int16_t)) +
                 heap_bytes(view.sight_planes.capacity() * sizeof(Plane));
    });
    return bytes;
}

}  // namespace planemap::map
