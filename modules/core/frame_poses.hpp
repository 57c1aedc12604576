// SPDX-License-Identifier: BSD-3-Clause
// Where all frames were, by the keyframes that they were tracked against.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/components.hpp"
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

/// world_from_camera of frames of one component, by time.
struct ComponentTrajectory {
    int component = 0;
    Trajectory trajectory;
};

/// Where the frames that have a place were, in the world of their component, in the order of components():
/// each at its keyframe, or, where the graph never named that, where it says that the odom frame lies.
/// `frames` are FramePoses or OdometryEstimates; `keyframes` are what `graph` and those before it said.
/// Without frames one, empty.
template <typename Frames>
std::vector<ComponentTrajectory> place_frames(const Frames& frames, const KeyframePoses& keyframes,
                                              const KeyframeTrajectory& graph) {
    std::vector<ComponentTrajectory> placed;
    std::map<int, std::size_t> at;
    for (const int component : components(graph)) {
        at[component] = placed.size();
        placed.push_back({component, {}});
    }
    if (placed.empty()) {
        at[0] = 0;
        placed.emplace_back();
    }
    const int newest = graph.keyframes.empty() ? 0 : graph.keyframes.back().component;
    for (const auto& frame : frames) {
        if (!is_placed(frame)) continue;
        const std::optional<Pose> keyframe = keyframes.pose_of(frame.keyframe_id);
        const auto part = at.find(keyframes.component_of(frame.keyframe_id).value_or(newest));
        if (part == at.end()) continue;
        const Pose world_from_camera = keyframe ? *keyframe * frame.keyframe_from_camera
                                                : graph.world_from_odom * frame.odom_from_camera;
        placed[part->second].trajectory.push_back({frame.pose_utime, world_from_camera});
    }
    for (ComponentTrajectory& part : placed)
        std::stable_sort(part.trajectory.begin(), part.trajectory.end(),
                         [](const auto& a, const auto& b) { return a.utime < b.utime; });
    return placed;
}

}  // namespace planemap
