// SPDX-License-Identifier: BSD-3-Clause
#include "map/queries.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/outline_frame.hpp"
#include "core/geometry/segment.hpp"

namespace planemap::map {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSurface_m = 0.05;  // so near to a plane, a place is taken by it
constexpr double kBefore_m = 0.25;   // a voxel so near before one may not be free for the noise of depth

/// The point of the outline's area that is nearest to p.
Eigen::Vector2d nearest_in(const Outline& outline, const Eigen::Vector2d& p) {
    if (contains(outline, p)) return p;
    Eigen::Vector2d nearest = Eigen::Vector2d::Zero();
    double nearest2 = kInfinity;
    for_each_edge(outline, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        const Eigen::Vector2d q = nearest_on_segment(p, a, b);
        if ((q - p).squaredNorm() < nearest2) nearest2 = (q - p).squaredNorm(), nearest = q;
    });
    return nearest;
}

Eigen::Vector3d on_plane(const Eigen::Vector2d& p) {
    return {p.x(), p.y(), 0};
}

/// From a point in the plane's frame to a rectangle in the plane: no more than to any outline inside it.
double distance_to(const Eigen::AlignedBox2d& bounds, const Eigen::Vector3d& p_plane) {
    return std::sqrt(bounds.squaredExteriorDistance(p_plane.head<2>()) + p_plane.z() * p_plane.z());
}

/// True when a part of the segment is in the box.
bool meets(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    double first = 0, last = 1;
    for (int i = 0; i < 3; ++i) {
        const double step = to[i] - from[i];
        if (step == 0) {
            if (from[i] < box.min()[i] || from[i] > box.max()[i]) return false;
            continue;
        }
        const double a = (box.min()[i] - from[i]) / step, b = (box.max()[i] - from[i]) / step;
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last;
}

/// Corners of the cut of a box by the plane z = 0 of a frame: where the box's edges cross it.
std::vector<Eigen::Vector2d> cut(const Eigen::AlignedBox3d& box, const Pose& plane_from_world) {
    std::vector<Eigen::Vector2d> corners;
    for (unsigned corner = 0; corner < 8; ++corner) {
        for (unsigned axis = 1; axis < 8; axis *= 2) {
            if (corner & axis) continue;
            const auto at = [&](unsigned c) -> Eigen::Vector3d {
                return plane_from_world * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c));
            };
            const Eigen::Vector3d a = at(corner), b = at(corner | axis);
            if ((a.z() > 0) == (b.z() > 0) && a.z() != 0 && b.z() != 0) continue;
            const double s = a.z() != b.z() ? a.z() / (a.z() - b.z()) : 0;
            corners.emplace_back((a + s * (b - a)).head<2>());
        }
    }
    return corners;
}

/// Distance between two segments where their lines are nearest; infinity if that is not within both: an end
/// is then nearest.
double distance_inside(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1, const Eigen::Vector3d& b0,
                       const Eigen::Vector3d& b1) {
    const Eigen::Vector3d a = a1 - a0, b = b1 - b0, between = b0 - a0;
    const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
    const double determinant = aa * bb - ab * ab;
    if (!(determinant > 1e-14 * aa * bb)) return kInfinity;
    const double da = a.dot(between), db = b.dot(between);
    const double s = (da * bb - db * ab) / determinant, t = (da * ab - db * aa) / determinant;
    if (s < 0 || s > 1 || t < 0 || t > 1) return kInfinity;
    return (between + t * b - s * a).norm();
}

}  // namespace

MapQueries::MapQueries(const PlaneMap& map, SeenSpace seen)
    : seen_(std::move(seen)), up_(map.up.cast<double>()) {
    entries_.reserve(map.planes.size());
    for (const MapPlane& plane : map.planes) {
        Entry entry;
        entry.id = plane.id;
        entry.world_from_plane = plane.world_from_plane();
        entry.plane_from_world = entry.world_from_plane.inverse(Eigen::Isometry);
        entry.outline = plane.outline.rings();
        entry.bounds = planemap::bounds(entry.outline);
        for (const Ring& ring : entry.outline.rings) {
            for (const Eigen::Vector2d& v : ring)
                entry.bounds_world.extend(entry.world_from_plane * on_plane(v));
        }
        if (entry.outline.empty() || !is_valid(entry.world_from_plane)) continue;
        entries_.push_back(std::move(entry));
    }
}

