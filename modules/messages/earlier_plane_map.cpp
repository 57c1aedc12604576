// SPDX-License-Identifier: BSD-3-Clause
// Maps as they were sent and stored before they were packed.
#include <cmath>
#include <cstdint>

#include "core/geometry/packed_outline.hpp"
#include "messages/checks.hpp"
#include "messages/convert.hpp"
#include "messages/map_meetings.hpp"

namespace planemap::messages {

namespace {

/// Centres of boxes lie no further out.
constexpr float kFarthest_m = 1e5f;

struct RingFields {
    const char *unit, *ring_sizes;
};
template <typename Message>
MapOutline rings_of(const Message& message, const RingFields& fields) {
    MapOutline outline;
    outline.unit = message.unit;
    require(std::isfinite(message.unit) && message.unit > 0 && message.unit < 1, fields.unit,
            "is not between 0 and 1");
    const std::size_t vertices = message.vertices.size();
    outline.packed.reserve(message.ring_sizes.size() + 2 * vertices);
    std::size_t next = 0;
    for (const std::int16_t size : message.ring_sizes) {
        require(size >= 3, fields.ring_sizes, "has a ring of fewer than 3 vertices");
        require(static_cast<std::size_t>(size) <= vertices - next, fields.ring_sizes,
                "does not add up to the vertices");
        outline.packed.push_back(size);
        for (const std::size_t end = next + static_cast<std::size_t>(size); next < end; ++next)
            outline.packed.insert(outline.packed.end(),
                                  {message.vertices[next][0], message.vertices[next][1]});
    }
    require(next == vertices, fields.ring_sizes, "does not add up to the vertices");
    return outline;
}

MapPlane from_message(const earlier_map_plane_t& message) {
    MapPlane plane;
    plane.id = message.id;
    require(message.label >= 0 && message.label <= 6, "plane.label", "is unknown");
    plane.label = static_cast<PlaneLabel>(message.label);
    plane.normal = Eigen::Vector3f(message.normal);
    plane.center = Eigen::Vector3f(message.center);
    plane.angle = message.angle;
    plane.half_extents = Eigen::Vector2f(message.half_extents);
    plane.rms = message.rms;
    plane.inliers = message.inliers;
    plane.area = message.area;
    plane.keyframes = message.n_keyframes;
    require(plane.normal.allFinite() && std::abs(plane.normal.norm() - 1) < 1e-3f, "plane.normal",
            "is not a unit vector");
    require(plane.center.allFinite() && std::isfinite(message.d), "plane.center", "is not finite");
    require(plane.center.norm() <= kFarthest_m, "plane.center", "is too far out");
    require(std::isfinite(plane.angle), "plane.angle", "is not finite");
    require(plane.half_extents.allFinite() && plane.half_extents.minCoeff() >= 0, "plane.half_extents",
            "are negative or not finite");
    require(std::isfinite(plane.rms) && plane.rms >= 0, "plane.rms", "is negative or not finite");
    require(std::isfinite(plane.area) && plane.area >= 0, "plane.area", "is negative or not finite");
    require(std::isfinite(plane.inliers) && plane.inliers >= 3, "plane.inliers", "are fewer than 3");
    require(message.n_keyframes >= 0, "plane.n_keyframes", "is negative");
    plane.outline = rings_of(message, {"plane.unit", "plane.ring_sizes"});
    return plane;
}

}  // namespace

PlaneMap from_message(const earlier_plane_map_t& message) {
    PlaneMap map = map_without_planes(message);
    map.planes.reserve(message.planes.size());
    for (const earlier_map_plane_t& plane : message.planes) {
        require(map.planes.empty() || plane.id > map.planes.back().id, "plane.id", "does not ascend");
        map.planes.push_back(from_message(plane));
    }
    const auto plane_at = [&](std::int16_t index, const char* field) -> const MapPlane& {
        require(index >= 0 && index < message.n_planes, field, "is not a plane of the map");
        return map.planes[static_cast<std::size_t>(index)];
    };
    map.lines.reserve(message.lines.size());
    for (const earlier_map_line_t& line : message.lines) {
        const MapPlane &a = plane_at(line.plane_a, "line.plane_a"),
                       &b = plane_at(line.plane_b, "line.plane_b");
        const auto shared = shared_line(a, b);
        require(shared.has_value(), "line", "joins parallel planes");
        require(std::isfinite(line.start) && std::isfinite(line.stop), "line",
                "has an end that is not finite");
        const auto at = [&](float along) -> Eigen::Vector3f {
            return (shared->origin + static_cast<double>(along) * shared->direction).cast<float>();
        };
        map.lines.push_back({a.id, b.id, at(line.start), at(line.stop)});
    }
    map.points.reserve(message.points.size());
    for (const earlier_map_point_t& point : message.points) {
        const MapPlane &a = plane_at(point.planes[0], "point.planes"),
                       &b = plane_at(point.planes[1], "point.planes"),
                       &c = plane_at(point.planes[2], "point.planes");
        const auto position = shared_point(a, b, c);
        require(position.has_value(), "point", "joins planes that do not meet in one point");
        map.points.push_back({{a.id, b.id, c.id}, position->cast<float>()});
    }
    map.inferred.reserve(message.inferred.size());
    for (const earlier_inferred_rings_t& rings : message.inferred) {
        const int id = plane_at(rings.plane, "inferred.plane").id;
        require(map.inferred.empty() || id > map.inferred.back().plane, "inferred.plane", "does not ascend");
        map.inferred.push_back({id, rings_of(rings, {"inferred.unit", "inferred.ring_sizes"})});
    }
    return map;
}

}  // namespace planemap::messages
