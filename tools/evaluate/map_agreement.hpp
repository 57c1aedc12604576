// SPDX-License-Identifier: BSD-3-Clause
// How far two plane maps of one scene, in one world frame, say the same.
#pragma once

#include <vector>

#include "core/plane_map.hpp"

namespace planemap {

/// What counts as the same plane.
struct AgreementLimits {
    double distance_m = 0.01;  ///< between the planes, where both outlines are
    double angle_deg = 0.5;    ///< between the normals
    double iou = 0.9;          ///< least share of the outlines' common area in their united one
};

/// A plane of map a beside its partner in map b: the one, of those not taken by a better pair, whose outline
/// it shares most with.
struct PlanePair {
    int id_a = -1, id_b = -1;  ///< id_b -1: nothing in b overlaps it
    double area_m2 = 0;        ///< of the outline in a
    double distance_m = 0;     ///< mean over the common area
    double angle_deg = 0;
    double iou = 0;

    bool agrees(const AgreementLimits& limits) const {
        return id_b >= 0 && distance_m <= limits.distance_m && angle_deg <= limits.angle_deg &&
               iou >= limits.iou;
    }
};

/// One pair for each plane of a, in a's order. Outlines are compared on a raster of 1 cm, in a's plane;
/// planes that face away from each other, or are more than 0.1 m or 10 deg apart, overlap nowhere.
std::vector<PlanePair> pair_planes(const PlaneMap& a, const PlaneMap& b);

}  // namespace planemap
