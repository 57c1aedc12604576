// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "core/plane_map.hpp"
#include "map/evidence_grid.hpp"
#include "map/merging.hpp"
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

/// How far a view is to be believed.
struct Reliability {
    double weight = 1;  ///< of its points in the fit, before it is compared with the plane
    double sigma_m =
        1;  ///< by which a good view may be off; one that is off by twice as much counts a quarter
};

/// Mean square distance of a region's plane to another one, over the region's points.
double misfit2(const PlacedRegion& region, const Plane& plane);

/// A plane while it grows. World frame.
struct Surface {
    int id = -1;
    Plane plane;                                       ///< fit to `weighted`, as of the last refit()
    Moments moments;                                   ///< exact
    Moments weighted;                                  ///< each view by its weight
    Eigen::Vector3d facing = Eigen::Vector3d::Zero();  ///< weighted sum of the views' normals: the side seen
    Pose world_from_extent = Pose::Identity();         ///< z close to the normal
    Extent extent;                                     ///< of all outlines
    Box box;                                           ///< of the extent, along the principal axes
    Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();  ///< of the box
    EvidenceGrid grid;                                                              ///< the shape
    int keyframes = 0;                                                              ///< that saw it
    int last_keyframe = -1;                                                         ///< the newest of them
    double fitted_weight = 0;  ///< weighted.count at the last refit()
    int unshown = 0;           ///< cells that came to the shape or left it since it was derived
    bool changed = true;       ///< anything, since it was derived

    Surface() = default;
    /// From a region; `outline` has it in world_from_box of the region.
    Surface(const PlacedRegion& region, const FlatPolygon& outline_box, const Reliability& reliability);
    /// From a plane of a finished map; its outline counts as well supported.
    Surface(const MapPlane& plane, double cell_m);

    /// Takes a region in. The plane follows at the next refit(), the box at once.
    void add(const PlacedRegion& region, const FlatPolygon& outline_extent, const Reliability& reliability);
    /// Takes another surface in; its evidence is resampled.
    void absorb(const Surface& other);
    /// Plane, box and bounds after moments or extent changed.
    void refit();

  private:
    void rebox();
    Eigen::Vector3d long_axis_ = Eigen::Vector3d::UnitX();
};

/// Surfaces, none of which is the same plane as another by the merging rules, once merge() was called.
class SurfaceSet {
  public:
    SurfaceSet(const MergeRules& rules, double max_extent_m);

    /// The surface that a region fits best among those that satisfy the rules, or none().
    std::size_t partner_of(const PlacedRegion& region) const;
    static constexpr std::size_t none() { return static_cast<std::size_t>(-1); }

    std::size_t push_back(Surface surface);
    /// After surfaces[i] changed.
    void update(std::size_t i);

    /// Merges, the best fit first, until no pair satisfies the rules; of pairs that did not before, only
    /// those with one of `grown` can. Returns for each surface where it is now; the older id stays.
    std::vector<std::size_t> merge(const std::vector<std::size_t>& grown);

    std::vector<Surface>& surfaces() { return surfaces_; }
    const std::vector<Surface>& surfaces() const { return surfaces_; }

  private:
    /// What most pairs fail on, side by side.
    struct Bounds {
        Eigen::Vector3d normal, low, high;
        double d;
    };
    static Bounds bounds_of(const Surface& surface);
    bool may_touch(const Bounds& a, const Bounds& b) const;
    std::optional<RegionRelation> relation(const Surface& a, const Surface& b) const;

    MergeRules rules_;
    double cosine_;  ///< of the largest angle
    double max_extent_m_;
    std::vector<Surface> surfaces_;
    std::vector<Bounds> bounds_;
};

}  // namespace planemap::map
