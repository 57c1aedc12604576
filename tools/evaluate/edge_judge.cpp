// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/edge_judge.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/angle.hpp"
#include "core/geometry/plane_intersection.hpp"
#include "core/geometry/segment.hpp"
#include "evaluate/statistics.hpp"

namespace planemap::evaluation {

namespace {

constexpr double kStep_m = 0.02;  // between the places of a line that are looked at

/// A place on a line and the line's direction there.
struct Place {
    Eigen::Vector3d p, direction;
};

/// True when a visible cell of the plane lies within `reach` of the point, in the plane.
bool is_seen_near(const TruePlane& plane, const Eigen::Vector3d& p_world, double reach) {
    const Eigen::Vector3d p = plane.world_from_plane.inverse(Eigen::Isometry) * p_world;
    if (std::abs(p.z()) > reach) return false;
    const double cell = plane.visible.cell_m;
    const auto from = [&](double at) { return static_cast<int>(std::floor((at - reach) / cell)); };
    const auto to = [&](double at) { return static_cast<int>(std::floor((at + reach) / cell)); };
    for (int y = from(p.y()); y <= to(p.y()); ++y) {
        for (int x = from(p.x()); x <= to(p.x()); ++x) {
            if (!plane.visible.at(x, y)) continue;
            const Eigen::Vector2d middle = plane.visible.cell_centre(x, y);
            // From the cell's nearest side.
            const Eigen::Vector2d off = ((middle - p.head<2>()).cwiseAbs().array() - 0.5 * cell).max(0.0);
            if (off.norm() <= reach) return true;
        }
    }
    return false;
}

/// Smallest and largest place along the line that the plane's raster reaches, metres from its origin.
std::pair<double, double> reach_along(const TruePlane& plane, const Line& line) {
    const PlaneRaster& raster = plane.visible;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const int dx : {0, raster.mask.width}) {
        for (const int dy : {0, raster.mask.height}) {
            const Eigen::Vector3d corner(raster.cell_m * (raster.x0 + dx), raster.cell_m * (raster.y0 + dy),
                                         0);
            const double along = line.direction.dot(plane.world_from_plane * corner - line.origin);
            low = std::min(low, along);
            high = std::max(high, along);
        }
    }
    return {low, high};
}

/// The places where two true planes meet, both seen within `seen_m`, of pieces of at least `least_m`.
void add_edge(const TruePlane& a, const TruePlane& b, double seen_m, double least_m,
              std::vector<Place>& places) {
    const auto line = common_line(a.plane, b.plane, a.centre(), std::sin(kParallel_rad));
    if (!line) return;
    const auto [low_a, high_a] = reach_along(a, *line);
    const auto [low_b, high_b] = reach_along(b, *line);
    const double low = std::max(low_a, low_b) - seen_m, high = std::min(high_a, high_b) + seen_m;
    std::vector<Place> piece;
    const auto end_piece = [&] {
        if (static_cast<double>(piece.size()) * kStep_m >= least_m)
            places.insert(places.end(), piece.begin(), piece.end());
        piece.clear();
    };
    for (double along = low; along <= high; along += kStep_m) {
        const Eigen::Vector3d p = line->origin + along * line->direction;
        if (is_seen_near(a, p, seen_m) && is_seen_near(b, p, seen_m)) {
            piece.push_back({p, line->direction});
        } else {
            end_piece();
        }
    }
    end_piece();
}

/// The places of all edges of planes larger than `least_m2`.
std::vector<Place> true_edges(const std::vector<TruePlane>& truth, double least_m2, double seen_m,
                              double least_m) {
    std::vector<Place> places;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        if (truth[i].visible.area() <= least_m2) continue;
        for (std::size_t j = i + 1; j < truth.size(); ++j)
            if (truth[j].visible.area() > least_m2) add_edge(truth[i], truth[j], seen_m, least_m, places);
    }
    return places;
}

std::vector<Eigen::Vector3d> true_corners(const std::vector<TruePlane>& truth, double least_m2,
                                          double seen_m) {
    std::vector<Eigen::Vector3d> corners;
    const double least_span = least_volume(kParallel_rad);
    for (std::size_t i = 0; i < truth.size(); ++i) {
        for (std::size_t j = i + 1; j < truth.size(); ++j) {
            for (std::size_t k = j + 1; k < truth.size(); ++k) {
                const std::array<const TruePlane*, 3> three{&truth[i], &truth[j], &truth[k]};
                const auto p = common_point(three[0]->plane, three[1]->plane, three[2]->plane, least_span);
                if (p && std::all_of(three.begin(), three.end(), [&](const TruePlane* plane) {
                        return plane->visible.area() > least_m2 && is_seen_near(*plane, *p, seen_m);
                    }))
                    corners.push_back(*p);
            }
        }
    }
    return corners;
}

