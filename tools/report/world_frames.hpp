// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "core/trajectory.hpp"
#include "evaluate/plane_matching.hpp"

namespace planemap {

/// Whether two maps are in one world frame, and from what that is known.
struct WorldFrames {
    bool are_one = false;
    std::string why;  ///< words to follow "the world frames are one: " or "... differ: "
};

/// By poses of the same moments, where there are at least 10 of them: of one frame they lie within 10 cm and
/// 3 deg of each other (medians). Else by the planes: of one frame, half of the smaller map's area matches in
/// place, in three directions. What cannot be told counts as two frames.
WorldFrames compare_world_frames(const PlaneMap& map_a, const Trajectory& a, const PlaneMap& map_b,
                                 const Trajectory& b, const evaluation::PlaneMatches& matches);

}  // namespace planemap
