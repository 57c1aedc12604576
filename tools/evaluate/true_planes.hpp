// SPDX-License-Identifier: BSD-3-Clause
// The planes that a map of a simulated world should hold.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "evaluate/plane_judge.hpp"
#include "simulator/renderer.hpp"

namespace planemap::evaluation {

/// What of a view counts as seen.
struct Sight {
    double min_m = 0.5, max_m = 4.0;  ///< depth along the optical axis
    double max_angle_deg = 76;        ///< between ray and normal
};

/// Collects the visible surface of each plane of a world. Surfaces on the same plane (within 1 mm and 0.1
/// deg, same side) are one plane where the boxes around their visible parts (along the sides of the first
/// rectangle) lie within 0.5 m of each other, as the paper's merging rule has it; parts further apart are
/// planes of their own. (In the simulator's worlds, parts of one plane in different rooms are further apart,
/// or meet in a doorway.) What is absent from the world, and what no depth sensor reads as it is (mirrors,
/// glass, black), is no plane.
class TruthCollector {
  public:
    explicit TruthCollector(const simulator::World& world);

    /// Adds what one exact view shows. Each cell of a plane is looked up in the view, so that no pixel is too
    /// small or too large for the raster.
    void add(const simulator::View& view, const Sight& sight);

    /// The planes seen so far, by plane and then from the largest part to the smallest.
    std::vector<TruePlane> planes() const;

  private:
    struct Group {
        Plane plane;
        Pose world_from_plane;
        PlaneRaster material, visible;       ///< of the same size
        std::vector<std::int16_t> surfaces;  ///< of each visible cell
    };

    void look(Group& group, std::int16_t index, const simulator::View& view, const Sight& sight) const;

    std::vector<std::string> surface_names_;
    std::vector<std::int16_t> surface_of_rectangle_, group_of_rectangle_;
    std::vector<Group> groups_;
};

/// The planes that a simulated sequence shows in every fifth of its first `frames` frames (0: all) within the
/// sensor's range, and that are there when these end: what has vanished, moved away or moves is not among
/// them, and what has come is, where it was seen at its last place. Nothing for other inputs.
std::optional<std::vector<TruePlane>> true_planes(const std::string& input, std::int64_t frames);

}  // namespace planemap::evaluation
