// SPDX-License-Identifier: BSD-3-Clause
// How far two plane maps of one scene, in one world frame, say the same; for tests of whole programs.
#pragma once

#include "core/plane_map.hpp"

namespace planemap::test {

/// What counts as the same plane.
struct AgreementLimits {
    double distance_m = 0.01;  ///< between the planes, where both outlines are
    double angle_deg = 0.5;    ///< between the normals
    double iou = 0.9;          ///< least share of the outlines' common area in their united one
};

/// How far two planes say the same.
struct Agreement {
    int id_b = -1;          ///< of the other map's plane; -1: nothing in it overlaps this one
    double distance_m = 0;  ///< mean over the common area
    double angle_deg = 0;
    double iou = 0;

    bool is_within(const AgreementLimits& limits) const {
        return id_b >= 0 && distance_m <= limits.distance_m && angle_deg <= limits.angle_deg &&
               iou >= limits.iou;
    }
};

/// The plane beside the one of another map that its outline shares most with; several may share one. Outlines
/// are compared on a raster of 1 cm, in the plane; planes that face away from each other, or are more than
/// 0.1 m or 10 deg apart, overlap nowhere.
Agreement best_agreement(const MapPlane& plane, const PlaneMap& other);

}  // namespace planemap::test
