// SPDX-License-Identifier: BSD-3-Clause
#include "map/map.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <thread>

#include "map/hand_over.hpp"
#include "map/labels.hpp"

namespace planemap {

namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180;
/// Further out, doubles no longer hold second moments to a millimetre.
constexpr double kMaxCoordinate_m = 1e5;
/// No depth camera sees a region that reaches further from its middle, nor more of them: a raster takes
/// memory.
constexpr double kMaxRegionReach_m = 25;
constexpr std::size_t kMaxRegions = 256;
/// An outline is traced again when so many cells came or went, as many as the smallest hole has (0.01 m2).
constexpr int kCellsOfNote = 16;
/// A plane whose points moved less keeps its outline and its intersections.
constexpr double kMoveOfNote_m = 0.001;
/// Said of a shape of which all has to be traced.
constexpr int kAllCells = 1 << 20;
/// Views that a rebuild looks through a plane with, and more of them for each square metre.
constexpr double kLooks = 24, kLooksPerM2 = 1;
constexpr std::size_t kMaxWaiting = 4096;
/// Keyframes between two that arrive.
constexpr std::int64_t kMostMissed = 10000;
/// Keyframes near one that goes, which take over what it saw.
constexpr std::size_t kHeirs = 8;
/// Triples of planes looked at for corners in one refresh. Ten storeys with a hundred rooms each take a
/// tenth.
constexpr std::size_t kMaxLooksForCorners = std::size_t{1} << 22;
/// Cells of the rasters of a map to start from, a byte each: 80,000 m2 at 2.5 cm.
constexpr double kStartCells = 1 << 27;
/// Hits of a look through a cell: 2^1.
constexpr int kDoubtStrength = 1;

/// Root mean square distance of a set of points to any plane.
double rms_to(const Plane& plane, const Moments& moments) {
    const double spread = plane.normal.dot(moments.covariance() * plane.normal);
    return std::sqrt(std::max(0.0, spread) + std::pow(plane.signed_distance(moments.mean()), 2));
}

/// A pose near enough to the origin for doubles to hold second moments.
bool is_near(const Pose& world_from_camera) {
    return is_valid(world_from_camera) && world_from_camera.translation().norm() <= kMaxCoordinate_m;
}

/// An outline's x, y in frame a, seen along frame b's z in b's x, y.
Outline transformed(const Pose& b_from_a, Outline outline) {
    for (Ring& ring : outline.rings) {
        for (Eigen::Vector2d& v : ring) v = (b_from_a * Eigen::Vector3d(v.x(), v.y(), 0)).head<2>();
    }
    return outline;
}

/// Of the rectangle around a plane's outline, which its raster covers.
double raster_area(const MapPlane& plane) {
    Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = low;
    const Outline outline = plane.outline.rings();
    for (const Ring& ring : outline.rings) {
        for (const Eigen::Vector2d& v : ring) {
            low = low.cwiseMin(v);
            high = high.cwiseMax(v);
        }
    }
    return (high - low).prod();
}

/// The most cells that a raster may have, so that all of them keep within kStartCells: small planes take what
/// they need, and the large ones share the rest evenly. Infinity if there is room for all.
double largest_share(std::vector<double> areas, double cell_area) {
    std::sort(areas.begin(), areas.end());
    double left = kStartCells;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        const double share = left / static_cast<double>(areas.size() - i), cells = areas[i] / cell_area;
        if (cells > share) return share;
        left -= cells;
    }
    return std::numeric_limits<double>::infinity();
}

}  // namespace

PlaneMapper::PlaneMapper(MapOptions options)
    : options_(options),
      set_({options.merge_angle_deg * kRadPerDeg, options.merge_distance_m, options.merge_gap_m},
           options.max_extent_m) {
    options_.validate();
}

/// A valid region whose moments determine a plane, of a size and at a place that a sensor can see.
bool PlaneMapper::is_usable(const PlanarRegion& region) const {
    if (!is_valid(region) || !fit_plane(region.moments).valid) return false;
    const double reach = std::min(options_.max_extent_m / 2, kMaxRegionReach_m);
    if (!(region.box.half_extents.norm() <= reach)) return false;
    if (!(region.box.frame_from_box.translation().norm() <= kMaxCoordinate_m)) return false;
    // Moments, plane and box say the same.
    const Eigen::Vector3d mean = region.moments.mean();
    if (!(region.moments.count <= 1e9)) return false;
    if (!((mean - region.box.frame_from_box.translation()).norm() <= region.box.half_extents.norm() + 1))
        return false;
    if (!(std::abs(region.plane.signed_distance(mean)) <= 1)) return false;
    return std::all_of(region.outline.rings.begin(), region.outline.rings.end(), [&](const Ring& ring) {
        return ring.size() <= 32767 &&
               std::all_of(ring.begin(), ring.end(), [&](const auto& v) { return v.norm() <= reach; });
    });
}

