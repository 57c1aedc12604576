// SPDX-License-Identifier: BSD-3-Clause
// A disturbed stream of frames through the modules.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "bench_odometry/disturbances.hpp"
#include "bench_odometry/pose_judge.hpp"
#include "core/frame_source.hpp"
#include "core/trajectory.hpp"
#include "pipeline/pipeline.hpp"

namespace planemap::bench_odometry {

/// A loop closure that the graph accepted.
struct ToldClosure {
    int from_id = -1, to_id = -1;          ///< keyframes, the older one first
    Pose from_from_to = Pose::Identity();  ///< the newer camera in the older one's frame
};

/// What the modules said of a script.
struct Told {
    std::vector<ToldFrame> frames;  ///< one for each frame of the script; lost where nothing was said of it
    std::vector<ToldKeyframe> keyframes;
    std::vector<ToldClosure> closures;  ///< with a graph

    const ToldKeyframe* find(int id) const;
};

/// Shows a script of a source's frames to the modules. `truth` is of the colour camera, by the source's own
/// stamps. Calls on_frame with the frames so far. Throws as the modules, and std::runtime_error if the source
/// has fewer frames than the script shows.
Told run_script(std::unique_ptr<FrameSource> source, const Script& script, const Trajectory& truth,
                const pipeline::PipelineOptions& options, const std::function<void(std::int64_t)>& on_frame);

}  // namespace planemap::bench_odometry
