// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/geometry/angle.hpp"
#include "exports/exports.hpp"
#include "exports/parts.hpp"
#include "exports/svg.hpp"

namespace planemap::exports {

namespace {

/// A camera outside a bounding sphere.
struct PerspectiveCamera {
    Eigen::Vector3d eye;
    Eigen::Matrix3d view_from_world;  ///< x right, y up, z towards the viewer

    Eigen::Vector2d operator()(const Eigen::Vector3d& p) const {
        const Eigen::Vector3d q = view_from_world * (p - eye);
        return q.head<2>() / -q.z();
    }
    bool is_in_front_of(const Plane& plane) const { return plane.signed_distance(eye) > 0; }
};

PerspectiveCamera looking_from(double azimuth, const Eigen::Matrix3d& level, const Eigen::Vector3d& centre,
                               double radius) {
    constexpr double kElevation = radians(50);
    const Eigen::Vector3d in_level(std::cos(kElevation) * std::cos(azimuth),
                                   std::cos(kElevation) * std::sin(azimuth), std::sin(kElevation));
    PerspectiveCamera camera;
    const Eigen::Vector3d back = level.transpose() * in_level;
    camera.eye = centre + 3.2 * radius * back;
    const Eigen::Vector3d right = level.row(2).transpose().cross(back).normalized();
    camera.view_from_world << right.transpose(), back.cross(right).transpose(), back.transpose();
    return camera;
}

/// The camera above a corner that shows the most area.
PerspectiveCamera best_camera(const std::vector<const MapPlane*>& planes, const Eigen::Matrix3d& level) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (const MapPlane* plane : planes) {
        for (const Eigen::Vector3d& corner : plane->box().face()) {
            low = low.cwiseMin(corner);
            high = high.cwiseMax(corner);
        }
    }
    if (planes.empty()) low = high = Eigen::Vector3d::Zero();
    const Eigen::Vector3d centre = 0.5 * (low + high);
    const double radius = std::max(0.5, 0.5 * (high - low).norm());
    PerspectiveCamera best;
    double best_area = -1;
    for (int i = 0; i < 8; ++i) {
        const PerspectiveCamera camera =
            looking_from((i + 0.3) * std::numbers::pi / 4, level, centre, radius);
        double area = 0;
        for (const MapPlane* plane : planes) {
            const Eigen::Vector3d towards = camera.eye - plane->center.cast<double>();
            area += plane->area * std::max(0.0, plane->normal.cast<double>().dot(towards.normalized()));
        }
        if (area > best_area) {
            best = camera;
            best_area = area;
        }
    }
    return best;
}

struct Drawn {
    const MapPlane* plane;
    Polygon3 rings;
    Eigen::Vector2d low, high;  ///< on the page
    double depth;               ///< of the centre
};

/// True when a's plane separates the two and b is on the viewer's side, or b's does and a is beyond.
bool is_behind(const Drawn& a, const Drawn& b, const Eigen::Vector3d& eye) {
    constexpr double kSlack_m = 0.03;
    const auto all_on_side = [&](const Polygon3& rings, const Plane& plane, double side) {
        for (const auto& ring : rings)
            for (const auto& p : ring)
                if (side * plane.signed_distance(p) < -kSlack_m) return false;
        return true;
    };
    const Plane plane_a = a.plane->plane(), plane_b = b.plane->plane();
    return all_on_side(b.rings, plane_a, plane_a.signed_distance(eye) > 0 ? 1 : -1) ||
           all_on_side(a.rings, plane_b, plane_b.signed_distance(eye) > 0 ? -1 : 1);
}

/// Order for the painter's algorithm, farthest first: what lies behind another plane comes before it; where
/// planes cross or overlap in a circle, the farther centre does.
std::vector<Drawn> painters_order(std::vector<Drawn> planes, const Eigen::Vector3d& eye) {
    std::stable_sort(planes.begin(), planes.end(), [](auto& a, auto& b) { return a.depth > b.depth; });
    const std::size_t n = planes.size();
    std::vector<std::vector<std::size_t>> in_front_of(n);
    std::vector<int> waits_for(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) {
            if ((planes[i].low.array() > planes[j].high.array()).any()) continue;
            if ((planes[j].low.array() > planes[i].high.array()).any()) continue;
            const bool i_behind = is_behind(planes[i], planes[j], eye),
                       j_behind = is_behind(planes[j], planes[i], eye);
            if (i_behind == j_behind) continue;
            in_front_of[i_behind ? i : j].push_back(i_behind ? j : i);
            ++waits_for[i_behind ? j : i];
        }
    }
    std::vector<Drawn> order;
    std::vector<bool> done(n, false);
    while (order.size() < n) {
        std::size_t next = n;
        for (std::size_t i = 0; i < n && (next == n || waits_for[next] > 0); ++i) {
            if (!done[i] && (next == n || waits_for[i] <= 0)) next = i;
        }
        done[next] = true;
        for (const std::size_t i : in_front_of[next]) --waits_for[i];
        order.push_back(planes[next]);
    }
    return order;
}