void PlaneMapper::start_from(const PlaneMap& map) {
    std::vector<const MapPlane*> usable;
    std::vector<double> areas;
    for (const MapPlane& plane : map.planes) {
        double reach = static_cast<double>(plane.half_extents.norm());
        for (const std::int16_t steps : plane.outline.packed)
            reach = std::max(reach, std::abs(static_cast<double>(plane.outline.unit) * steps));
        if (!(plane.id >= 0 && plane.id < 1 << 30 && reach <= options_.max_extent_m &&
              static_cast<double>(plane.center.norm()) <= kMaxCoordinate_m)) {
            ++losses_.planes_refused;
            continue;
        }
        usable.push_back(&plane);
        areas.push_back(raster_area(plane));
    }
    const double most_cells = largest_share(areas, std::pow(options_.outline_cell_m, 2));
    for (std::size_t i = 0; i < usable.size(); ++i) {
        const double cell = std::max(options_.outline_cell_m, std::sqrt(areas[i] / most_cells));
        coarsened_ += cell > options_.outline_cell_m;
        fixed_.emplace_back(*usable[i], cell);
        next_id_ = std::max(next_id_, usable[i]->id + 1);
    }
    map_.utime = map.utime;
    map_.up = map.up;
    rebuild();
    refresh();
    for (MapPlane& plane : map_.planes) {
        if (const MapPlane* before = map.find(plane.id)) plane.label = before->label;
    }
}

void PlaneMapper::add(const Keyframe& keyframe) {
    if (keyframe.id <= folded_up_to_) {  // what it saw is in the planes
        ++losses_.keyframes_too_late;
        return;
    }
    if (newest_id_ >= 0 && keyframe.id - std::int64_t{newest_id_} > kMostMissed) {
        ++losses_.keyframes_far_ahead;
        return;
    }
    const auto earlier = keyframes_.find(keyframe.id);
    if (earlier != keyframes_.end() && earlier->second.world_from_camera &&
        earlier->second.utime != keyframe.utime) {  // an odometry that started again: the pose is not its
        ++losses_.keyframes_of_others;
        return;
    }
    newest_id_ = std::max(newest_id_, keyframe.id);
    std::vector<PlanarRegion> regions;
    for (const PlanarRegion& region : keyframe.regions) {
        if (!is_usable(region)) {
            ++losses_.regions_refused;
        } else if (regions.size() == kMaxRegions) {
            ++losses_.regions_too_many;
        } else {
            regions.push_back(region);
        }
    }
    std::stable_sort(regions.begin(), regions.end(),
                     [](auto& a, auto& b) { return a.moments.count > b.moments.count; });
    StoredKeyframe& kept = keyframes_[keyframe.id];
    const bool replaces_one_in_the_map = kept.world_from_camera.has_value();
    kept = stored(keyframe.utime, regions);
    kept.noise = keyframe.noise;
    if (replaces_one_in_the_map) {
        rebuild();
    } else {
        place(keyframe.id);
    }
    drop_waiting();
    refresh();
}

/// Keyframes whose poses never come do not pile up.
void PlaneMapper::drop_waiting() {
    for (std::size_t n = waiting(); n > kMaxWaiting; --n) {
        keyframes_.erase(std::find_if(keyframes_.begin(), keyframes_.end(),
                                      [](const auto& entry) { return !entry.second.world_from_camera; }));
        ++losses_.keyframes_unplaced;
    }
}

void PlaneMapper::add(const Keyframe& keyframe, const Pose& world_from_camera) {
    if (is_near(world_from_camera)) poses_[keyframe.id] = world_from_camera;
    add(keyframe);
}

void PlaneMapper::update(const KeyframeTrajectory& trajectory) {
    replace(replacements(named_, trajectory.keyframes));
    named_ = trajectory.keyframes;
    bool moved = false;
    for (const KeyframePose& named : trajectory.keyframes) {
        if (named.id <= folded_up_to_) continue;
        if (!is_near(named.world_from_camera)) {
            ++losses_.poses_refused;
            continue;
        }
        poses_[named.id] = named.world_from_camera;
        const auto kept = keyframes_.find(named.id);
        if (kept == keyframes_.end() || !kept->second.world_from_camera) continue;
        const Pose change =
            kept->second.world_from_camera->inverse(Eigen::Isometry) * named.world_from_camera;
        settled_ = settled_ && kept->second.world_from_camera->isApprox(named.world_from_camera, 0);
        moved = moved || change.translation().norm() > options_.moved_m ||
                rotation_angle(change) > options_.moved_deg * kRadPerDeg;
    }
    map_.revision = trajectory.revision;
    if (moved) {
        rebuild();
    } else {
        for (const KeyframePose& named : trajectory.keyframes) {
            const auto kept = keyframes_.find(named.id);
            if (kept != keyframes_.end() && !kept->second.world_from_camera) place(named.id);
        }
    }
    refresh();
}

void PlaneMapper::settle() {
    if (settled_) return;
    rebuild();
    refresh();
}

std::size_t PlaneMapper::waiting() const {
    return static_cast<std::size_t>(
        std::count_if(keyframes_.begin(), keyframes_.end(),
                      [](const auto& entry) { return !entry.second.world_from_camera; }));
}

/// Puts a keyframe into the map if its pose is known.
void PlaneMapper::place(int keyframe_id) {
    if (!poses_.contains(keyframe_id)) return;
    integrate(keyframe_id);
    fold();
}

