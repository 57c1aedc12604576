// SPDX-License-Identifier: BSD-3-Clause
#include "map/free_space.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "map/evidence_blocks.hpp"

namespace planemap::map {

namespace {

/// Viewpoints that a block is asked of, those that see something where it is, in a rebuild.
constexpr int kMostAsked = 24;
/// Cells beside those that a view sees of a plane, which it does not see past: poses err sideways, too.
constexpr int kBeside = 6;
/// Viewpoints after which blocks that are done are left out: at first, and then each time when there were
/// half as many more.
constexpr std::size_t kTidyAfter = 8;

/// False for what is behind the camera, beyond its reach, or beside its pyramid.
bool may_see(const Sight& sight, const Eigen::Vector3d& center_camera, double radius) {
    return center_camera.squaredNorm() <= std::pow(radius + sight.reach(), 2) &&
           sight.may_hold(center_camera, radius);
}

}  // namespace

Viewpoint::Viewpoint(const StoredKeyframe& seen)
    : keyframe(&seen),
      camera_from_world(seen.world_from_camera->inverse(Eigen::Isometry)),
      planes(seen_planes(seen)) {}

void FreeSpace::carve(std::vector<PlaneEstimate>& planes, const Viewpoint& viewpoint, int looks) const {
    std::vector<EvidenceBlock> blocks;
    for (PlaneEstimate& plane : planes) {
        const std::optional<Footprint> footprint = footprint_of(plane, viewpoint);
        if (!footprint) continue;
        const std::vector<Bitmap> drawn = own_cells(plane, *viewpoint.keyframe);
        std::vector<const Bitmap*> own(drawn.size());
        std::transform(drawn.begin(), drawn.end(), own.begin(), [](const Bitmap& cells) { return &cells; });
        blocks.clear();
        add_seen_blocks(plane.grid, footprint->low, footprint->high, blocks);
        int lost = 0;
        for_each_past(plane, viewpoint, *footprint, own, blocks,
                      [&](const EvidenceBlock& block) { lost += miss(plane.grid, block, looks); });
        plane.changed_cells += lost;
        plane.changed = plane.changed || lost > 0;
    }
}

void FreeSpace::carve_before(PlaneEstimate& plane, const std::vector<Viewpoint>& viewpoints,
                             std::vector<EvidenceBlock>& blocks) const {
    int lost = 0;
    for (const Viewpoint& viewpoint : viewpoints) {
        const std::optional<Footprint> footprint = footprint_of(plane, viewpoint);
        if (!footprint) continue;
        for_each_past(plane, viewpoint, *footprint, {}, blocks, [&](EvidenceBlock& block) {
            // More would not have counted before the cells were seen.
            const int more = std::min(viewpoint.keyframe->looks, -EvidenceCells::kLeastOdds - block.missed);
            lost += miss_before(plane.grid, block, more);
            block.missed = static_cast<std::uint16_t>(block.missed + more);
        });
    }
    plane.changed_cells += lost;
    plane.changed = plane.changed || lost > 0;
}

void FreeSpace::look_back(PlaneEstimate& plane, const std::vector<SeenCells>& seen,
                          const std::vector<Viewpoint>& viewpoints) const {
    const EvidenceGrid before = plane.grid;
    plane.grid.forget_odds();
    std::vector<EvidenceBlock> blocks;
    const Eigen::Vector2d everywhere = Eigen::Vector2d::Constant(1e9);
    add_seen_blocks(plane.grid, -everywhere, everywhere, blocks);
    std::multimap<const StoredKeyframe*, const Bitmap*> drawn;
    for (const SeenCells& cells : seen) drawn.emplace(cells.view, &cells.cells);
    std::vector<const Bitmap*> own;
    auto next = seen.begin();
    std::size_t looked = 0, tidy_at = kTidyAfter;
    for (const Viewpoint& viewpoint : viewpoints) {
        if (blocks.empty()) break;
        const std::optional<Footprint> footprint = footprint_of(plane, viewpoint);
        if (!footprint) continue;
        for (; next != seen.end() && next->utime >= viewpoint.keyframe->seen_utime; ++next)
            plane.grid.hit_before(next->cells, next->looks);
        own.clear();
        const auto [from, to] = drawn.equal_range(viewpoint.keyframe);
        for (auto at = from; at != to; ++at) own.push_back(at->second);
        for_each_past(plane, viewpoint, *footprint, own, blocks, [&](const EvidenceBlock& block) {
            miss_before(plane.grid, block, viewpoint.keyframe->looks);
        });
        if (++looked < tidy_at) continue;
        tidy_at += std::max(kTidyAfter, looked / 2);
        std::erase_if(blocks, [&](const EvidenceBlock& block) {
            return block.asked >= kMostAsked || !is_undecided(plane.grid, block);
        });
    }
    for (; next != seen.end(); ++next) plane.grid.hit_before(next->cells, next->looks);
    plane.grid.settle_on(before);
}

std::vector<Bitmap> FreeSpace::own_cells(PlaneEstimate& plane, const StoredKeyframe& view) {
    std::vector<Bitmap> drawn;
    if (plane.grid.empty()) return drawn;
    FlatPolygon polygon;
    const Pose grid_from_camera =
        plane.grid.world_from_grid().inverse(Eigen::Isometry) * *view.world_from_camera;
    for (const StoredRegion& region : view.regions) {
        if (region.plane != plane.id || region.number < 0) continue;
        const PlacedRegion placed(grid_from_camera, region);
        outline_in(placed.box.frame_from_box, region, view, polygon);
        drawn.push_back(plane.grid.cells_of(polygon));
    }
    return drawn;
}

/// Nothing if it falls beside the plane.
std::optional<FreeSpace::Footprint> FreeSpace::footprint_of(const PlaneEstimate& plane,
                                                            const Viewpoint& viewpoint) {
    const Sight& sight = viewpoint.keyframe->sight;
    const Eigen::Vector3d center = viewpoint.camera_from_world * (0.5 * (plane.low + plane.high));
    if (!may_see(sight, center, 0.5 * (plane.high - plane.low).norm())) return std::nullopt;
    Footprint footprint;
    footprint.camera_from_grid = viewpoint.camera_from_world * plane.grid.world_from_grid();
    const Eigen::Vector3d origin = footprint.camera_from_grid.translation();
    const Eigen::Matrix3d& axes = footprint.camera_from_grid.linear();
    // The pyramid of the image, down to its reach, laid on the plane.
    const double reach = sight.reach();
    const Eigen::Vector2d& low = sight.low();
    const Eigen::Vector2d high = sight.high();
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

template <typename F>
void FreeSpace::for_each_past(const PlaneEstimate& plane, const Viewpoint& viewpoint,
                              const Footprint& footprint, const std::vector<const Bitmap*>& own,
                              std::vector<EvidenceBlock>& blocks, const F& f) const {
    const Eigen::Vector3d origin = footprint.camera_from_grid.translation();
    const Eigen::Vector3d x = footprint.camera_from_grid.linear().col(0),
                          y = footprint.camera_from_grid.linear().col(1),
                          normal = footprint.camera_from_grid.linear().col(2);
    const SeenRegions seen = viewpoint.seen();
    const auto first =
        std::lower_bound(blocks.begin(), blocks.end(), footprint.low.y(),
                         [](const EvidenceBlock& block, double low) { return block.middle.y() < low; });
    for (auto at = first; at != blocks.end(); ++at) {
        EvidenceBlock& block = *at;
        if (block.asked >= kMostAsked || block.middle.x() < footprint.low.x() ||
            block.middle.x() > footprint.high.x())
            continue;
        if (block.middle.y() > footprint.high.y()) break;  // they come row after row
        const Eigen::Vector3d p = origin + block.middle.x() * x + block.middle.y() * y;
        const std::optional<double> depth = seen.depth_behind(p);
        if (!depth) continue;
        const std::optional<bool> is_past = rules_.is_past(p, normal, *depth, viewpoint.keyframe->noise);
        // From behind, what is seen past a surface is seen past the edge of the thing that it is a side of.
        if (!is_past || normal.dot(p) > 0) continue;
        ++block.asked;
        if (!*is_past) continue;
        const bool is_seen = std::any_of(own.begin(), own.end(), [&](const Bitmap* cells) {
            return is_near(plane.grid, *cells, block, kBeside);
        });
        if (!is_seen) f(block);
    }
}

}  // namespace planemap::map
