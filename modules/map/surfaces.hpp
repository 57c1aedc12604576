// SPDX-License-Identifier: BSD-3-Clause
// One surface once: planes that say the same part of the world again, since poses and depth err, become one.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "core/geometry/bitmap.hpp"
#include "map/plane_set.hpp"
#include "map/stored_keyframe.hpp"

namespace planemap::map {

/// A region of a keyframe in the plane that it is part of.
struct SeenRegion {
    int keyframe_id = -1;
    const StoredKeyframe* keyframe = nullptr;
    std::size_t region = 0;  ///< of the keyframe's
    std::size_t plane = PlaneSet::none();
    Pose world_from_box = Pose::Identity();

    const StoredRegion& stored() const { return keyframe->regions[region]; }
};

/// When two planes that overlap are one surface, for all that poses and depth err.
struct SurfaceRules {
    double angle_rad = 0.2094;  ///< between them: 12 deg
    double pose_sigma_m;        ///< of keyframes
    double range_bias = kRangeBias;
    double sigmas = 3;           ///< of the errors of both planes, by which they may be apart
    double most_apart_m = 0.15;  ///< whatever the errors
    /// The same where one says nearly all again of what the other says (`full_overlap`), and no view saw a
    /// step between them: readings from afar err by more than 15 cm.
    double most_apart_full_m = 0.3;
    double least_overlap = 0.2;  ///< of the smaller one's shape, that the other says again
    double full_overlap = 0.85;  ///< of it, that two surfaces never have: one would hide the other
    double beside_m = 0.3;       ///< gap between regions of one view that are seen side by side
    int least_views = 3;         ///< that see a step between two planes: then they are two
};

/// Unites planes of which one says again what the other says, the nearest first. Two that face the same way
/// and overlap cannot both have been seen through each other, so they are one surface, unless they are
/// farther apart than poses and depth err, or views saw both side by side with a step between them (which
/// poses have no part in): a board before a wall. `seen` are the regions of all planes; its planes follow.
/// Returns for each plane where it is now; the first plane of two stays.
std::vector<std::size_t> unite_surfaces(PlaneSet& planes, std::vector<SeenRegion>& seen,
                                        const SurfaceRules& rules);

}  // namespace planemap::map