std::optional<MapQueries::Nearest> MapQueries::nearest(const Eigen::Vector3d& p_world, double within) const {
    std::optional<Nearest> best;
    if (!p_world.allFinite()) return best;
    // The nearest box first: what it holds is mostly the answer, and keeps the others' outlines unseen.
    std::vector<double> at_least(entries_.size());
    std::size_t first = 0;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        at_least[i] = distance_to(entries_[i].bounds, entries_[i].plane_from_world * p_world);
        if (at_least[i] < at_least[first]) first = i;
    }
    const auto look_at = [&](const Entry& entry) {
        const Eigen::Vector3d p = entry.plane_from_world * p_world;
        const Eigen::Vector3d q = on_plane(nearest_in(entry.outline, p.head<2>()));
        const double distance = (p - q).norm();
        if (distance > within || (best && distance >= best->distance)) return;
        best = Nearest{entry.id, distance, entry.world_from_plane * q};
    };
    if (!entries_.empty()) look_at(entries_[first]);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        if (i != first && at_least[i] <= within && !(best && at_least[i] >= best->distance))
            look_at(entries_[i]);
    }
    return best;
}

std::vector<int> MapQueries::touching(const Eigen::AlignedBox3d& box) const {
    std::vector<int> ids;
    if (box.isEmpty() || !box.min().allFinite() || !box.max().allFinite()) return ids;
    for (const Entry& entry : entries_) {
        if (!box.intersects(entry.bounds_world)) continue;
        // An edge of the outline is in the box, or the box cuts the plane in a polygon that is as a whole
        // inside the outline or outside.
        bool touches = false;
        for_each_edge(entry.outline, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
            touches = touches ||
                      meets(box, entry.world_from_plane * on_plane(a), entry.world_from_plane * on_plane(b));
        });
        if (!touches) {
            const std::vector<Eigen::Vector2d> corners = cut(box, entry.plane_from_world);
            touches = !corners.empty() && contains(entry.outline, corners[0]);
        }
        if (touches) ids.push_back(entry.id);
    }
    return ids;
}

std::optional<MapQueries::Hit> MapQueries::cast(const Eigen::Vector3d& origin,
                                                const Eigen::Vector3d& direction, double max_range) const {
    std::optional<Hit> first;
    const double length = direction.norm();
    if (!origin.allFinite() || !std::isfinite(length) || length == 0) return first;
    const Eigen::Vector3d ray = direction / length;
    for (const Entry& entry : entries_) {
        const Eigen::Vector3d normal = entry.world_from_plane.linear().col(2);
        const double towards = -normal.dot(ray);
        const double range = normal.dot(origin - entry.world_from_plane.translation()) / towards;
        if (!(range >= 0 && range <= (first ? first->range : max_range)) || towards == 0) continue;
        const Eigen::Vector3d point = origin + range * ray;
        const Eigen::Vector2d p = (entry.plane_from_world * point).head<2>();
        if (!entry.bounds.contains(p) || !contains(entry.outline, p)) continue;
        if (first && range == first->range) continue;
        first = Hit{entry.id, range, point, towards > 0};
    }
    return first;
}

/// Whether a point lies on the outline of a plane or near before it, on the side that it was seen from.
bool MapQueries::is_before_plane(const Eigen::Vector3d& p_world) const {
    return std::any_of(entries_.begin(), entries_.end(), [&](const Entry& entry) {
        const Eigen::Vector3d p = entry.plane_from_world * p_world;
        return p.z() >= -kSurface_m && p.z() <= kBefore_m && entry.bounds.contains(p.head<2>().eval()) &&
               contains(entry.outline, p.head<2>());
    });
}

