// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/camera.hpp"
#include "core/geometry/moments.hpp"
#include "core/image.hpp"
#include "core/plane_map.hpp"

namespace planemap::evaluation {

/// A map plane beside the plane through the depth readings that are on it.
struct SurfaceCheck {
    int id = -1;
    double area = 0;        ///< of the map plane, square metres
    double points = 0;      ///< depth readings
    double angle_deg = 0;   ///< between the two
    double distance_m = 0;  ///< at the middle of the map plane's box
};

/// Collects the depth readings at true poses that lie within 3 cm of a map plane and inside its outline, for
/// the ten largest planes of a map in the truth's world.
class SurfaceChecker {
  public:
    explicit SurfaceChecker(const PlaneMap& map);
    /// Depth as the depth camera gives it; readings outside the camera's range are left out.
    void add(const DepthImage& depth, const CameraInfo& camera, const Pose& world_from_color);
    /// One for each plane that has points, from the largest plane to the smallest.
    std::vector<SurfaceCheck> checks() const;

  private:
    struct Entry {
        int id;
        Plane plane;
        Pose plane_from_world;
        Outline outline;
        Eigen::AlignedBox2d bounds;  ///< of the outline
        double area;
        Moments moments;  ///< in the plane's frame
    };
    std::vector<Entry> entries_;
};

}  // namespace planemap::evaluation