PlaneMapper::View::View(const StoredKeyframe& seen)
    : keyframe(&seen), camera_from_world(seen.world_from_camera->inverse(Eigen::Isometry)) {
    for (const StoredRegion& region : seen.regions) {
        const Eigen::Quaterniond q = Eigen::Quaterniond(region.camera_from_box.cast<double>()).normalized();
        const Eigen::Vector3d normal = q * Eigen::Vector3d::UnitZ();
        planes.push_back({normal, -normal.dot(region.center.cast<double>())});
    }
}

/// Inverse variance of a view about the plane, relative to a noise-free sensor.
double PlaneMapper::weight(const StoredRegion& region, const DepthNoise& noise) const {
    const double sigma = noise.sigma(mean_depth(region));
    const double pose_variance = options_.pose_sigma_m * options_.pose_sigma_m;
    return pose_variance / (pose_variance + sigma * sigma);
}

Reliability PlaneMapper::reliability(const StoredRegion& region, const DepthNoise& noise) const {
    return {weight(region, noise), std::hypot(options_.agreement_m, noise.sigma(mean_depth(region)))};
}

/// What a view counts for in the shape: 2^strength.
int PlaneMapper::strength(const StoredRegion& region, const DepthNoise& noise) const {
    const double w = weight(region, noise);
    return w > 0.5 ? 2 : w > 0.2 ? 1 : 0;
}

/// A new surface of one region; nothing is drawn yet.
Surface PlaneMapper::surface_of(int id, const PlacedRegion& placed, const StoredRegion& region,
                                const StoredKeyframe& keyframe) {
    outline_in(Pose::Identity(), region, keyframe, polygon_);
    Surface surface(placed, polygon_, reliability(region, keyframe.noise));
    surface.id = id;
    return surface;
}

/// Takes a region into a surface; its shape is not drawn.
void PlaneMapper::take_in(Surface& surface, const PlacedRegion& placed, const StoredRegion& region,
                          const StoredKeyframe& keyframe) {
    outline_in(surface.world_from_extent.inverse(Eigen::Isometry) * placed.box.frame_from_box, region,
               keyframe, polygon_);
    surface.add(placed, polygon_, reliability(region, keyframe.noise));
}

/// Draws a region that a surface took in, and counts its keyframe.
void PlaneMapper::draw(Surface& surface, const PlacedRegion& placed, const StoredRegion& region,
                       const StoredKeyframe& keyframe, int keyframe_id) {
    if (surface.grid.empty())
        surface.grid = EvidenceGrid(surface.box.frame_from_box, options_.outline_cell_m);
    outline_in(surface.grid.world_from_grid().inverse(Eigen::Isometry) * placed.box.frame_from_box, region,
               keyframe, polygon_);
    surface.unshown += surface.grid.add(polygon_, strength(region, keyframe.noise));
    if (surface.last_keyframe != keyframe_id) surface.keyframes += region.keyframes;
    surface.last_keyframe = keyframe_id;
}

/// Takes a region into the surface that it fits best, or into a new one; returns which. Its shape is not
/// drawn.
std::size_t PlaneMapper::join(SurfaceSet& set, const PlacedRegion& placed, const StoredRegion& region,
                              const StoredKeyframe& keyframe) {
    const std::size_t at = set.partner_of(placed);
    if (at == SurfaceSet::none()) return set.push_back(surface_of(next_id_++, placed, region, keyframe));
    take_in(set.surfaces()[at], placed, region, keyframe);
    set.update(at);
    return at;
}

void PlaneMapper::integrate(int keyframe_id) {
    StoredKeyframe& keyframe = keyframes_.at(keyframe_id);
    const Pose& world_from_camera = poses_.at(keyframe_id);
    keyframe.world_from_camera = world_from_camera;
    settled_ = false;
    std::vector<std::size_t> grown;
    for (StoredRegion& region : keyframe.regions) {
        region.plane = -1;
        const PlacedRegion placed(world_from_camera, region);
        if (!(placed.box.frame_from_box.translation().norm() <= kMaxCoordinate_m)) {
            ++losses_.regions_too_far;
            continue;
        }
        const std::size_t at = join(set_, placed, region, keyframe);
        Surface& surface = set_.surfaces()[at];
        draw(surface, placed, region, keyframe, keyframe_id);
        region.plane = surface.id;
        grown.push_back(at);
    }
    std::sort(grown.begin(), grown.end());
    grown.erase(std::unique(grown.begin(), grown.end()), grown.end());
    for (const std::size_t i : grown) {
        set_.surfaces()[i].refit();
        set_.update(i);
    }
    merge(grown);
    const View view(keyframe);
    std::vector<EvidenceGrid::Block> blocks;
    for (Surface& surface : set_.surfaces()) look_through(surface, view, blocks);
    map_.utime = std::max(map_.utime, keyframe.utime);
}

/// Counts against a surface's cells that a keyframe saw past them.
void PlaneMapper::look_through(Surface& surface, const View& view,
                               std::vector<EvidenceGrid::Block>& blocks) const {
    std::optional<Footprint> footprint = footprint_of(surface, view);
    if (!footprint) return;
    blocks.clear();
    surface.grid.doubtful_blocks(footprint->low, footprint->high, blocks);
    doubt(surface, view, *footprint, blocks);
}