/// A length that shows the scale of a perspective: true at its own place, at the front edge of the floor.
struct SpaceBar {
    Eigen::Vector3d from, to;
    Eigen::Vector3d tick;  ///< across it
    double length = 0;
};

/// Along the lower edge of the planes' level box that is nearest to the viewer; nothing without planes.
std::optional<SpaceBar> bar_before(const std::vector<const MapPlane*>& planes, const Eigen::Matrix3d& level,
                                   const PerspectiveCamera& camera) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(1e300), high = -low;
    for (const MapPlane* plane : planes) {
        for (const auto& ring : world_rings(*plane)) {
            for (const Eigen::Vector3d& p : ring) {
                low = low.cwiseMin(level * p);
                high = high.cwiseMax(level * p);
            }
        }
    }
    if (!(low.array() <= high.array()).all()) return std::nullopt;
    const Eigen::Vector3d eye = level * camera.eye, middle = 0.5 * (low + high), size = high - low;
    const double outside = 0.03 * size.norm();
    SpaceBar best;
    double nearest = 1e300;
    for (const int axis : {0, 1}) {
        const int across = 1 - axis;
        for (const double side : {-1.0, 1.0}) {
            Eigen::Vector3d at = middle, tick = Eigen::Vector3d::Zero();
            at.z() = low.z();
            at(across) += side * (0.5 * size(across) + outside);
            tick(across) = side * 0.4 * outside;
            if ((at - eye).norm() >= nearest) continue;
            nearest = (at - eye).norm();
            const double length = round_length(std::max(0.4 * size(axis), 0.01));
            Eigen::Vector3d half = Eigen::Vector3d::Zero();
            half(axis) = 0.5 * length;
            best = {level.transpose() * (at - half), level.transpose() * (at + half),
                    level.transpose() * tick, length};
        }
    }
    return best;
}

template <typename Project>
std::string drawn_bar(const SpaceBar& bar, const Project& project) {
    const Eigen::Vector3d middle = 0.5 * (bar.from + bar.to);
    const Eigen::Vector2d outward = (project(middle + bar.tick) - project(middle)).normalized();
    const char* anchor = outward.x() > 0.4    ? "text-anchor=\"start\""
                         : outward.x() < -0.4 ? "text-anchor=\"end\""
                                              : "text-anchor=\"middle\"";
    return "<path d=\"" + move_to(project(bar.from + bar.tick)) + line_to(project(bar.from)) +
           line_to(project(bar.to)) + line_to(project(bar.to + bar.tick)) +
           "\" fill=\"none\" stroke=\"black\" stroke-width=\"1.5\"/>\n" +
           words(project(middle) + 18 * outward + Eigen::Vector2d(0, 5), metres(bar.length), anchor);
}

template <typename Project>
std::vector<Drawn> drawn_planes(const std::vector<const MapPlane*>& planes, const Eigen::Vector3d& eye,
                                const Project& project) {
    std::vector<Drawn> drawn;
    for (const MapPlane* plane : planes) {
        Drawn d{plane, world_rings(*plane), Eigen::Vector2d::Constant(1e300),
                Eigen::Vector2d::Constant(-1e300), (plane->center.cast<double>() - eye).norm()};
        for (const auto& ring : d.rings) {
            for (const auto& p : ring) {
                d.low = d.low.cwiseMin(project(p));
                d.high = d.high.cwiseMax(project(p));
            }
        }
        drawn.push_back(std::move(d));
    }
    return drawn;
}

