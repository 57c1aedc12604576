// SPDX-License-Identifier: BSD-3-Clause
// Where all frames were, by the keyframes that they were tracked against.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/keyframe.hpp"
#include "core/replacement.hpp"
#include "core/trajectory.hpp"

namespace planemap {

/// What of an OdometryEstimate that is placed says where the frame was.
struct FramePose {
    std::int64_t pose_utime = 0;
    int keyframe_id = -1;
    Pose keyframe_from_camera = Pose::Identity(), odom_from_camera = Pose::Identity();
};

constexpr bool is_placed(const FramePose& /*frame*/) {
    return true;
}

/// world_from_camera of the frames that have a place, by time: each at its keyframe, or, where no trajectory
/// named that, where the odom frame lies. `frames` are FramePoses or OdometryEstimates.
template <typename Frames>
Trajectory place_frames(const Frames& frames, const KeyframePoses& keyframes, const Pose& world_from_odom) {
    Trajectory trajectory;
    for (const auto& frame : frames) {
        if (!is_placed(frame)) continue;
        const std::optional<Pose> keyframe = keyframes.pose_of(frame.keyframe_id);
        trajectory.push_back({frame.pose_utime, keyframe ? *keyframe * frame.keyframe_from_camera
                                                         : world_from_odom * frame.odom_from_camera});
    }
    std::stable_sort(trajectory.begin(), trajectory.end(),
                     [](const auto& a, const auto& b) { return a.utime < b.utime; });
    return trajectory;
}

}  // namespace planemap
