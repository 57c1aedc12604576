// SPDX-License-Identifier: BSD-3-Clause
// A walk that goes on for a day: a log of one round, again and again, through all modules.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/trajectory.hpp"
#include "pipeline/pipeline.hpp"
#include "results/table.hpp"

namespace planemap::bench_soak {

using results::Json;

/// One round of a walk, rendered, that ends where it began.
struct Round {
    std::filesystem::path log;
    std::vector<Pose> world_from_camera;  ///< the truth, one a frame
};

/// Renders a simulator's walk round its tour to FOLDER/round.lcmlog. Throws std::invalid_argument for a name
/// that is none, or whose walk does not go round.
Round render_round(const std::string& simulator_name, const std::filesystem::path& folder);

struct SoakOptions {
    int frames = 86400;
    int every = 1800;     ///< frames a line
    double period_s = 1;  ///< between stamps; the camera moves as from frame to frame of the round
    pipeline::PipelineOptions pipeline;
};

/// Feeds the round again and again, with stamps that go on. A point is how things stood after so many frames:
/// frames and lost ones, keyframes that the odometry made and that graph and map keep, loop closures accepted
/// so far, planes, MB of the process in memory (rss_mb) and allocated (heap_mb), of graph and map; since the
/// last point CPU ms a frame, and the largest error of a pose in the world from the first pose on (off_m).
/// Calls `on_frame` with the frames so far. Ends early when `on_point` returns false.
std::vector<Json> soak(const Round& round, const SoakOptions& options,
                       const std::function<void(std::int64_t frames)>& on_frame,
                       const std::function<bool(const Json&)>& on_point);

/// Growth of the process's memory from the first half hour (by the stamps) to the end, a share; nothing when
/// the run is not longer than that.
std::optional<double> growth(const std::vector<Json>& points, double period_s);

/// A walk as a row: "sequence", "period_s", "points" and "memory_growth", see growth(); null for none.
Json to_json(const std::string& sequence, const std::vector<Json>& points, double period_s);

/// What people see of a point.
const results::Table& table();

}  // namespace planemap::bench_soak
