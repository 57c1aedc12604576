// SPDX-License-Identifier: BSD-3-Clause
// Maps of a sequence, and what they took.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "bench_map/pose_noise.hpp"
#include "evaluate/soundness.hpp"
#include "map/map.hpp"
#include "pipeline/pipeline.hpp"
#include "run/coverage.hpp"

namespace planemap::bench_map {

/// A map, the poses that it was made with, and what it took.
struct MapRun {
    PlaneMap map;
    KeyframeTrajectory poses;
    std::size_t message_bytes = 0, memory_bytes = 0;
    double update_median_ms = 0, update_p95_ms = 0;  ///< CPU time of the mapper, one keyframe
    double rebuild_ms = 0;                           ///< the same for all keyframes anew, median
    std::optional<Coverage> coverage;                ///< nothing without an OctoMap
    evaluation::Soundness soundness;                 ///< by views at these poses
};

/// What one run through a sequence gives.
struct SequenceRun {
    std::int64_t frames = 0;
    std::vector<Keyframe> keyframes;   ///< without their features
    std::optional<Trajectory> truth;   ///< of the colour camera
    MapRun estimated;                  ///< as planemap-run makes it
    std::optional<MapRun> true_poses;  ///< the same keyframes where they truly were; nothing without truth
    std::vector<MapRun> noisy;  ///< and where they would be with RunOptions::noise; empty without truth
};

struct RunOptions {
    std::int64_t frames = 0;       ///< at most; 0: all
    bool true_poses = true;        ///< where the input has a truth
    std::vector<PoseNoise> noise;  ///< on the truth; a map for each
    pipeline::PipelineOptions pipeline;
};

/// The pipeline over a sequence (as planemap-run takes it), once for both maps. Calls `on_frame` with the
/// frames so far. Throws as open_input().
SequenceRun run_sequence(const std::string& input, const RunOptions& options,
                         const std::function<void(std::int64_t frames)>& on_frame);

/// A map of keyframes where the poses say, one after the other as they would arrive; without coverage.
/// Keyframes without a pose are left out.
MapRun map_at(const std::vector<Keyframe>& keyframes, const KeyframeTrajectory& poses,
              const map::MapOptions& options);

/// CPU time of mapping all keyframes anew because all of them moved (by 1 cm, to and fro), milliseconds:
/// median of six times.
double time_rebuild(const std::vector<Keyframe>& keyframes, const KeyframeTrajectory& poses,
                    const map::MapOptions& options);

}  // namespace planemap::bench_map
