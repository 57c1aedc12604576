// SPDX-License-Identifier: BSD-3-Clause
// How alike the same plane of the world comes out in frame after frame.
#pragma once

#include <vector>

#include "core/geometry/plane.hpp"

namespace planemap::bench {

/// One region of one frame, in the world.
struct Sighting {
    Plane plane;                                         ///< world frame
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< of its pixels, on the plane; world frame
    double pixels = 0;
};

/// How much the sightings of world planes scatter, weighted by their pixels: what describes most of a plane
/// counts most.
struct Spread {
    int planes = 0;         ///< that it is the median of
    double angle_deg = 0;   ///< standard deviation of the normal about the mean normal
    double distance_m = 0;  ///< standard deviation of the sightings' centroids along the mean normal
};

/// Gathers sightings of the same world plane: those whose normal lies within 10 deg, and whose centroid
/// within 10 cm, of a plane seen before (of several, the nearest in distance).
class WorldPlanes {
  public:
    void add(const Sighting& sighting);

    /// The median over the largest planes (by pixels of all sightings together, at most `count`, each seen at
    /// least three times); planes is 0 if there are none.
    Spread spread_of_largest(int count) const;

  private:
    struct WorldPlane {
        std::vector<Sighting> sightings;
        Eigen::Vector3d normal_sum = Eigen::Vector3d::Zero(), centroid_sum = Eigen::Vector3d::Zero();
        double pixels = 0;

        /// Through the mean centroid with the mean normal, both weighted by pixels.
        Plane mean() const;
    };
    static Spread spread(const WorldPlane& plane);

    std::vector<WorldPlane> planes_;
};

}  // namespace planemap::bench
