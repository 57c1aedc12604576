// SPDX-License-Identifier: BSD-3-Clause
// The planes of a map about up: how they lie, how high, and what stands before what.
#pragma once

#include <vector>

#include "core/plane_map.hpp"

namespace planemap::map {

enum class Lie { kFacesUp, kFacesDown, kUpright, kOblique };

/// A plane of the map with its heights along up, metres.
struct Standing {
    MapPlane* plane = nullptr;
    Lie lie = Lie::kOblique;
    double area = 0;
    double support = 0;        ///< what of the area counts, see supported_area()
    double height = 0;         ///< of the centre
    double low = 0, high = 0;  ///< of the outline
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(), center = Eigen::Vector3d::Zero();  ///< world
    Eigen::Vector3d half_x = Eigen::Vector3d::Zero(), half_y = half_x;  ///< of the box, world

    bool is_level() const { return lie == Lie::kFacesUp || lie == Lie::kFacesDown; }
    /// Half the box's length along a direction.
    double half_length(const Eigen::Vector3d& direction) const {
        return std::abs(half_x.dot(direction)) + std::abs(half_y.dot(direction));
    }
    /// What of its support lies between two heights.
    double support_between(double from, double to) const;
};

/// The planes that are finite, those with the most support first. Level and upright are those that are
/// nearer to it than the tolerance and what their own noise may have turned them by.
std::vector<Standing> standing_planes(PlaneMap& map, const Eigen::Vector3d& up, double tolerance_rad);

/// True for an upright plane over which something is seen: a plane that faces as it does, further behind it
/// than noise and no further than furniture is deep, reaches higher. So the plane does not bound the room.
bool is_seen_over(const Standing& upright, const std::vector<Standing>& planes, const Eigen::Vector3d& up);

/// True for an upright plane whose upper edge is the front edge of a level one, seen from above, that goes
/// back from it: a box, a cabinet, a step.
bool has_top(const Standing& upright, const std::vector<Standing>& planes, const Eigen::Vector3d& up);

}  // namespace planemap::map
