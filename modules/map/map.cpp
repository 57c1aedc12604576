// SPDX-License-Identifier: BSD-3-Clause
#include "map/map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "core/validation.hpp"
#include "map/intersections.hpp"
#include "map/merging.hpp"

namespace planemap {

namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;
/// Further out, doubles no longer hold second moments to a millimetre.
constexpr double kMaxCoordinate_m = 1e5;
/// A raster whose frame is tilted further against its plane is drawn anew in the plane's.
constexpr double kMaxTilt_rad = 2 * kRadPerDeg;

Moments scaled(const Moments& moments, double factor) {
    return {factor * moments.count, factor * moments.sum, factor * moments.scatter};
}

/// The outline, or the rectangle of the box for a region without one.
Outline outline_or_box(const PlanarRegion& region) {
    if (!region.outline.empty()) return region.outline;
    const double x = region.box.half_extents.x(), y = region.box.half_extents.y();
    return {{Ring{{-x, -y}, {x, -y}, {x, y}, {-x, y}}}};
}

/// An outline's x, y in frame a, seen along frame b's z in b's x, y.
Outline transformed(const Pose& b_from_a, Outline outline) {
    for (Ring& ring : outline.rings) {
        for (Eigen::Vector2d& v : ring) v = (b_from_a * Eigen::Vector3d(v.x(), v.y(), 0)).head<2>();
    }
    return outline;
}

/// Root mean square distance of a set of points to any plane.
double rms_to(const Plane& plane, const Moments& moments) {
    const double spread = plane.normal.dot(moments.covariance() * plane.normal);
    return std::sqrt(std::max(0.0, spread) + std::pow(plane.signed_distance(moments.mean()), 2));
}

std::vector<int> united(const std::vector<int>& a, const std::vector<int>& b) {
    std::vector<int> result;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(result));
    return result;
}

template <typename T>
std::size_t heap_bytes(const std::vector<T>& v) {
    return v.capacity() * sizeof(T);
}

std::size_t heap_bytes(const Outline& outline) {
    std::size_t bytes = heap_bytes(outline.rings);
    for (const Ring& ring : outline.rings) bytes += heap_bytes(ring);
    return bytes;
}

}  // namespace

void MapOptions::validate() const {
    FieldErrors errors("MapOptions");
    const auto in = [&](const char* field, double value, double low, double high, const char* allowed) {
        errors.require(value >= low && value <= high, field, value, allowed);
    };
    in("merge_angle_deg", merge_angle_deg, 0, 45, "0 to 45");
    in("merge_distance_m", merge_distance_m, 0, 10, "0 to 10");
    in("merge_gap_m", merge_gap_m, 0, 100, "0 to 100");
    in("noise.base_m", noise.base_m, 0, 1, "0 to 1");
    in("noise.quadratic_per_m", noise.quadratic_per_m, 0, 1, "0 to 1");
    in("noise.offset_m", noise.offset_m, -100, 100, "-100 to 100");
    in("pose_sigma_m", pose_sigma_m, 1e-6, 10, "1e-6 to 10");
    in("outline_cell_m", outline_cell_m, 0.005, 1, "0.005 to 1");
    in("outline_tolerance_m", outline_tolerance_m, 0, 1, "0 to 1");
    in("outline_min_ring_m2", outline_min_ring_m2, 0, 100, "0 to 100");
    in("outline_min_views", outline_min_views, 1, 255, "1 to 255");
    in("adjacency_gap_m", adjacency_gap_m, 0, 10, "0 to 10");
    in("adjacency_angle_deg", adjacency_angle_deg, 1, 90, "1 to 90");
    in("adjacency_length_m", adjacency_length_m, 0, 100, "0 to 100");
    in("min_area_m2", min_area_m2, 0, 1e6, "0 to 1e6");
    in("min_keyframes", min_keyframes, 1, 1e6, "1 to 1e6");
    in("moved_m", moved_m, 0, 10, "0 to 10");
    in("moved_deg", moved_deg, 0, 180, "0 to 180");
    in("max_extent_m", max_extent_m, 1, 1000, "1 to 1000");
    errors.throw_if_any();
}

PlaneMapper::PlaneMapper(MapOptions options) : options_(options) {
    options_.validate();
}

