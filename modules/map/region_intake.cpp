// SPDX-License-Identifier: BSD-3-Clause
#include "map/region_intake.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/packed_outline.hpp"

namespace planemap::map {

namespace {

/// No depth camera sees a region that reaches further from its middle, nor more of them: a raster takes
/// memory.
constexpr double kMaxRegionReach_m = 25;
constexpr std::size_t kMaxRegions = 256;
constexpr double kMaxPoints = 1e9;

}  // namespace

/// A valid region whose moments determine a plane, of a size and at a place that a sensor can see.
bool RegionIntake::is_usable(const PlanarRegion& region) const {
    if (!is_valid(region) || !fit_plane(region.moments).valid) return false;
    const double reach = std::min(max_extent_m_ / 2, kMaxRegionReach_m);
    if (!(region.box.half_extents.norm() <= reach)) return false;
    if (!is_near_origin(region.box.frame_from_box.translation())) return false;
    // Moments, plane and box say the same.
    const Eigen::Vector3d mean = region.moments.mean();
    if (!(region.moments.count <= kMaxPoints)) return false;
    if (!((mean - region.box.frame_from_box.translation()).norm() <= region.box.half_extents.norm() + 1))
        return false;
    if (!(std::abs(region.plane.signed_distance(mean)) <= 1)) return false;
    return std::all_of(region.outline.rings.begin(), region.outline.rings.end(), [&](const Ring& ring) {
        return ring.size() <= kMaxRingVertices &&
               std::all_of(ring.begin(), ring.end(), [&](const auto& v) { return v.norm() <= reach; });
    });
}

/// Which of the regions, by falling number of points.
std::vector<std::size_t> RegionIntake::usable(const std::vector<PlanarRegion>& regions,
                                              MapLosses& losses) const {
    std::vector<std::size_t> usable;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        if (!is_usable(regions[i])) {
            ++losses.regions_refused;
        } else if (usable.size() == kMaxRegions) {
            ++losses.regions_too_many;
        } else {
            usable.push_back(i);
        }
    }
    std::stable_sort(usable.begin(), usable.end(), [&](std::size_t a, std::size_t b) {
        return regions[a].moments.count > regions[b].moments.count;
    });
    return usable;
}

StoredKeyframe RegionIntake::view(int keyframe_id, std::int64_t utime,
                                  const std::vector<PlanarRegion>& regions, const DepthNoise& noise,
                                  MapLosses& losses) const {
    const std::vector<std::size_t> usable = this->usable(regions, losses);
    std::vector<PlanarRegion> sorted;
    sorted.reserve(usable.size());
    for (const std::size_t i : usable) sorted.push_back(regions[i]);
    StoredKeyframe view = stored(utime, sorted);
    for (std::size_t i = 0; i < usable.size(); ++i) view.regions[i].number = static_cast<int>(usable[i]);
    view.noise = noise;
    view.id = keyframe_id;
    return view;
}

}  // namespace planemap::map
