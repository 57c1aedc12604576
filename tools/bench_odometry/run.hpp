// SPDX-License-Identifier: BSD-3-Clause
// What one method made of one sequence.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "core/histogram.hpp"
#include "core/trajectory.hpp"
#include "evaluate/closure_judge.hpp"

namespace planemap::bench_odometry {

/// CPU time of a stage's thread.
struct StageTime {
    double median_ms = 0, p95_ms = 0, total_s = 0;
    std::int64_t count = 0;  ///< times it ran; the rest is 0 if never
};
StageTime stage_time(const Histogram& ms);

/// A frame's pose against its keyframe, as odometry_t says it.
struct Relative {
    std::int64_t keyframe_utime = 0, utime = 0;  ///< moments of the two poses, microseconds
    Pose keyframe_from_camera = Pose::Identity();
    Matrix6d covariance = Matrix6d::Zero();  ///< translation, rotation; camera frame
};

struct MethodRun {
    std::int64_t frames = 0;  ///< read, lost and broken ones included
    Trajectory trajectory;    ///< frames that have a pose, at the moments that they are of
    StageTime tracking;       ///< the odometry, or the peer, a frame
    StageTime graph;          ///< a keyframe
    StageTime segmentation;   ///< a frame
    StageTime decoding;       ///< images, and depth registered to colour, a frame; wall clock
    int keyframes = 0;
    std::vector<evaluation::Closure> closures;
    std::vector<Relative> relatives;  ///< frames with a pose; empty where the method says no covariance
};

/// For the way from a child process to its parent: exact.
nlohmann::json to_json(const MethodRun& run);
MethodRun run_from_json(const nlohmann::json& json);

}  // namespace planemap::bench_odometry