/// A valid region whose moments determine a plane, of a size and at a place that a sensor can see.
bool PlaneMapper::is_usable(const PlanarRegion& region) const {
    if (!is_valid(region) || !fit_plane(region.moments).valid) return false;
    const double reach = options_.max_extent_m / 2;
    if (!(region.box.half_extents.norm() <= reach)) return false;
    if (!(region.box.frame_from_box.translation().norm() <= kMaxCoordinate_m)) return false;
    return std::all_of(region.outline.rings.begin(), region.outline.rings.end(), [&](const Ring& ring) {
        return std::all_of(ring.begin(), ring.end(), [&](const auto& v) { return v.norm() <= reach; });
    });
}

void PlaneMapper::add(const Keyframe& keyframe) {
    Stored& stored = keyframes_[keyframe.id];
    const bool replaces_one_in_the_map = stored.world_from_camera.has_value();
    stored.utime = keyframe.utime;
    stored.regions.clear();
    for (const PlanarRegion& region : keyframe.regions) {
        if (is_usable(region)) {
            stored.regions.push_back(region);
        } else {
            ++rejected_;
        }
    }
    std::stable_sort(stored.regions.begin(), stored.regions.end(),
                     [](auto& a, auto& b) { return a.moments.count > b.moments.count; });
    stored.planes.clear();
    if (replaces_one_in_the_map) {
        rebuild();
    } else {
        place(keyframe.id);
    }
    refresh();
}

void PlaneMapper::add(const Keyframe& keyframe, const Pose& world_from_camera) {
    if (is_valid(world_from_camera)) poses_[keyframe.id] = world_from_camera;
    add(keyframe);
}

void PlaneMapper::update(const KeyframeTrajectory& trajectory) {
    bool moved = false;
    for (const KeyframePose& named : trajectory.keyframes) {
        if (!is_valid(named.world_from_camera)) continue;
        poses_[named.id] = named.world_from_camera;
        const auto stored = keyframes_.find(named.id);
        if (stored == keyframes_.end() || !stored->second.world_from_camera) continue;
        const Pose change =
            stored->second.world_from_camera->inverse(Eigen::Isometry) * named.world_from_camera;
        moved = moved || change.translation().norm() > options_.moved_m ||
                rotation_angle(change) > options_.moved_deg * kRadPerDeg;
    }
    map_.revision = trajectory.revision;
    if (moved) {
        rebuild();
    } else {
        for (const KeyframePose& named : trajectory.keyframes) {
            const auto stored = keyframes_.find(named.id);
            if (stored != keyframes_.end() && !stored->second.world_from_camera) place(named.id);
        }
    }
    refresh();
}

std::size_t PlaneMapper::waiting() const {
    return static_cast<std::size_t>(
        std::count_if(keyframes_.begin(), keyframes_.end(),
                      [](const auto& entry) { return !entry.second.world_from_camera; }));
}

/// Puts a keyframe into the map if its pose is known; one that comes late enters by a rebuild, so that the
/// order stays that of the ids.
void PlaneMapper::place(int keyframe_id) {
    if (!poses_.contains(keyframe_id)) return;
    if (in_order(keyframe_id)) {
        integrate(keyframe_id);
    } else {
        rebuild();
    }
}

bool PlaneMapper::in_order(int keyframe_id) const {
    return std::none_of(keyframes_.upper_bound(keyframe_id), keyframes_.end(),
                        [](const auto& entry) { return entry.second.world_from_camera.has_value(); });
}

void PlaneMapper::integrate(int keyframe_id) {
    Stored& stored = keyframes_.at(keyframe_id);
    const Pose& world_from_camera = poses_.at(keyframe_id);
    stored.world_from_camera = world_from_camera;
    stored.planes.clear();
    for (const PlanarRegion& region : stored.regions) {
        auto surface = make_surface(region, world_from_camera, keyframe_id);
        stored.planes.push_back(surface ? insert(std::move(*surface)) : -1);
    }
    map_.utime = std::max(map_.utime, stored.utime);
}

/// Inverse variance of a view about the plane, relative to a noise-free sensor.
double PlaneMapper::weight(const PlanarRegion& region_camera) const {
    const double sigma = options_.noise.sigma(region_camera.moments.mean().z());
    const double pose_variance = options_.pose_sigma_m * options_.pose_sigma_m;
    return pose_variance / (pose_variance + sigma * sigma);
}