Place MapQueries::state_at(const Eigen::Vector3d& p_world) const {
    if (!p_world.allFinite()) return Place::kUnknown;
    if (nearest(p_world, kSurface_m)) return Place::kOccupied;
    return seen_.is_free(p_world) || is_before_plane(p_world) ? Place::kFree : Place::kUnknown;
}

std::optional<MapQueries::Stretch> MapQueries::look_along(const Eigen::Vector3d& origin,
                                                          const Eigen::Vector3d& direction,
                                                          double max_range) const {
    constexpr double kStep_m = 0.5 * SeenSpace::kVoxel_m;
    const double length = direction.norm();
    if (!origin.allFinite() || !std::isfinite(length) || length == 0 || !(max_range >= 0))
        return std::nullopt;
    Stretch stretch;
    stretch.hit = cast(origin, direction, max_range);
    const double end = stretch.hit ? stretch.hit->range : max_range;
    const Eigen::Vector3d ray = direction / length;
    // Seen space is bounded, so this ends.
    for (int step = 0; step * kStep_m < end; ++step) {
        const Eigen::Vector3d p = origin + step * kStep_m * ray;
        if (!seen_.is_free(p) && !is_before_plane(p)) return stretch;
        stretch.free = std::min(end, (step + 1) * kStep_m);
    }
    stretch.end = stretch.hit ? Place::kOccupied : Place::kFree;
    return stretch;
}

std::optional<MapQueries::Stretch> MapQueries::free_height(const Eigen::Vector3d& p_floor,
                                                           double ignored) const {
    if (up_.isZero()) return std::nullopt;
    auto stretch = look_along(p_floor + ignored * up_, up_);
    if (!stretch) return stretch;
    stretch->free += ignored;
    if (stretch->hit) stretch->hit->range += ignored;
    return stretch;
}

std::optional<double> MapQueries::gap(int id_a, int id_b) const {
    const Entry *a = find(id_a), *b = find(id_b);
    if (a == nullptr || b == nullptr) return std::nullopt;
    if (a == b) return 0.0;
    double best = kInfinity;
    // A vertex of one and the other's area, or an edge of one that passes through the other.
    for (const auto& both : {std::pair(a, b), std::pair(b, a)}) {
        const Entry *of = both.first, *to = both.second;
        const Pose to_from_of = to->plane_from_world * of->world_from_plane;
        for_each_edge(of->outline, [&](const Eigen::Vector2d& v, const Eigen::Vector2d& w) {
            const Eigen::Vector3d p = to_from_of * on_plane(v), q = to_from_of * on_plane(w);
            if (distance_to(to->bounds, p) < best)
                best = std::min(best, std::hypot(distance(to->outline, p.head<2>()), p.z()));
            if ((p.z() > 0) == (q.z() > 0)) return;
            const Eigen::Vector2d through = (p + p.z() / (p.z() - q.z()) * (q - p)).head<2>();
            if (contains(to->outline, through)) best = 0;
        });
    }
    // An edge of each.
    const Pose a_from_b = a->plane_from_world * b->world_from_plane;
    const Eigen::AlignedBox3d bounds_a(on_plane(a->bounds.min()), on_plane(a->bounds.max()));
    for_each_edge(b->outline, [&](const Eigen::Vector2d& b0, const Eigen::Vector2d& b1) {
        const Eigen::Vector3d p = a_from_b * on_plane(b0), q = a_from_b * on_plane(b1);
        Eigen::AlignedBox3d bounds(p);
        bounds.extend(q);
        if (bounds.exteriorDistance(bounds_a) >= best) return;
        for_each_edge(a->outline, [&](const Eigen::Vector2d& a0, const Eigen::Vector2d& a1) {
            best = std::min(best, distance_inside(on_plane(a0), on_plane(a1), p, q));
        });
    });
    return best;
}

const MapQueries::Entry* MapQueries::find(int id) const {
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), id,
                                     [](const Entry& entry, int wanted) { return entry.id < wanted; });
    return at != entries_.end() && at->id == id ? &*at : nullptr;
}

}  // namespace planemap::map
