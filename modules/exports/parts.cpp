// SPDX-License-Identifier: BSD-3-Clause
#include "exports/parts.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "core/geometry/angle.hpp"
#include "core/geometry/outline_index.hpp"
#include "exports/triangulation.hpp"

namespace planemap::exports {

std::string fixed(double value, int decimals) {
    std::array<char, 400> buffer;
    const auto end =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::fixed, decimals)
            .ptr;
    std::string text(buffer.data(), end);
    if (text[0] == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
    return text;
}

std::string plane_name(const MapPlane& plane) {
    return "plane_" + std::to_string(plane.id) + "_" + label_name(plane.label);
}

std::vector<const MapPlane*> drawable_planes(const PlaneMap& map) {
    std::vector<const MapPlane*> drawable;
    for (const MapPlane& plane : map.planes) {
        const bool finite = is_valid(plane.world_from_plane()) && std::isfinite(plane.area) &&
                            plane.half_extents.allFinite() && std::isfinite(plane.outline.unit);
        if (finite && !plane.outline.empty()) drawable.push_back(&plane);
    }
    return drawable;
}

std::vector<MapPlane> inferred_planes(const PlaneMap& map) {
    std::vector<MapPlane> planes;
    for (const MapPlane* plane : drawable_planes(map)) {
        const MapOutline* inferred = map.inferred_of(plane->id);
        if (inferred == nullptr || inferred->empty() || !std::isfinite(inferred->unit)) continue;
        planes.push_back(*plane);
        planes.back().outline = *inferred;
    }
    return planes;
}

double inferred_area(const PlaneMap& map, int id) {
    const MapOutline* inferred = map.inferred_of(id);
    return inferred == nullptr ? 0 : area(inferred->rings());
}

std::vector<Part> parts_of(const std::vector<Ring>& all_rings) {
    std::vector<Ring> rings;
    for (const Ring& ring : all_rings)
        if (ring.size() >= 3) rings.push_back(ring);
    const OutlineIndex index(Outline{rings});
    std::vector<std::vector<std::size_t>> around(rings.size());
    std::vector<std::size_t> part_of(rings.size(), 0);
    for (std::size_t i = 0; i < rings.size(); ++i) {
        around[i] = index.rings_around(0.5 * (rings[i][0] + rings[i][1]));
        std::erase(around[i], i);
    }
    const auto depth = [&](std::size_t ring) { return around[ring].size(); };
    const auto turned = [](Ring ring, bool counter_clockwise) {
        if ((signed_area(ring) > 0) != counter_clockwise) std::reverse(ring.begin(), ring.end());
        return ring;
    };
    std::vector<Part> parts;
    for (std::size_t i = 0; i < rings.size(); ++i) {
        if (depth(i) % 2 != 0) continue;
        part_of[i] = parts.size();
        parts.push_back({turned(rings[i], true)});
    }
    for (std::size_t i = 0; i < rings.size(); ++i) {
        if (depth(i) % 2 == 0) continue;
        for (const std::size_t j : around[i])
            if (depth(j) + 1 == depth(i)) parts[part_of[j]].push_back(turned(rings[i], false));
    }
    return parts;
}

std::vector<std::vector<Eigen::Vector3d>> world_rings(const MapPlane& plane) {
    std::vector<std::vector<Eigen::Vector3d>> rings;
    const Pose world_from_plane = plane.world_from_plane();
    for (const Ring& ring : plane.outline.rings().rings) {
        rings.emplace_back();
        for (const Eigen::Vector2d& v : ring)
            rings.back().push_back(world_from_plane * Eigen::Vector3d(v.x(), v.y(), 0));
    }
    return rings;
}

PlaneMesh mesh_of(const MapPlane& plane) {
    Triangulation triangulation = triangulate(plane.outline.rings());
    const Pose world_from_plane = plane.world_from_plane();
    PlaneMesh mesh;
    for (const Eigen::Vector2d& v : triangulation.vertices)
        mesh.vertices.push_back((world_from_plane * Eigen::Vector3d(v.x(), v.y(), 0)).cast<float>());
    mesh.triangles = std::move(triangulation.triangles);
    return mesh;
}

Eigen::Vector3d up_of(const PlaneMap& map, const Trajectory& trajectory) {
    if (!map.up.isZero()) return map.up.cast<double>().normalized();
    Eigen::Vector3d held = Eigen::Vector3d::Zero();
    for (const StampedPose& pose : trajectory) held -= pose.world_from_camera.linear().col(1);
    return held.norm() > 1e-6 ? held.normalized().eval() : Eigen::Vector3d(0, -1, 0);
}

Eigen::Matrix3d level_from_world(const PlaneMap& map, const Eigen::Vector3d& up) {
    const Eigen::Matrix3d axes = plane_axes(up, Eigen::Vector3d::UnitX());
    std::vector<Eigen::Vector2d>
        walls;  // area, at four times the angle: directions count modulo a right angle
    for (const MapPlane* plane : drawable_planes(map)) {
        const Eigen::Vector3d n = axes.transpose() * plane->normal.cast<double>();
        const double angle = 4 * std::atan2(n.y(), n.x());
        if (std::abs(n.z()) < 0.3)
            walls.push_back(plane->area * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    // The direction with the most area within 10 deg of it.
    Eigen::Vector2d most(0, 0);
    for (const Eigen::Vector2d& wall : walls) {
        Eigen::Vector2d sum(0, 0);
        for (const Eigen::Vector2d& other : walls)
            if (other.dot(wall) > std::cos(radians(40)) * other.norm() * wall.norm()) sum += other;
        if (sum.norm() > most.norm()) most = sum;
    }
    const double turn = std::atan2(most.y(), most.x()) / 4;
    return Eigen::AngleAxisd(-turn, Eigen::Vector3d::UnitZ()) * axes.transpose();
}

Eigen::Matrix3d UprightFrame::y_up_from_world() const {
    Eigen::Matrix3d y_up;
    y_up << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    return y_up * level_from_world;
}

std::vector<std::string> UprightFrame::notes(const Eigen::Matrix3d& file_from_world, char up) const {
    std::string rows;
    for (int i = 0; i < 3; ++i) {
        rows += i == 0 ? "" : "; ";
        for (int j = 0; j < 3; ++j) rows += (j == 0 ? "" : " ") + fixed(file_from_world(i, j), 9);
    }
    const std::string axis(1, up);
    return {"metres; " + axis + " is up, x runs along most walls, the origin is the world's",
            up_is_known ? "up is as the planes tell it"
                        : "up is not known from the planes: " + axis + " is against the first camera's y",
            "position = R * p_world with R, row by row: " + rows};
}

UprightFrame upright_frame(const PlaneMap& map, const Trajectory& trajectory) {
    // Unlike a drawing, a file can be turned back by whoever knows the first camera: no average here.
    const Trajectory first(trajectory.begin(), trajectory.begin() + (trajectory.empty() ? 0 : 1));
    return {level_from_world(map, up_of(map, first)), !map.up.isZero()};
}

std::vector<Eigen::Vector3d> walked(const Trajectory& trajectory) {
    constexpr double kStep_m = 0.01;
    std::vector<Eigen::Vector3d> way;
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
    for (const StampedPose& pose : trajectory) {
        const Eigen::Vector3d p = pose.world_from_camera.translation();
        if (!p.allFinite()) continue;
        last = p;
        if (way.empty() || (p - way.back()).norm() >= kStep_m) way.push_back(p);
    }
    if (!way.empty() && way.back() != last) way.push_back(last);
    return way;
}

std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> footprint(const MapPlane& plane,
                                                                   const Eigen::Matrix3d& level_from_world) {
    const Eigen::Vector3d normal = level_from_world * plane.normal.cast<double>();
    const Eigen::Vector2d along(-normal.y(), normal.x());
    const auto less = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return along.dot(a) < along.dot(b);
    };
    std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pieces, joined;
    for (const auto& ring : world_rings(plane)) {
        std::vector<Eigen::Vector2d> points;
        points.reserve(ring.size());
        for (const Eigen::Vector3d& p : ring) points.push_back((level_from_world * p).head<2>());
        const auto [from, to] = std::minmax_element(points.begin(), points.end(), less);
        if (from != to) pieces.emplace_back(*from, *to);
    }
    std::sort(pieces.begin(), pieces.end(), [&](auto& a, auto& b) { return less(a.first, b.first); });
    for (const auto& piece : pieces) {
        if (joined.empty() || less(joined.back().second, piece.first)) {
            joined.push_back(piece);
        } else if (less(joined.back().second, piece.second)) {
            joined.back().second = piece.second;
        }
    }
    return joined;
}

}  // namespace planemap::exports