std::optional<PlaneMapper::Surface> PlaneMapper::make_surface(const PlanarRegion& region_camera,
                                                              const Pose& world_from_camera,
                                                              int keyframe_id) const {
    const Pose world_from_box = world_from_camera * region_camera.box.frame_from_box;
    if (!(world_from_box.translation().norm() <= kMaxCoordinate_m)) return std::nullopt;
    Surface surface;
    surface.moments = world_from_camera * region_camera.moments;
    surface.weighted = scaled(surface.moments, weight(region_camera));
    surface.facing = surface.weighted.count * (world_from_camera.linear() * region_camera.plane.normal);
    surface.keyframes = {keyframe_id};
    surface.plane = fit_plane(surface.weighted).plane;
    surface.box.half_extents.z() = region_camera.box.half_extents.z();

    for (const Ring& ring : outline_or_box(region_camera).rings) {
        for (const Eigen::Vector2d& v : ring)
            surface.hull.push_back(world_from_box * Eigen::Vector3d(v.x(), v.y(), 0));
    }
    surface.patches = {{&region_camera, world_from_camera}};
    refit(surface);
    return surface;
}

/// Plane, hull and box after the moments or the hull's points changed.
void PlaneMapper::refit(Surface& surface) const {
    const PlaneFit fit = fit_plane(surface.weighted);
    if (fit.valid) surface.plane = fit.plane;
    if (surface.plane.normal.dot(surface.facing) < 0) surface.plane = surface.plane.flipped();

    Pose world_from_plane = Pose::Identity();
    world_from_plane.linear() = plane_axes(surface.plane.normal, fit.axes.col(2));
    world_from_plane.translation() = surface.plane.project(surface.hull.front());
    const Pose plane_from_world = world_from_plane.inverse(Eigen::Isometry);
    std::vector<Eigen::Vector2d> flat;
    for (const Eigen::Vector3d& p : surface.hull) flat.emplace_back((plane_from_world * p).head<2>());
    if (Ring hull = convex_hull(flat); !hull.empty()) flat = std::move(hull);
    surface.hull.clear();
    for (const Eigen::Vector2d& v : flat)
        surface.hull.push_back(world_from_plane * Eigen::Vector3d(v.x(), v.y(), 0));

    const double half_z = surface.box.half_extents.z();
    surface.box = bound(world_from_plane.linear(), surface.hull);
    surface.box.half_extents.z() = half_z;
    surface.changed = true;
}

/// Merges `from` into `into`: moments add up, the box holds both (paper section 2.3).
void PlaneMapper::absorb(Surface& into, Surface&& from) const {
    into.moments += from.moments;
    into.weighted += from.weighted;
    into.facing += from.facing;
    into.keyframes = united(into.keyframes, from.keyframes);
    into.hull.insert(into.hull.end(), from.hull.begin(), from.hull.end());
    into.patches.insert(into.patches.end(), from.patches.begin(), from.patches.end());
    if (from.grid.cell_count() > into.grid.cell_count()) std::swap(into.grid, from.grid);
    into.grid.add(from.grid);
    const double step = std::abs(into.plane.signed_distance(from.box.frame_from_box.translation()));
    into.box.half_extents.z() = std::max(into.box.half_extents.z(), step + from.box.half_extents.z());
    refit(into);
}

/// Brings the raster up to date: in the plane's frame, with all patches drawn.
void PlaneMapper::draw(Surface& surface) const {
    const bool tilted =
        angle_between(surface.grid.world_from_grid().linear().col(2), surface.plane.normal) > kMaxTilt_rad;
    if (surface.grid.empty() || tilted) {
        EvidenceGrid level(surface.box.frame_from_box, options_.outline_cell_m);
        level.add(surface.grid);
        surface.grid = std::move(level);
    }
    const Pose grid_from_world = surface.grid.world_from_grid().inverse(Eigen::Isometry);
    for (const Patch& patch : surface.patches) {
        const PlanarRegion& region = *patch.region_camera;
        surface.grid.add(transformed(grid_from_world * patch.world_from_camera * region.box.frame_from_box,
                                     outline_or_box(region)));
    }
    surface.patches = {};
}

/// The surface that fits another one best among those that satisfy the rules.
std::optional<std::size_t> PlaneMapper::best_partner(std::size_t index) const {
    const MergeRules rules{options_.merge_angle_deg * kRadPerDeg, options_.merge_distance_m,
                           options_.merge_gap_m};
    const Surface& a = surfaces_[index];
    std::optional<std::size_t> best;
    double best_score = 0;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        if (i == index) continue;
        const Surface& b = surfaces_[i];
        const auto relation = same_plane(a.plane, a.box, b.plane, b.box, rules);
        if (!relation) continue;
        const double length =
            (a.box.frame_from_box.translation() - b.box.frame_from_box.translation()).norm();
        if (length + a.box.half_extents.norm() + b.box.half_extents.norm() > options_.max_extent_m) continue;
        const double score = relation->angle_rad / std::max(rules.angle_rad, 1e-9) +
                             relation->distance_m / std::max(rules.distance_m, 1e-9) +
                             relation->gap_m / std::max(rules.gap_m, 1e-9);
        if (!best || score < best_score) {
            best = i;
            best_score = score;
        }
    }
    return best;
}