/// The same for many keyframes. What is doubtful is looked for once; and as a few looks settle it, of a
/// thousand views of the same place some are enough: what is looked through grows with the building.
void PlaneMapper::look_through(Surface& surface, const std::vector<View>& views) const {
    std::vector<EvidenceGrid::Block> blocks;
    const Eigen::Vector2d everywhere = Eigen::Vector2d::Constant(1e9);
    surface.grid.doubtful_blocks(-everywhere, everywhere, blocks);
    if (blocks.empty()) return;
    std::vector<std::pair<const View*, Footprint>> near;
    for (const View& view : views) {
        if (const auto footprint = footprint_of(surface, view)) near.emplace_back(&view, *footprint);
    }
    const double area = 4 * surface.box.half_extents.x() * surface.box.half_extents.y();
    const std::size_t stride = 1 + near.size() / static_cast<std::size_t>(kLooks + kLooksPerM2 * area);
    for (std::size_t i = 0; i < near.size(); i += stride)
        doubt(surface, *near[i].first, near[i].second, blocks);
}

/// Where on a surface a view may fall; nothing if it does not.
std::optional<PlaneMapper::Footprint> PlaneMapper::footprint_of(const Surface& surface,
                                                                const View& view) const {
    const Sight& sight = view.keyframe->sight;
    const Eigen::Vector3d center = view.camera_from_world * (0.5 * (surface.low + surface.high));
    const double radius = 0.5 * (surface.high - surface.low).norm();
    // Outside the view: behind the camera, beyond its reach, or beside its pyramid.
    if (center.z() < -radius || center.squaredNorm() > std::pow(radius + sight.reach(), 2))
        return std::nullopt;
    const auto beside = [&](double low, double high, double across) {
        return low * center.z() - across > radius * std::sqrt(1 + low * low) ||
               across - high * center.z() > radius * std::sqrt(1 + high * high);
    };
    const Eigen::Vector2d low = sight.low(), high = sight.high();
    if (beside(low.x(), high.x(), center.x()) || beside(low.y(), high.y(), center.y())) return std::nullopt;
    Footprint footprint;
    footprint.camera_from_grid = view.camera_from_world * surface.grid.world_from_grid();
    const Eigen::Vector3d origin = footprint.camera_from_grid.translation();
    const Eigen::Matrix3d& axes = footprint.camera_from_grid.linear();
    // The pyramid of the view, down to its reach, laid on the plane.
    const double reach = sight.reach();
    const Eigen::Vector2d foot(-axes.col(0).dot(origin), -axes.col(1).dot(origin));
    double height_low = -axes.col(2).dot(origin), height_high = height_low;
    footprint.low = footprint.high = foot;
    for (const double u : {low.x(), high.x()}) {
        for (const double v : {low.y(), high.y()}) {
            const Eigen::Vector3d corner = axes.transpose() * (reach * Eigen::Vector3d(u, v, 1) - origin);
            footprint.low = footprint.low.cwiseMin(corner.head<2>());
            footprint.high = footprint.high.cwiseMax(corner.head<2>());
            height_low = std::min(height_low, corner.z());
            height_high = std::max(height_high, corner.z());
        }
    }
    if (height_low > 0 || height_high < 0) return std::nullopt;
    return footprint;
}

void PlaneMapper::doubt(Surface& surface, const View& view, const Footprint& footprint,
                        const std::vector<EvidenceGrid::Block>& blocks) const {
    const Eigen::Vector3d origin = footprint.camera_from_grid.translation();
    const Eigen::Vector3d x = footprint.camera_from_grid.linear().col(0),
                          y = footprint.camera_from_grid.linear().col(1),
                          normal = footprint.camera_from_grid.linear().col(2);
    int lost = 0;
    const auto first =
        std::lower_bound(blocks.begin(), blocks.end(), footprint.low.y(),
                         [](const EvidenceGrid::Block& block, double low) { return block.middle.y() < low; });
    for (auto at = first; at != blocks.end(); ++at) {
        const EvidenceGrid::Block& block = *at;
        if (block.middle.x() < footprint.low.x() || block.middle.x() > footprint.high.x()) continue;
        if (block.middle.y() > footprint.high.y()) break;  // they come row after row
        const Eigen::Vector3d p = origin + block.middle.x() * x + block.middle.y() * y;
        const std::uint8_t region = view.keyframe->sight.region_at(p);
        if (region == Sight::kNone) continue;
        const double facing = normal.dot(p);
        if (facing * facing < 0.04 * p.squaredNorm()) continue;  // grazing: a pixel is a long strip
        const Plane& beyond = view.planes[region];
        // Depth of that region along the ray through the point.
        const double depth = -beyond.d / beyond.normal.dot(p) * p.z();
        if (depth > p.z() + options_.see_through_m + 2 * view.keyframe->noise.sigma(depth))
            lost += surface.grid.doubt(block, kDoubtStrength);
    }
    surface.unshown += lost;
    surface.changed = surface.changed || lost > 0;
}