std::vector<Place> places_of(const PlaneMap& map, const Pose& truth_from_map) {
    std::vector<Place> places;
    for (const IntersectionLine& line : map.lines) {
        const Eigen::Vector3d from = truth_from_map * line.from.cast<double>(),
                              to = truth_from_map * line.to.cast<double>();
        const double length = (to - from).norm();
        const Eigen::Vector3d direction = (to - from) / length;
        for (double along = 0.5 * kStep_m; along < length; along += kStep_m)
            places.push_back({from + along * direction, direction});
    }
    return places;
}

/// How many of the places have one of the others near.
double metres_near(const std::vector<Place>& places, const std::vector<Place>& others,
                   const EdgeLimits& limits) {
    const double least_cosine = std::cos(radians(limits.max_angle_deg));
    const auto count = std::count_if(places.begin(), places.end(), [&](const Place& place) {
        return std::any_of(others.begin(), others.end(), [&](const Place& other) {
            return (other.p - place.p).squaredNorm() <= limits.near_m * limits.near_m &&
                   std::abs(other.direction.dot(place.direction)) >= least_cosine;
        });
    });
    return kStep_m * static_cast<double>(count);
}

std::size_t count_near(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3d>& others,
                       double near_m) {
    return static_cast<std::size_t>(std::count_if(points.begin(), points.end(), [&](const auto& p) {
        return std::any_of(others.begin(), others.end(),
                           [&](const auto& other) { return (other - p).norm() <= near_m; });
    }));
}

/// Distance from a place on the plane to the nearest edge of the outline square to the line; nothing if that
/// is more than `reach`.
std::optional<double> gap_at(const Outline& outline, const Eigen::Vector2d& p, const Eigen::Vector2d& along,
                             double reach) {
    const Eigen::Vector2d across(-along.y(), along.x());
    double nearest = std::numeric_limits<double>::infinity();
    for_each_edge(outline, [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
        const Eigen::Vector2d a(across.dot(from - p), along.dot(from - p)),
            b(across.dot(to - p), along.dot(to - p));
        if (crosses(a, b, 0)) nearest = std::min(nearest, std::abs(x_of_crossing(a, b, 0)));
    });
    return nearest <= reach ? std::optional(nearest) : std::nullopt;
}

}  // namespace

std::optional<double> EdgeJudgement::edges_found() const {
    return share(found_m, true_m);
}
std::optional<double> EdgeJudgement::lines_right() const {
    return share(right_m, lines_m);
}
std::optional<double> EdgeJudgement::corners_found() const {
    return share(static_cast<double>(met), static_cast<double>(corners));
}
std::optional<double> EdgeJudgement::points_right() const {
    return share(static_cast<double>(right_points), static_cast<double>(points));
}

EdgeJudgement judge_edges(const std::vector<TruePlane>& truth, const PlaneMap& map,
                          const Pose& truth_from_map, const EdgeLimits& limits) {
    const std::vector<Place> seen = true_edges(truth, kLeastArea_m2, limits.seen_m, limits.least_m),
                             there = true_edges(truth, 0, limits.there_m, 0),
                             lines = places_of(map, truth_from_map);
    EdgeJudgement judgement;
    judgement.true_m = kStep_m * static_cast<double>(seen.size());
    judgement.found_m = metres_near(seen, lines, limits);
    judgement.lines_m = kStep_m * static_cast<double>(lines.size());
    judgement.right_m = metres_near(lines, there, limits);
    const std::vector<Eigen::Vector3d> corners = true_corners(truth, kLeastArea_m2, limits.corner_seen_m);
    std::vector<Eigen::Vector3d> points;
    for (const IntersectionPoint& point : map.points)
        points.push_back(truth_from_map * point.position.cast<double>());
    judgement.corners = corners.size();
    judgement.met = count_near(corners, points, limits.near_m);
    judgement.points = points.size();
    judgement.right_points = count_near(points, true_corners(truth, 0, limits.there_m), limits.near_m);
    return judgement;
}

std::vector<double> outline_gaps(const PlaneMap& map) {
    constexpr double kReach_m = 0.15;
    std::vector<double> gaps;
    for (const IntersectionLine& line : map.lines) {
        for (const int id : {line.plane_a, line.plane_b}) {
            const MapPlane* plane = map.find(id);
            if (plane == nullptr) continue;
            const Outline outline = plane->outline.rings();
            const Pose plane_from_world = plane->world_from_plane().inverse(Eigen::Isometry);
            const Eigen::Vector2d from = (plane_from_world * line.from.cast<double>()).head<2>(),
                                  to = (plane_from_world * line.to.cast<double>()).head<2>();
            const double length = (to - from).norm();
            const Eigen::Vector2d along = (to - from) / length;
            for (double at = 0.5 * kStep_m; at < length; at += kStep_m)
                if (const auto gap = gap_at(outline, from + at * along, along, kReach_m))
                    gaps.push_back(*gap);
        }
    }
    return gaps;
}

}  // namespace planemap::evaluation
