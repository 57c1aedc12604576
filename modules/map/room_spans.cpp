// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "core/geometry/plane_intersection.hpp"
#include "map/opposite.hpp"
#include "map/queries.hpp"
#include "map/relation.hpp"

namespace planemap::map {

namespace {

constexpr double kLeastOpposite_m2 = 0.1;
constexpr double kThickest_m = 1;   // of what is taken for one wall
constexpr double kEnd_m = 0.005;    // of a look from plane to plane that is left out at either end
constexpr double kDivided = 0.25;   // of what lies opposite: a room's wall of which half was seen divides
constexpr std::size_t kLooks = 25;  // from plane to plane, at most

using Kind = RoomSpan::Kind;

bool is_level(const MapPlane& plane) {
    return plane.label == PlaneLabel::kFloor || plane.label == PlaneLabel::kCeiling;
}

PlaneMap planes_of(const PlaneMap& map, bool level) {
    PlaneMap some;
    for (const MapPlane& plane : map.planes)
        if (level ? is_level(plane) : plane.label == PlaneLabel::kWall) some.planes.push_back(plane);
    return some;
}

/// True when third planes that are parallel to both are between two on more than kDivided of what lies
/// opposite. An open door stands across, and divides nothing.
bool is_divided(const MapPlane& a, const MapPlane& b, const PlaneRelation& relation, const PlaneMap& some) {
    const Eigen::Vector3d along = (relation.on_b - relation.on_a).normalized();
    PlaneMap parallel;
    for (const MapPlane& plane : some.planes)
        if (std::abs(plane.plane().normal.dot(along)) > std::cos(kParallel_rad))
            parallel.planes.push_back(plane);
    const MapQueries planes(parallel);
    const Opposite opposite = opposite_of(a, b, along);
    const std::size_t step = opposite.cells.size() / kLooks + 1;
    const Plane plane_a = a.plane(), plane_b = b.plane();
    int looks = 0, divided = 0;
    for (std::size_t i = step / 2; i < opposite.cells.size(); i += step) {
        const Eigen::Vector3d p = opposite.in_world(opposite.cells[i]);
        const double from = -plane_a.signed_distance(p) / plane_a.normal.dot(along),
                     to = -plane_b.signed_distance(p) / plane_b.normal.dot(along);
        const double range = to - from - 2 * kEnd_m;
        ++looks;
        divided += range > 0 && planes.cast(p + (from + kEnd_m) * along, along, range).has_value();
    }
    return divided > kDivided * looks;
}

std::optional<Kind> kind_of(const MapPlane& a, const MapPlane& b, const PlaneRelation& relation) {
    if (!relation.distance || relation.opposite < kLeastOpposite_m2) return std::nullopt;
    if (is_level(a)) {
        if (a.label == b.label || relation.sides != Sides::kFacing) return std::nullopt;
        return Kind::kFloorToCeiling;
    }
    if (relation.sides == Sides::kFacing) return Kind::kWallToWall;
    if (relation.sides == Sides::kBackToBack && *relation.distance <= kThickest_m)
        return Kind::kWallThickness;
    return std::nullopt;
}

void add_spans(const PlaneMap& some, std::vector<RoomSpan>& spans) {
    for (std::size_t i = 0; i < some.planes.size(); ++i) {
        for (std::size_t j = i + 1; j < some.planes.size(); ++j) {
            const MapPlane *a = &some.planes[i], *b = &some.planes[j];
            if (!(a->normal.dot(b->normal) < 0)) continue;
            if (b->label == PlaneLabel::kFloor) std::swap(a, b);
            const PlaneRelation r = relation(*a, *b);
            const auto kind = kind_of(*a, *b, r);
            if (kind && !is_divided(*a, *b, r, some)) spans.push_back({*kind, a->id, b->id, r});
        }
    }
}

}  // namespace

const char* kind_name(Kind kind) {
    switch (kind) {
        case Kind::kFloorToCeiling:
            return "floor to ceiling";
        case Kind::kWallToWall:
            return "wall to wall";
        case Kind::kWallThickness:
            break;
    }
    return "wall thickness";
}

std::vector<RoomSpan> room_spans(const PlaneMap& map) {
    std::vector<RoomSpan> spans;
    add_spans(planes_of(map, true), spans);
    add_spans(planes_of(map, false), spans);
    std::stable_sort(spans.begin(), spans.end(), [](const RoomSpan& s, const RoomSpan& t) {
        return std::tuple(s.kind, s.a, s.b) < std::tuple(t.kind, t.a, t.b);
    });
    return spans;
}

}  // namespace planemap::map
