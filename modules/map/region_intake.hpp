// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/keyframe.hpp"
#include "map/map_losses.hpp"
#include "map/stored_keyframe.hpp"

namespace planemap::map {

/// Which regions of a frame the map takes, whoever sent them: valid ones whose moments determine a plane, of
/// a size and at a place that a sensor can see; the 256 with most points.
class RegionIntake {
  public:
    /// Regions that reach further than max_extent_m / 2 from their middle are refused.
    explicit RegionIntake(double max_extent_m) : max_extent_m_(max_extent_m) {}

    /// What the map keeps of a frame, its largest regions first, without a pose. Counts what it refuses.
    StoredKeyframe view(int keyframe_id, std::int64_t utime, const std::vector<PlanarRegion>& regions,
                        const DepthNoise& noise, MapLosses& losses) const;

  private:
    bool is_usable(const PlanarRegion& region) const;
    std::vector<std::size_t> usable(const std::vector<PlanarRegion>& regions, MapLosses& losses) const;

    double max_extent_m_;
};

}  // namespace planemap::map