/// Merges surfaces that have come to satisfy the rules.
void PlaneMapper::merge(const std::vector<std::size_t>& grown) {
    std::vector<int> ids;
    for (const Surface& surface : set_.surfaces()) ids.push_back(surface.id);
    const std::vector<std::size_t> now = set_.merge(grown);
    bool any = false;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const int id = set_.surfaces()[now[i]].id;
        if (id == ids[i]) continue;
        merged_into_[ids[i]] = id;
        any = true;
    }
    if (any) count_keyframes();
}

int PlaneMapper::resolved(int plane_id) const {
    for (auto next = merged_into_.find(plane_id); next != merged_into_.end();
         next = merged_into_.find(plane_id)) {
        plane_id = next->second;
    }
    return plane_id;
}

/// How many keyframes saw each surface, counted anew.
void PlaneMapper::count_keyframes() {
    std::map<int, Surface*> surfaces;
    for (Surface& surface : set_.surfaces()) {
        surfaces[surface.id] = &surface;
        surface.keyframes = 0;
        surface.last_keyframe = -1;
    }
    for (const Surface& fixed : fixed_) {
        const auto at = surfaces.find(resolved(fixed.id));
        if (at != surfaces.end()) at->second->keyframes += fixed.keyframes;
    }
    for (auto& [id, keyframe] : keyframes_) {
        std::map<int, int> saw;  // how many keyframes' views of each plane it holds
        for (StoredRegion& region : keyframe.regions) {
            region.plane = resolved(region.plane);
            saw[region.plane] = std::max(saw[region.plane], region.keyframes);
        }
        for (const auto& [plane, keyframes] : saw) {
            const auto at = surfaces.find(plane);
            if (at == surfaces.end()) continue;
            at->second->keyframes += keyframes;
            at->second->last_keyframe = id;
        }
    }
}

/// Lets keyframes go that the graph replaced; what they saw goes over to those near them.
void PlaneMapper::replace(const std::vector<Replacement>& gone) {
    if (gone.empty()) return;
    for (auto& [id, keyframe] : keyframes_)
        for (StoredRegion& region : keyframe.regions) region.plane = resolved(region.plane);
    std::vector<StoredKeyframe> leaving;
    for (const Replacement& replacement : gone) {
        poses_.erase(replacement.id);
        const auto kept = keyframes_.find(replacement.id);
        if (kept == keyframes_.end() || !kept->second.world_from_camera) continue;
        leaving.push_back(std::move(kept->second));
        keyframes_.erase(kept);
    }
    for (const StoredKeyframe& keyframe : leaving) {
        const auto heirs = heirs_of(keyframe);
        hand_over(keyframe, heirs,
                  [&](const StoredRegion& r) { return reliability(r, keyframe.noise).sigma_m; });
        ++replaced_;
        settled_ = false;
    }
}

/// The keyframes in the map that stand nearest to one that goes, the nearest first.
std::vector<StoredKeyframe*> PlaneMapper::heirs_of(const StoredKeyframe& gone) {
    std::vector<std::pair<double, StoredKeyframe*>> near;
    for (auto& [id, keyframe] : keyframes_) {
        if (!keyframe.world_from_camera) continue;
        const Pose apart = gone.world_from_camera->inverse(Eigen::Isometry) * *keyframe.world_from_camera;
        near.emplace_back(apart.translation().norm() + rotation_angle(apart), &keyframe);
    }
    std::stable_sort(near.begin(), near.end(), [](auto& a, auto& b) { return a.first < b.first; });
    std::vector<StoredKeyframe*> heirs;
    for (const auto& [distance, keyframe] : near)
        if (heirs.size() < kHeirs) heirs.push_back(keyframe);
    return heirs;
}

/// Drops keyframes that are taken not to move any more, and keeps what they saw in fixed planes.
void PlaneMapper::fold() {
    if (options_.fold_after == 0) return;
    while (keyframes_.size() > static_cast<std::size_t>(options_.fold_after)) {
        const auto& [id, keyframe] = *keyframes_.begin();
        if (!keyframe.world_from_camera) return;
        for (const StoredRegion& region : keyframe.regions) {
            if (region.plane < 0) continue;
            const int plane_id = resolved(region.plane);
            const PlacedRegion placed(*keyframe.world_from_camera, region);
            auto at = std::find_if(fixed_.begin(), fixed_.end(),
                                   [&](const Surface& s) { return resolved(s.id) == plane_id; });
            if (at == fixed_.end()) {
                at = fixed_.insert(fixed_.end(), surface_of(plane_id, placed, region, keyframe));
            } else {
                take_in(*at, placed, region, keyframe);
            }
            draw(*at, placed, region, keyframe, id);
        }
        const View view(keyframe);
        std::vector<EvidenceGrid::Block> blocks;
        for (Surface& fixed : fixed_) look_through(fixed, view, blocks);
        folded_up_to_ = id;
        poses_.erase(id);
        keyframes_.erase(keyframes_.begin());
        ++folded_;
    }
}