template <typename Project>
std::string shaded_plane(const Drawn& drawn, const Eigen::Vector3d& light, const Project& project) {
    const Rgb color = id_color(drawn.plane->id);
    const double shade = 0.72 + 0.33 * std::abs(light.dot(drawn.plane->normal.cast<double>()));
    return "<path d=\"" + path(drawn.rings, project) + "\" fill-rule=\"evenodd\" fill=\"" +
           css(color, shade) + "\" stroke=\"" + css(color, 0.6) +
           "\" stroke-width=\"0.8\" stroke-linejoin=\"round\">" + tooltip(*drawn.plane) + "</path>\n";
}

/// Dashed, over all else: what is inferred of planes that face the camera.
template <typename Project>
std::string inferred_parts(const PlaneMap& map, const PerspectiveCamera& camera, const Project& project) {
    std::string body;
    for (const MapPlane& plane : inferred_planes(map)) {
        if (!camera.is_in_front_of(plane.plane())) continue;
        const Rgb color = id_color(plane.id);
        body += "<path d=\"" + path(world_rings(plane), project) + "\" fill-rule=\"evenodd\" fill=\"" +
                css(color) + "\" fill-opacity=\"0.15\" stroke=\"" + css(color, 0.5) +
                "\" stroke-width=\"1\" stroke-dasharray=\"5 4\"/>\n";
    }
    return body;
}

/// Planes in the order given, with the intersections of those that are there.
template <typename Project>
std::string painted(const std::vector<Drawn>& planes, const PlaneMap& map, const Eigen::Vector3d& light,
                    const Project& project) {
    std::string body;
    std::vector<int> ids;
    const auto is_painted = [&](int id) { return std::find(ids.begin(), ids.end(), id) != ids.end(); };
    for (const Drawn& drawn : planes) {
        const int id = drawn.plane->id;
        body += shaded_plane(drawn, light, project);
        ids.push_back(id);
        // A line belongs to the nearer of its planes: what is painted later covers it.
        for (const IntersectionLine& line : map.lines) {
            if (line.plane_a != id && line.plane_b != id) continue;
            if (!is_painted(line.plane_a) || !is_painted(line.plane_b)) continue;
            body += "<path d=\"" + move_to(project(line.from.cast<double>())) +
                    line_to(project(line.to.cast<double>())) + "\" stroke=\"#222\" stroke-width=\"1.8\"/>\n";
        }
    }
    for (const IntersectionPoint& p : map.points) {
        if (!std::all_of(p.planes.begin(), p.planes.end(), is_painted)) continue;
        const Eigen::Vector2d at = project(p.position.cast<double>());
        body +=
            "<circle cx=\"" + pixels(at.x()) + "\" cy=\"" + pixels(at.y()) + "\" r=\"3.5\" fill=\"#222\"/>\n";
    }
    return body;
}

}  // namespace

std::string perspective_svg(const PlaneMap& map, const Trajectory& trajectory) {
    const Eigen::Matrix3d level = level_from_world(map, up_of(map, trajectory));
    const std::vector<const MapPlane*> planes = drawable_planes(map);
    const PerspectiveCamera camera = best_camera(planes, level);
    std::vector<Eigen::Vector2d> extent;
    std::vector<const MapPlane*> visible;
    for (const MapPlane* plane : planes) {
        if (!camera.is_in_front_of(plane->plane())) continue;
        visible.push_back(plane);
        for (const auto& ring : world_rings(*plane))
            for (const auto& p : ring) extent.push_back(camera(p));
    }
    const auto bar = bar_before(visible, level, camera);
    if (bar) extent.insert(extent.end(), {camera(bar->from), camera(bar->to)});
    const Fit fit(extent, drawing_area(false));
    const auto project = [&](const Eigen::Vector3d& p) { return fit(camera(p)); };

    const Eigen::Vector3d light = (level.transpose() * Eigen::Vector3d(0.35, 0.2, 0.9)).normalized();
    const std::string body =
        painted(painters_order(drawn_planes(visible, camera.eye, project), camera.eye), map, light, project);
    const std::size_t hidden = map.planes.size() - visible.size();
    return page(count_of(map.planes.size(), "plane") + " in perspective",
                "from above a corner; a colour a plane; the bar is true where it lies" +
                    (hidden == 0 ? "" : "; " + std::to_string(hidden) + " that face away are not drawn") +
                    "; " + up_text(map),
                body + inferred_parts(map, camera, project) + trajectory_line(trajectory, project) +
                    (bar ? drawn_bar(*bar, project) : ""));
}

}  // namespace planemap::exports
