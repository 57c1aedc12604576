// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/region.hpp"

namespace planemap {

enum class PlaneLabel : std::int8_t {
    kUnknown = 0,
    kFloor = 1,
    kCeiling = 2,
    kWall = 3,
    kHorizontal = 4,
    kOther = 5
};

/// One plane of the map.
struct MapPlane {
    int id = -1;  ///< stable while the plane is the same
    PlaneLabel label = PlaneLabel::kUnknown;
    PlanarRegion region;         ///< world frame; the normal towards where it was seen from
    double area = 0;             ///< of the outline, square metres
    std::vector<int> keyframes;  ///< ids of the keyframes that saw it, ascending
};

/// Where two adjacent planes meet, cut to where both are. World frame, metres.
struct IntersectionLine {
    int plane_a = -1, plane_b = -1;  ///< ids, plane_a < plane_b
    Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
};

/// Where three adjacent planes meet. World frame, metres.
struct IntersectionPoint {
    std::array<int, 3> planes{-1, -1, -1};  ///< ids, ascending
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
};

/// The map: planes, and where they meet.
struct PlaneMap {
    std::int64_t utime = 0;        ///< of the newest keyframe in it, microseconds
    int revision = 0;              ///< of the trajectory it was built from
    std::vector<MapPlane> planes;  ///< ascending id
    std::vector<IntersectionLine> lines;
    std::vector<IntersectionPoint> points;
};

}  // namespace planemap