/// Gives the fixed planes their ids; those that have the same one become one.
void PlaneMapper::unite_fixed(const std::vector<int>& ids) {
    std::vector<Surface> united;
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
        fixed_[i].id = ids[i];
        const auto same =
            std::find_if(united.begin(), united.end(), [&](const Surface& s) { return s.id == ids[i]; });
        if (same == united.end()) {
            united.push_back(std::move(fixed_[i]));
        } else {
            same->absorb(fixed_[i]);
        }
    }
    fixed_ = std::move(united);
}

void PlaneMapper::rebuild() {
    ++rebuilds_;
    // All regions, the weightiest first.
    struct Entry {
        double weight;
        int keyframe;
        std::size_t region;
        StoredKeyframe* stored;
    };
    std::vector<Entry> entries;
    std::map<int, std::vector<int>> planes_before;
    for (auto& [id, keyframe] : keyframes_) {
        const auto pose = poses_.find(id);
        if (pose == poses_.end()) continue;
        keyframe.world_from_camera = pose->second;
        map_.utime = std::max(map_.utime, keyframe.utime);
        std::vector<int>& before = planes_before[id];
        for (std::size_t i = 0; i < keyframe.regions.size(); ++i) {
            StoredRegion& region = keyframe.regions[i];
            before.push_back(resolved(region.plane));
            region.plane = -1;
            entries.push_back(
                {weight(region, keyframe.noise) * static_cast<double>(region.count), id, i, &keyframe});
        }
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return std::tuple(-a.weight, a.keyframe, a.region) < std::tuple(-b.weight, b.keyframe, b.region);
    });

    const int first_new_id = next_id_;
    std::vector<int> fixed_ids;
    for (const Surface& fixed : fixed_) fixed_ids.push_back(resolved(fixed.id));
    unite_fixed(fixed_ids);
    SurfaceSet fresh({options_.merge_angle_deg * kRadPerDeg, options_.merge_distance_m, options_.merge_gap_m},
                     options_.max_extent_m);
    for (const Surface& fixed : fixed_) {
        Surface& surface = fresh.surfaces()[fresh.push_back(fixed)];
        surface.changed = true;
        surface.unshown = kAllCells;
    }
    struct Joined {
        const Entry* entry;
        std::size_t surface;
        Pose world_from_box;
    };
    std::vector<Joined> joined;
    joined.reserve(entries.size());
    for (const Entry& entry : entries) {
        const StoredKeyframe& keyframe = *entry.stored;
        const StoredRegion& region = keyframe.regions[entry.region];
        const PlacedRegion placed(*keyframe.world_from_camera, region);
        if (!(placed.box.frame_from_box.translation().norm() <= kMaxCoordinate_m)) continue;
        joined.push_back({&entry, join(fresh, placed, region, keyframe), placed.box.frame_from_box});
    }
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < fresh.surfaces().size(); ++i) {
        fresh.surfaces()[i].refit();
        fresh.update(i);
        all.push_back(i);
    }
    const std::vector<std::size_t> now = fresh.merge(all);
    set_ = std::move(fresh);
    merged_into_.clear();
    fixed_ids.clear();
    for (std::size_t i = 0; i < fixed_.size(); ++i) fixed_ids.push_back(set_.surfaces()[now[i]].id);
    unite_fixed(fixed_ids);

    std::vector<std::vector<DrawnRegion>> regions(set_.surfaces().size());
    for (const Joined& j : joined) {
        j.entry->stored->regions[j.entry->region].plane = set_.surfaces()[now[j.surface]].id;
        regions[now[j.surface]].push_back({j.entry->stored, j.entry->region, j.world_from_box});
    }
    std::vector<View> views;
    views.reserve(keyframes_.size());
    for (const auto& [id, keyframe] : keyframes_) {
        if (keyframe.world_from_camera) views.emplace_back(keyframe);
    }
    // Shapes are independent of each other.
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i = next++; i < regions.size(); i = next++)
            redraw(set_.surfaces()[i], regions[i], views);
    };
    {
        std::vector<std::jthread> others;
        for (int i = 1; i < options_.threads; ++i) others.emplace_back(work);
        work();
    }
    keep_ids(planes_before, first_new_id);
    count_keyframes();
    settled_ = true;
}

/// A rebuilt surface's shape: its regions, and then what all keyframes say against it.
void PlaneMapper::redraw(Surface& surface, const std::vector<DrawnRegion>& regions,
                         const std::vector<View>& views) {
    if (surface.grid.empty())
        surface.grid = EvidenceGrid(surface.box.frame_from_box, options_.outline_cell_m);
    const Pose grid_from_world = surface.grid.world_from_grid().inverse(Eigen::Isometry);
    FlatPolygon polygon;
    for (const DrawnRegion& drawn : regions) {
        const StoredRegion& region = drawn.keyframe->regions[drawn.region];
        outline_in(grid_from_world * drawn.world_from_box, region, *drawn.keyframe, polygon);
        surface.grid.add(polygon, strength(region, drawn.keyframe->noise));
    }
    look_through(surface, views);
    surface.unshown = kAllCells;
}