/// Adds a surface and merges until no pair satisfies the rules; returns the id of the plane it is in now.
/// Only pairs with the surface that grew need another look: all others were apart before.
int PlaneMapper::insert(Surface surface) {
    surface.id = next_id_;
    surfaces_.push_back(std::move(surface));
    std::size_t grown = surfaces_.size() - 1;
    bool is_new = true;
    while (const auto partner = best_partner(grown)) {
        std::size_t into = std::min(grown, *partner), from = std::max(grown, *partner);
        const int kept = std::min(surfaces_[into].id, surfaces_[from].id);
        const int gone = std::max(surfaces_[into].id, surfaces_[from].id);
        if (!is_new) merged_into_[gone] = kept;
        is_new = false;
        absorb(surfaces_[into], std::move(surfaces_[from]));
        surfaces_[into].id = kept;
        surfaces_.erase(surfaces_.begin() + static_cast<std::ptrdiff_t>(from));
        grown = into;
    }
    if (is_new) ++next_id_;
    return surfaces_[grown].id;
}

int PlaneMapper::resolved(int plane_id) const {
    for (auto next = merged_into_.find(plane_id); next != merged_into_.end();
         next = merged_into_.find(plane_id)) {
        plane_id = next->second;
    }
    return plane_id;
}

void PlaneMapper::rebuild() {
    ++rebuilds_;
    std::map<int, std::vector<int>> planes_before;
    for (auto& [id, stored] : keyframes_) {
        for (int& plane : stored.planes) plane = resolved(plane);
        planes_before[id] = stored.planes;
    }
    const int first_new_id = next_id_;
    surfaces_.clear();
    merged_into_.clear();
    for (const auto& [id, stored] : keyframes_) {
        if (poses_.contains(id)) integrate(id);
    }
    keep_ids(planes_before, first_new_id);
}

/// Gives each rebuilt plane the id of the earlier plane that most of its inliers were in; each id once, the
/// strongest claim first. Planes without a claim get new ids.
void PlaneMapper::keep_ids(const std::map<int, std::vector<int>>& planes_before, int first_new_id) {
    std::map<std::pair<int, int>, double> votes;  // (id before, id now): inliers
    for (const auto& [id, stored] : keyframes_) {
        const std::vector<int>& before = planes_before.at(id);
        for (std::size_t i = 0; i < std::min(before.size(), stored.planes.size()); ++i) {
            if (before[i] < 0 || stored.planes[i] < 0) continue;
            votes[{before[i], resolved(stored.planes[i])}] += stored.regions[i].moments.count;
        }
    }
    std::vector<std::pair<double, std::pair<int, int>>> claims;
    for (const auto& [pair, inliers] : votes) claims.push_back({-inliers, pair});
    std::sort(claims.begin(), claims.end());
    std::map<int, int> name;  // id now: id before
    std::set<int> taken;
    for (const auto& [inliers, pair] : claims) {
        if (name.contains(pair.second) || taken.contains(pair.first)) continue;
        name[pair.second] = pair.first;
        taken.insert(pair.first);
    }
    next_id_ = first_new_id;
    for (Surface& surface : surfaces_) {
        const auto known = name.try_emplace(surface.id, next_id_);
        if (known.second) ++next_id_;
        surface.id = known.first->second;
    }
    for (auto& [id, stored] : keyframes_) {
        for (int& plane : stored.planes) plane = plane < 0 ? -1 : name.at(resolved(plane));
    }
    merged_into_.clear();
}

MapPlane PlaneMapper::derive(const Surface& surface) const {
    PlanarRegion region;
    region.plane = surface.plane;
    region.moments = surface.moments;
    region.box = surface.box;
    region.rms = rms_to(surface.plane, surface.moments);
    const Outline outline_grid = surface.grid.outline(
        {options_.outline_min_views, options_.outline_min_ring_m2, options_.outline_tolerance_m});
    region.outline = transformed(
        surface.box.frame_from_box.inverse(Eigen::Isometry) * surface.grid.world_from_grid(), outline_grid);
    return {surface.id, region, surface.keyframes.size()};
}

