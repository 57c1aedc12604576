// SPDX-License-Identifier: BSD-3-Clause
// The planes of a map, asked how well a room they make about a direction that may be up.
#pragma once

#include <span>
#include <vector>

#include "core/plane_map.hpp"

namespace planemap::map {

/// 1 for a plane exactly level about u, -1 for one exactly upright, falling to 0 at the tolerance.
/// `sin2` is the squared sine of that.
double squareness(const Eigen::Vector3d& normal, const Eigen::Vector3d& u, double sin2);

/// Planes of a map, as far as they are finite, the weightiest first.
class RoomView {
  public:
    struct Seen {
        Eigen::Vector3d normal, center;        ///< world
        std::vector<Eigen::Vector3d> corners;  ///< around the outline, world, metres
        double weight = 0;                     ///< by the root of its area and its looks; all together 1

        /// How far it reaches along a direction.
        struct Range {
            double low, high;

            double length() const { return high - low; }
            double middle() const { return 0.5 * (low + high); }
        };
        Range along(const Eigen::Vector3d& direction) const;
    };

    explicit RoomView(std::span<const MapPlane> planes);

    std::span<const Seen> planes() const { return planes_; }

    /// Share of the planes that is level or upright about a direction, 0 to 1.
    double square(const Eigen::Vector3d& u, double sin2_tolerance) const;

    /// What else speaks for a direction, see find_up().
    struct Reading {
        double facing_up = 0;  ///< level planes between the ends of the room: 1 all face up, -1 all down
        double hanging = 0;    ///< upright planes under which something behind them is seen, 0 to 1
        double low = 0;        ///< what lies between the ends: 1 all at the bottom, -1 all at the top
    };
    Reading read(const Eigen::Vector3d& u, double sin2_tolerance) const;

  private:
    std::vector<Seen> planes_;
};

}  // namespace planemap::map
