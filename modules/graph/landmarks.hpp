// SPDX-License-Identifier: BSD-3-Clause
// Planes as landmarks: a floor seen by many keyframes ties them all, whatever odometry does between them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/box.hpp"
#include "core/geometry/union_find.hpp"
#include "core/region.hpp"
#include "graph/options.hpp"

namespace planemap::graph {

/// A plane that keyframes share. World frame.
struct Landmark {
    Plane plane;
    Box box;  ///< of all that was seen of it
    int sightings = 0;
    bool is_surface = false;  ///< the map says who sees it, see Landmarks::adopt()
};

/// A keyframe saw a landmark: four points that carry the region's second moments must lie on it.
struct Sighting {
    int node = -1;
    int landmark = -1;                             ///< -1: it may be several
    int region = -1;                               ///< of the node's keyframe; -1: of one that went
    std::array<Eigen::Vector3d, 4> points_camera;  ///< centre +- one standard deviation along both axes
    double sqrt_weight = 0;                        ///< of each point's distance, 1/metres
};

/// See landmark_options(): the defaults are GraphOptions'.
struct LandmarkOptions {
    double min_extent_m;    ///< standard deviation along the shorter axis: smaller regions fix no rotation
    double max_angle_deg;   ///< between a region and its landmark
    double max_distance_m;  ///< RMS of the region's four points to its landmark
    double max_gap_m;       ///< between their boxes
    double sigma_m;         ///< of a point's distance, on top of the sensor's noise
};

/// What the graph's options say of them.
LandmarkOptions landmark_options(const GraphOptions& options);

/// The landmarks of a graph and who saw them.
class Landmarks {
  public:
    explicit Landmarks(const LandmarkOptions& options) : options_(options) {}

    /// Takes the regions of a keyframe (camera frame), seen by a sensor of that noise, at its present pose:
    /// each large one is a sighting of the landmark that it lies on, or founds one. A region that lies on
    /// several is left out, and so are all while the pose says nothing of which landmarks they are
    /// (`is_placed`): adopt() may take them in. Returns the largest whitened error of the new sightings.
    double add(int node, const std::vector<PlanarRegion>& regions, const Pose& world_from_camera,
               const DepthNoise& noise, bool is_placed = true);

    /// Takes the planes of landmarks that an optimisation moved. Landmarks that it did not know yet move with
    /// the node that founded them: world_moves is how the world moved about each node.
    void follow(const std::vector<Landmark>& optimised, const std::vector<Pose>& world_moves);

    /// Takes from the map which surface each region of each node shows (-1: none): one landmark each. What it
    /// does not name stays with most others of its landmark. The landmarks are laid anew through what is seen
    /// of them. Returns whether any region shows another landmark than before. Not between shared() and
    /// follow().
    bool adopt(const std::vector<std::vector<int>>& surfaces, const std::vector<Pose>& poses);
    /// Largest whitened error of a sighting of a shared landmark.
    double worst_error(const std::vector<Pose>& poses) const;

    /// Merges landmarks that coincide by the same rules; call it after the poses moved.
    void merge();

    /// Lets a node go: what it saw becomes its keeper's sightings, where the keeper has none of the same
    /// landmark itself. Sightings of nodes with higher numbers are renumbered by one, and landmarks that were
    /// merged into others, or that nobody sees any more, end. Not between shared() and follow().
    void hand_over(int gone, int keeper, const Pose& keeper_from_gone);

    /// Sightings of landmarks that at least two keyframes share.
    std::vector<Sighting> shared() const;
    /// Of those that turned out to be the same plane, only the oldest stands for it.
    const std::vector<Landmark>& landmarks() const { return landmarks_; }
    std::size_t memory_bytes() const {
        return landmarks_.capacity() * sizeof(Landmark) + sightings_.capacity() * sizeof(Sighting);
    }

  private:
    struct Candidate {
        Plane plane;
        Box box;
        std::array<Eigen::Vector3d, 4> points;
    };
    std::vector<int> surfaces_of_sightings(const std::vector<std::vector<int>>& surfaces) const;
    bool are_numbered_alike(const std::vector<int>& before) const;
    bool fits(const Candidate& region, const Landmark& landmark) const;
    void forget_unseen();

    LandmarkOptions options_;
    std::vector<Landmark> landmarks_;
    UnionFind<int> same_;  ///< landmarks that are one plane
    std::vector<Sighting> sightings_;
};

/// Whitened distances of a sighting's points to the plane.
Eigen::Vector4d sighting_error(const Sighting& sighting, const Pose& world_from_camera,
                               const Plane& plane_world);

}  // namespace planemap::graph