/// Gives each rebuilt plane the id of the earlier plane that most of its inliers were in; each id once, the
/// strongest claim first. Planes without a claim get new ids.
void PlaneMapper::keep_ids(const std::map<int, std::vector<int>>& planes_before, int first_new_id) {
    std::map<std::pair<int, int>, double> votes;  // (id before, id now): inliers
    for (const auto& [id, before] : planes_before) {
        const std::vector<StoredRegion>& regions = keyframes_.at(id).regions;
        for (std::size_t i = 0; i < regions.size(); ++i) {
            if (before[i] < 0 || regions[i].plane < 0) continue;
            votes[{before[i], regions[i].plane}] += static_cast<double>(regions[i].count);
        }
    }
    std::vector<std::pair<double, std::pair<int, int>>> claims;
    for (const auto& [pair, inliers] : votes) claims.push_back({-inliers, pair});
    std::sort(claims.begin(), claims.end());
    std::map<int, int> name;  // id now: id before
    std::set<int> taken;
    for (const Surface& fixed : fixed_) {
        for (const Surface& surface : set_.surfaces()) {
            if (surface.id != fixed.id) continue;
            name[surface.id] = fixed.id;
            taken.insert(fixed.id);
        }
    }
    for (const auto& [inliers, pair] : claims) {
        if (name.contains(pair.second) || taken.contains(pair.first)) continue;
        name[pair.second] = pair.first;
        taken.insert(pair.first);
    }
    next_id_ = first_new_id;
    for (Surface& surface : set_.surfaces()) {
        const auto known = name.try_emplace(surface.id, next_id_);
        if (known.second) ++next_id_;
        surface.id = known.first->second;
    }
    for (const auto& [id, before] : planes_before) {
        for (StoredRegion& region : keyframes_.at(id).regions)
            region.plane = region.plane < 0 ? -1 : name.at(region.plane);
    }
}

/// A surface as a plane of the map, nothing if it is too small or too seldom seen. Of a plane that hardly
/// changed, the outline stays as it was; returns whether it or the plane changed to note.
bool PlaneMapper::derive(Surface& surface, std::optional<MapPlane>& plane) const {
    PlanarRegion region;
    region.plane = surface.plane;
    region.moments = surface.moments;
    region.rms = rms_to(surface.plane, surface.moments);
    if (plane && surface.unshown < kCellsOfNote) {
        const auto shape = shapes_.find(surface.id);
        const Plane before = shape != shapes_.end() ? shape->second.plane : plane->plane();
        const double turn = before.normal.cross(surface.plane.normal).norm();
        const Eigen::Vector3d center = before.project(plane->center.cast<double>());
        const double shift = std::abs(surface.plane.signed_distance(center));
        if (shift + turn * static_cast<double>(plane->half_extents.norm()) < kMoveOfNote_m) {
            plane->move_to(surface.plane);
            plane->keyframes = static_cast<std::int16_t>(std::min(surface.keyframes, 32767));
            plane->inliers = static_cast<float>(surface.moments.count);
            plane->rms = static_cast<float>(region.rms);
            return false;
        }
    }
    surface.unshown = 0;
    plane.reset();
    if (surface.keyframes < options_.min_keyframes) return true;
    const Outline outline_grid = surface.grid.outline(
        {options_.outline_min_hits, options_.outline_min_ring_m2, options_.outline_tolerance_m});
    if (outline_grid.empty()) return true;
    // The box: along the principal axes, around the outline.
    Pose world_from_axes = Pose::Identity();
    world_from_axes.linear() = surface.box.frame_from_box.linear();
    world_from_axes.translation() = surface.box.frame_from_box.translation();
    Outline outline =
        transformed(world_from_axes.inverse(Eigen::Isometry) * surface.grid.world_from_grid(), outline_grid);
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e300), high = -low;
    for (const Ring& ring : outline.rings) {
        for (const Eigen::Vector2d& v : ring) {
            low = low.cwiseMin(v);
            high = high.cwiseMax(v);
        }
    }
    const Eigen::Vector2d middle = 0.5 * (low + high), half = 0.5 * (high - low);
    for (Ring& ring : outline.rings) {
        for (Eigen::Vector2d& v : ring) v -= middle;
    }
    region.box.frame_from_box = world_from_axes;
    region.box.frame_from_box.translation() = world_from_axes * Eigen::Vector3d(middle.x(), middle.y(), 0);
    region.box.half_extents << half, 0;
    region.outline = std::move(outline);
    MapPlane derived(surface.id, region, static_cast<std::size_t>(surface.keyframes));
    const double least = surface.keyframes < 2 ? options_.min_single_m2 : 0;
    if (derived.area > 0 && static_cast<double>(derived.area) >= std::max(least, options_.min_area_m2))
        plane = derived;
    return true;
}

/// Which way is up, and what the planes are. Some hundred keyframes tell as much as all.
void PlaneMapper::name() {
    constexpr std::size_t kCameras = 128;
    const std::size_t stride = 1 + poses_.size() / kCameras;
    std::vector<Pose> cameras;
    std::size_t i = 0;
    for (const auto& [id, pose] : poses_) {
        if (i++ % stride == 0) cameras.push_back(pose);
    }
    if (!cameras.empty()) name_planes(map_, cameras);
}

