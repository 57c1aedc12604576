// SPDX-License-Identifier: BSD-3-Clause
#include "core/plane_map.hpp"

#include <algorithm>
#include <cmath>

namespace planemap {

namespace {

/// The axes that MapPlane::angle counts from: z the normal, x the first of world x, y that is not nearly
/// along it, made square to it.
Eigen::Matrix3d reference_axes(const Eigen::Vector3d& normal) {
    return plane_axes(normal,
                      std::abs(normal.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY());
}

template <typename T>
std::size_t capacity_bytes(const std::vector<T>& v) {
    return v.capacity() * sizeof(T);
}

}  // namespace

const char* label_name(PlaneLabel label) {
    switch (label) {
        case PlaneLabel::kFloor:
            return "floor";
        case PlaneLabel::kCeiling:
            return "ceiling";
        case PlaneLabel::kWall:
            return "wall";
        case PlaneLabel::kHorizontal:
            return "horizontal";
        case PlaneLabel::kOther:
            return "other";
        case PlaneLabel::kVertical:
            return "vertical";
        case PlaneLabel::kUnknown:
            break;
    }
    return "unknown";
}

MapOutline::MapOutline(const Outline& outline) {
    unit = pack(outline, packed);
}

std::size_t MapOutline::ring_count() const {
    std::size_t count = 0;
    for_each_packed(
        packed, [&](std::size_t) { ++count; }, [](std::int16_t, std::int16_t) {});
    return count;
}

std::size_t MapOutline::vertex_count() const {
    return (packed.size() - ring_count()) / 2;
}

Outline MapOutline::rings() const {
    Outline outline;
    outline.rings.reserve(ring_count());
    for_each_packed(
        packed, [&](std::size_t size) { outline.rings.emplace_back().reserve(size); },
        [&](std::int16_t x, std::int16_t y) {
            outline.rings.back().emplace_back(static_cast<double>(unit) * Eigen::Vector2d(x, y));
        });
    return outline;
}

MapPlane::MapPlane(int plane_id, const PlanarRegion& region, std::size_t keyframe_count)
    : id(plane_id),
      keyframes(static_cast<std::int16_t>(std::min<std::size_t>(keyframe_count, 32767))),
      half_extents(region.box.half_extents.head<2>().cast<float>()),
      rms(static_cast<float>(region.rms)),
      inliers(static_cast<float>(region.moments.count)),
      outline(region.outline) {
    lay(region.plane, region.box.frame_from_box.translation(), region.box.frame_from_box.linear().col(0));
    area = static_cast<float>(planemap::area(outline.rings()));
}

void MapPlane::lay(const Plane& plane_world, const Eigen::Vector3d& box_center,
                   const Eigen::Vector3d& box_x) {
    normal = plane_world.normal.cast<float>();
    center = plane_world.project(box_center).cast<float>();
    const Eigen::Vector3d x = reference_axes(normal.cast<double>().normalized()).transpose() * box_x;
    angle = static_cast<float>(std::atan2(x.y(), x.x()));
}

void MapPlane::move_to(const Plane& plane_world) {
    lay(plane_world, center.cast<double>(), world_from_plane().linear().col(0));
}

Plane MapPlane::plane() const {
    const Eigen::Vector3d n = normal.cast<double>().normalized();
    return {n, -n.dot(center.cast<double>())};
}

Pose MapPlane::world_from_plane() const {
    Pose pose = Pose::Identity();
    pose.linear() =
        reference_axes(normal.cast<double>().normalized()) *
        Eigen::AngleAxisd(static_cast<double>(angle), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    pose.translation() = center.cast<double>();
    return pose;
}

Box MapPlane::box() const {
    return {world_from_plane(), {half_extents.x(), half_extents.y(), 2.0 * static_cast<double>(rms)}};
}

PlanarRegion MapPlane::region() const {
    PlanarRegion region;
    region.plane = plane();
    region.moments.count = inliers;
    region.box = box();
    region.outline = outline.rings();
    region.rms = rms;
    return region;
}

double distance(const MapPlane& plane, const Eigen::Vector3d& p_world) {
    const Eigen::Vector3d p = plane.world_from_plane().inverse(Eigen::Isometry) * p_world;
    return std::hypot(distance(plane.outline.rings(), p.head<2>()), p.z());
}

const MapPlane* PlaneMap::find(int id) const {
    const auto at = std::lower_bound(planes.begin(), planes.end(), id,
                                     [](const MapPlane& plane, int wanted) { return plane.id < wanted; });
    return at != planes.end() && at->id == id ? &*at : nullptr;
}

const MapOutline* PlaneMap::inferred_of(int id) const {
    const auto at =
        std::lower_bound(inferred.begin(), inferred.end(), id,
                         [](const InferredRings& rings, int wanted) { return rings.plane < wanted; });
    return at != inferred.end() && at->plane == id ? &at->outline : nullptr;
}

std::size_t memory_bytes(const PlaneMap& map) {
    std::size_t bytes = sizeof map + capacity_bytes(map.planes) + capacity_bytes(map.lines) +
                        capacity_bytes(map.points) + capacity_bytes(map.inferred);
    for (const MapPlane& plane : map.planes) bytes += capacity_bytes(plane.outline.packed);
    for (const InferredRings& rings : map.inferred) bytes += capacity_bytes(rings.outline.packed);
    return bytes;
}

}  // namespace planemap
