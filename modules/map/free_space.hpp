// SPDX-License-Identifier: BSD-3-Clause
// Free-space carving: a keyframe that sees a region beyond a plane says that the plane is not there.
#pragma once

#include <optional>
#include <vector>

#include "core/camera.hpp"
#include "map/plane_estimate.hpp"
#include "map/stored_keyframe.hpp"

namespace planemap::map {

/// A keyframe of the map as a camera: where it stands and which planes it sees. The keyframe must outlive it.
struct Viewpoint {
    const StoredKeyframe* keyframe;
    Pose camera_from_world;
    std::vector<Plane> planes;  ///< of its regions, camera frame

    /// Precondition: the keyframe has a pose.
    explicit Viewpoint(const StoredKeyframe& seen);
};

/// Counts misses for the cells of planes that keyframes see past.
class FreeSpace {
  public:
    /// A region beyond a cell by more than margin_m and two sigma of the sensor's noise is a miss of the
    /// cell.
    explicit FreeSpace(double margin_m) : margin_m_(margin_m) {}

    /// Carves what one keyframe sees past.
    void carve(std::vector<PlaneEstimate>& planes, const Viewpoint& viewpoint) const;

    /// Carves a plane by many keyframes. What is uncertain is looked for once; and as a few misses settle it,
    /// of a thousand viewpoints of the same place some are enough: the work grows with the building.
    void carve(PlaneEstimate& plane, const std::vector<Viewpoint>& viewpoints) const;

  private:
    /// Where on a plane's grid a viewpoint's image may fall.
    struct Footprint {
        Pose camera_from_grid;
        Eigen::Vector2d low, high;
    };
    static std::optional<Footprint> footprint_of(const PlaneEstimate& plane, const Viewpoint& viewpoint);
    void carve(PlaneEstimate& plane, const Viewpoint& viewpoint, const Footprint& footprint,
               const std::vector<EvidenceGrid::Block>& uncertain) const;

    double margin_m_;
};

}  // namespace planemap::map