/// Brings map_ up to date: only planes that changed are derived anew, with the intersections they are in.
void PlaneMapper::refresh() {
    std::map<int, MapPlane> before;
    for (MapPlane& plane : map_.planes) before.emplace(plane.id, std::move(plane));
    std::vector<int> changed;
    std::vector<MapPlane> planes;
    for (Surface& surface : surfaces_) {
        const auto known = before.find(surface.id);
        if (surface.changed) {
            surface.changed = false;
            changed.push_back(surface.id);
            draw(surface);
            if (static_cast<int>(surface.keyframes.size()) < options_.min_keyframes) continue;
            MapPlane plane = derive(surface);
            if (static_cast<double>(plane.area) >= options_.min_area_m2 && plane.area > 0)
                planes.push_back(std::move(plane));
        } else if (known != before.end()) {
            planes.push_back(std::move(known->second));
        }
    }
    std::sort(planes.begin(), planes.end(), [](auto& a, auto& b) { return a.id < b.id; });
    planes.shrink_to_fit();
    map_.planes = std::move(planes);
    std::sort(changed.begin(), changed.end());
    refresh_intersections(changed);
}

void PlaneMapper::refresh_intersections(const std::vector<int>& changed_ids) {
    const AdjacencyRules rules{options_.adjacency_gap_m, options_.adjacency_angle_deg * kRadPerDeg,
                               options_.adjacency_length_m};
    std::map<int, const MapPlane*> planes;
    for (const MapPlane& plane : map_.planes) planes[plane.id] = &plane;
    const auto is_changed = [&](int id) {
        return std::binary_search(changed_ids.begin(), changed_ids.end(), id);
    };
    const auto is_stale = [&](int id) { return is_changed(id) || !planes.contains(id); };
    std::erase_if(map_.lines, [&](auto& line) { return is_stale(line.plane_a) || is_stale(line.plane_b); });
    std::erase_if(map_.points, [&](auto& point) {
        return std::any_of(point.planes.begin(), point.planes.end(), is_stale);
    });

    for (const auto& [a, plane_a] : planes) {
        for (const auto& [b, plane_b] : planes) {
            if (b <= a || !(is_changed(a) || is_changed(b))) continue;
            const auto lines = intersection_lines(*plane_a, *plane_b, rules);
            map_.lines.insert(map_.lines.end(), lines.begin(), lines.end());
        }
    }
    std::stable_sort(map_.lines.begin(), map_.lines.end(), [](auto& x, auto& y) {
        return std::pair(x.plane_a, x.plane_b) < std::pair(y.plane_a, y.plane_b);
    });

    std::map<int, std::set<int>> above;  // adjacent planes with a larger id
    for (const IntersectionLine& line : map_.lines) above[line.plane_a].insert(line.plane_b);
    for (const auto& [a, adjacent] : above) {
        for (const int b : adjacent) {
            if (!above.contains(b)) continue;
            for (const int c : above.at(b)) {
                if (!adjacent.contains(c) || !(is_changed(a) || is_changed(b) || is_changed(c))) continue;
                const auto point = intersection_point(*planes[a], *planes[b], *planes[c], rules);
                if (point) map_.points.push_back(*point);
            }
        }
    }
    std::sort(map_.points.begin(), map_.points.end(), [](auto& x, auto& y) { return x.planes < y.planes; });
    map_.lines.shrink_to_fit();
    map_.points.shrink_to_fit();
}

std::size_t PlaneMapper::memory_bytes() const {
    return planemap::memory_bytes(map_);
}

std::map<int, std::vector<int>> PlaneMapper::sightings() const {
    std::map<int, std::vector<int>> result;
    for (const Surface& surface : surfaces_) result[surface.id] = surface.keyframes;
    return result;
}

std::size_t PlaneMapper::working_bytes() const {
    std::size_t bytes = poses_.size() * sizeof(std::pair<int, Pose>);
    for (const auto& [id, stored] : keyframes_) {
        bytes += sizeof stored + heap_bytes(stored.regions) + heap_bytes(stored.planes);
        for (const PlanarRegion& region : stored.regions) bytes += heap_bytes(region.outline);
    }
    for (const Surface& surface : surfaces_) {
        bytes += sizeof surface + surface.grid.cell_count() + heap_bytes(surface.hull) +
                 heap_bytes(surface.keyframes);
    }
    return bytes;
}

}  // namespace planemap
