// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "core/plane_map.hpp"
#include "map/evidence_grid.hpp"
#include "map/stored_keyframe.hpp"

namespace planemap::map {

/// How far a set of points reaches in sixteen directions of its plane: its convex hull, to 2 %.
class Extent {
  public:
    static constexpr std::size_t kDirections = 16;

    Extent();
    void add(const Eigen::Vector2d& p);
    bool empty() const { return reach_[0] < -1e299; }
    /// The polygon around the points, counter-clockwise.
    std::array<Eigen::Vector2d, kDirections> corners() const;

  private:
    std::array<double, kDirections> reach_;  ///< largest p . direction
};

/// How far an observation is to be believed.
struct Reliability {
    double weight = 1;  ///< of its points in the fit, before it is compared with the plane
    /// By which a good one may be off; one that is off by twice as much counts a quarter.
    double sigma_m = 1;
};

/// Mean square distance of a region's plane to another one, over the region's points.
double misfit2(const PlacedRegion& region, const Plane& plane);

/// A plane of the world as far as keyframes saw it: its fit, how far it reaches and its shape. World frame.
struct PlaneEstimate {
    static constexpr int kNoKeyframe = std::numeric_limits<int>::min();
    static constexpr int kAllCells = 1 << 20;  ///< as changed_cells: the whole shape has to be traced

    int id = -1;
    Plane plane;                                       ///< fit to `weighted`, as of the last refit()
    Moments moments;                                   ///< exact
    Moments weighted;                                  ///< each observation by its weight
    Eigen::Vector3d facing = Eigen::Vector3d::Zero();  ///< weighted sum of the normals seen: the side
    Pose world_from_extent = Pose::Identity();         ///< z close to the normal
    Extent extent;                                     ///< of all outlines
    Box box;                                           ///< of the extent, along the principal axes
    Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  ///< of the box
    EvidenceGrid grid;                                                              ///< the shape
    int keyframes = 0;                                                              ///< that saw it
    int last_keyframe = kNoKeyframe;                                                ///< that was counted
    double fitted_weight = 0;  ///< weighted.count at the last refit()
    int changed_cells = 0;     ///< that came to the shape or left it since it was derived
    bool changed = true;       ///< anything, since it was derived

    PlaneEstimate() = default;
    /// From a region; `outline` has it in world_from_box of the region.
    PlaneEstimate(const PlacedRegion& region, const FlatPolygon& outline_box, const Reliability& reliability);
    /// From a plane of a finished map; its outline counts as well supported and seen by as many looks
    /// as count.
    PlaneEstimate(const MapPlane& plane, double cell_m);

    /// The same plane without points, extent or shape: it stays where it is until the next refit().
    PlaneEstimate emptied() const;

    /// Takes a region in. The plane follows at the next refit(), the box at once.
    void add(const PlacedRegion& region, const FlatPolygon& outline_extent, const Reliability& reliability);
    /// Takes another estimate in; its evidence is resampled.
    void absorb(const PlaneEstimate& other);
    /// Plane, box and bounds after moments or extent changed.
    void refit();
    /// Counts a keyframe that saw it, and those that handed their views on to that one; each once.
    void count_keyframe(int id, int with_handed_on);

  private:
    void rebox();
    Eigen::Vector3d long_axis_ = Eigen::Vector3d::UnitX();
};

}  // namespace planemap::map
