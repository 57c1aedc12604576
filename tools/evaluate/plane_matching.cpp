// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/plane_matching.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "core/geometry/angle.hpp"
#include "core/geometry/outline_frame.hpp"

namespace planemap::evaluation {

namespace {

constexpr double kMostOffset_m = 0.5, kMostAngle = radians(20), kLeastOverlap = 0.3;
constexpr double kInPlace_m = 0.03, kInPlaceAngle = radians(2);

/// A plane with what each comparison asks of it.
struct Entry {
    int id;
    Plane plane;
    Pose world_from_plane;
    std::vector<Eigen::Vector3d> corners;  ///< of the outline, world
    Eigen::AlignedBox2d bounds;            ///< of the outline, in the plane
};

std::vector<Entry> entries_of(const PlaneMap& map) {
    std::vector<Entry> entries;
    for (const MapPlane& plane : map.planes) {
        if (plane.outline.empty() || !plane.normal.allFinite() || !plane.center.allFinite()) continue;
        const Outline outline = plane.outline.rings();
        Entry entry{plane.id, plane.plane(), plane.world_from_plane(), {}, bounds(outline)};
        for (const Ring& ring : outline.rings)
            for (const Eigen::Vector2d& v : ring)
                entry.corners.push_back(entry.world_from_plane * Eigen::Vector3d(v.x(), v.y(), 0));
        entries.push_back(std::move(entry));
    }
    return entries;
}

std::optional<PlaneMatch> match(const Entry& a, const Entry& b) {
    const double cosine = a.plane.normal.dot(b.plane.normal);
    if (!(cosine > std::cos(kMostAngle))) return std::nullopt;
    const Pose a_from_world = a.world_from_plane.inverse();
    Eigen::AlignedBox2d of_b;
    for (const Eigen::Vector3d& corner : b.corners) of_b.extend((a_from_world * corner).head<2>());
    const Eigen::AlignedBox2d both = a.bounds.intersection(of_b);
    if (both.isEmpty() || both.volume() < kLeastOverlap * std::min(a.bounds.volume(), of_b.volume()))
        return std::nullopt;
    const Eigen::Vector2d middle = both.center();
    const Eigen::Vector3d p = a.world_from_plane * Eigen::Vector3d(middle.x(), middle.y(), 0);
    const double offset = -(b.plane.normal.dot(p) + b.plane.d) / cosine;
    if (!(std::abs(offset) <= kMostOffset_m)) return std::nullopt;
    return PlaneMatch{a.id, b.id, offset, std::acos(std::min(1.0, cosine))};
}

double cost(const PlaneMatch& pair) {
    return std::abs(pair.offset_m) / kInPlace_m + pair.angle / kInPlaceAngle;
}

}  // namespace

bool PlaneMatch::is_in_place() const {
    return std::abs(offset_m) <= kInPlace_m && angle <= kInPlaceAngle;
}

PlaneMatches match_planes(const PlaneMap& a, const PlaneMap& b) {
    std::vector<PlaneMatch> candidates;
    const std::vector<Entry> of_b = entries_of(b);
    for (const Entry& entry : entries_of(a))
        for (const Entry& other : of_b)
            if (const std::optional<PlaneMatch> pair = match(entry, other)) candidates.push_back(*pair);
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const PlaneMatch& x, const PlaneMatch& y) { return cost(x) < cost(y); });

    PlaneMatches matches;
    std::set<int> taken_a, taken_b;
    for (const PlaneMatch& pair : candidates) {
        if (taken_a.count(pair.a) > 0 || taken_b.count(pair.b) > 0) continue;
        taken_a.insert(pair.a);
        taken_b.insert(pair.b);
        matches.pairs.push_back(pair);
    }
    std::sort(matches.pairs.begin(), matches.pairs.end(),
              [](const PlaneMatch& x, const PlaneMatch& y) { return x.a < y.a; });
    for (const MapPlane& plane : a.planes)
        if (taken_a.count(plane.id) == 0) matches.only_a.push_back(plane.id);
    for (const MapPlane& plane : b.planes) {
        if (taken_b.count(plane.id) > 0) continue;
        matches.only_b.push_back(plane.id);
        const auto lies_on = std::find_if(candidates.begin(), candidates.end(), [&](const PlaneMatch& pair) {
            return pair.b == plane.id && pair.is_in_place();
        });
        matches.on_a.push_back(lies_on == candidates.end() ? -1 : lies_on->a);
    }
    return matches;
}

}  // namespace planemap::evaluation
