// SPDX-License-Identifier: BSD-3-Clause
// What the frames between keyframes say: that they saw the same, or what has changed.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/pose.hpp"
#include "core/region.hpp"

namespace planemap {

/// A depth frame that is no keyframe, beside the keyframe that it was tracked against. Looks are at least
/// kLeastLookApart_us apart.
struct Look {
    std::int64_t utime = 0;  ///< of the frame (its depth image), microseconds
    int keyframe_id = -1;
    std::int64_t keyframe_utime = 0;
    /// 0: it sees what the keyframe saw. 1, 2, ...: what the keyframe and the looks of it so far did not see;
    /// each such number is one state of the place.
    int number = 0;
    int looks = 1;  ///< that saw this state so far, the keyframe itself and this one included
    Pose keyframe_from_camera = Pose::Identity();
    std::vector<PlanarRegion> regions;  ///< camera frame; of the first look of a state, empty in others

    /// Whether it is the first of a state.
    bool is_news() const { return number > 0 && looks == 1; }
};

/// Of one look to the next: 0.1 s, less what a camera's clock trembles.
inline constexpr std::int64_t kLeastLookApart_us = 90000;

/// More looks of one state say nothing more: so many tell what is there, whatever was before.
inline constexpr int kLooksThatCount = 5;

}  // namespace planemap