/// Brings map_ up to date: only planes that changed are derived anew, with the intersections they are in.
void PlaneMapper::refresh() {
    std::map<int, MapPlane> before;
    for (MapPlane& plane : map_.planes) before.emplace(plane.id, std::move(plane));
    std::vector<int> changed;
    std::vector<MapPlane> planes;
    for (Surface& surface : set_.surfaces()) {
        std::optional<MapPlane> plane;
        if (const auto known = before.find(surface.id); known != before.end()) {
            plane = std::move(known->second);
            before.erase(known);
        }
        if (surface.changed) {
            surface.changed = false;
            if (derive(surface, plane)) changed.push_back(surface.id);
        }
        if (plane) planes.push_back(std::move(*plane));
    }
    for (const auto& [id, plane] : before) changed.push_back(id);  // merged into another one, or gone
    std::sort(planes.begin(), planes.end(), [](auto& a, auto& b) { return a.id < b.id; });
    planes.shrink_to_fit();
    map_.planes = std::move(planes);
    std::sort(changed.begin(), changed.end());
    refresh_intersections(changed);
    if (!changed.empty()) name();
}

/// The points where three planes meet of which one changed. Rooms have a few for each plane; what could be
/// a map, and has a thousand planes that all meet, would have more than can be found.
template <typename IsChanged>
void PlaneMapper::add_corners(const AdjacencyRules& rules, IsChanged is_changed) {
    std::map<int, std::set<int>> above;  // adjacent planes with a larger id
    for (const IntersectionLine& line : map_.lines) above[line.plane_a].insert(line.plane_b);
    std::size_t looks = 0;
    left_out_corners_ = false;
    for (const auto& [a, adjacent] : above) {
        for (const int b : adjacent) {
            const auto beyond = above.find(b);
            if (beyond == above.end()) continue;
            looks += beyond->second.size();
            left_out_corners_ = looks > kMaxLooksForCorners;
            if (left_out_corners_) return;
            for (const int c : beyond->second) {
                if (!adjacent.contains(c) || !(is_changed(a) || is_changed(b) || is_changed(c))) continue;
                const auto point = intersection_point(shapes_.at(a), shapes_.at(b), shapes_.at(c), rules);
                if (point) map_.points.push_back(*point);
            }
        }
    }
}

void PlaneMapper::refresh_intersections(const std::vector<int>& changed_ids) {
    if (changed_ids.empty()) return;
    const AdjacencyRules rules{options_.adjacency_gap_m, options_.adjacency_angle_deg * kRadPerDeg,
                               options_.adjacency_length_m};
    const auto is_changed = [&](int id) {
        return std::binary_search(changed_ids.begin(), changed_ids.end(), id);
    };
    for (const int id : changed_ids) {
        const MapPlane* plane = map_.find(id);
        if (plane != nullptr) {
            shapes_[id] = PlaneShape(*plane);
        } else {
            shapes_.erase(id);
        }
    }
    std::erase_if(map_.lines,
                  [&](auto& line) { return is_changed(line.plane_a) || is_changed(line.plane_b); });
    std::erase_if(map_.points, [&](auto& point) {
        return std::any_of(point.planes.begin(), point.planes.end(), is_changed);
    });
    for (const int a : changed_ids) {
        const auto shape_a = shapes_.find(a);
        if (shape_a == shapes_.end()) continue;
        for (const auto& [b, shape_b] : shapes_) {
            if (b == a || (b < a && is_changed(b))) continue;
            const auto lines = intersection_lines(shape_a->second, shape_b, rules);
            map_.lines.insert(map_.lines.end(), lines.begin(), lines.end());
        }
    }
    std::stable_sort(map_.lines.begin(), map_.lines.end(), [](auto& x, auto& y) {
        return std::pair(x.plane_a, x.plane_b) < std::pair(y.plane_a, y.plane_b);
    });

    add_corners(rules, is_changed);
    std::sort(map_.points.begin(), map_.points.end(), [](auto& x, auto& y) { return x.planes < y.planes; });
    map_.lines.shrink_to_fit();
    map_.points.shrink_to_fit();
}

Moments PlaneMapper::moments(int plane_id) const {
    for (const Surface& surface : set_.surfaces())
        if (surface.id == plane_id) return surface.moments;
    return {};
}

std::map<int, std::vector<int>> PlaneMapper::sightings() const {
    std::map<int, std::vector<int>> result;
    for (const auto& [id, keyframe] : keyframes_) {
        for (const StoredRegion& region : keyframe.regions) {
            if (region.plane < 0) continue;
            std::vector<int>& ids = result[resolved(region.plane)];
            if (ids.empty() || ids.back() != id) ids.push_back(id);
        }
    }
    return result;
}

std::size_t PlaneMapper::working_bytes() const {
    std::size_t bytes = poses_.size() * sizeof(std::pair<int, Pose>);
    for (const auto& [id, keyframe] : keyframes_) bytes += planemap::memory_bytes(keyframe);
    for (const auto* group : {&set_.surfaces(), &fixed_})
        for (const Surface& surface : *group) bytes += sizeof surface + surface.grid.memory_bytes();
    for (const auto& [id, shape] : shapes_)
        bytes += sizeof shape + shape.outline.vertex_count() * sizeof(Eigen::Vector2d);
    return bytes;
}

}  // namespace planemap
