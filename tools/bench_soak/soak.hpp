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

namespace planemap::bench_soak {

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
    PipelineOptions pipeline;
};

/// How things stood after so many frames.
struct SoakPoint {
    std::int64_t frames = 0, lost = 0;
    std::int64_t keyframes_made = 0;  ///< by the odometry
    std::size_t keyframes_graph = 0;  ///< kept
    std::size_t keyframes_map = 0;    ///< kept
    int loop_closures = 0;            ///< accepted so far
    std::size_t planes = 0;
    double rss_mb = 0, heap_mb = 0;  ///< of the process: in memory, and allocated
    double graph_mb = 0, map_mb = 0;
    double cpu_ms = 0;  ///< of the process, a frame, since the last point
    double off_m = 0;   ///< largest error of a pose in the world since the last point, from the first pose on
};

/// Feeds the round again and again, with stamps that go on. Ends early when `on_point` returns false.
std::vector<SoakPoint> soak(const Round& round, const SoakOptions& options,
                            const std::function<bool(const SoakPoint&)>& on_point);

/// Growth of the process's memory from the first half hour (by the stamps) to the end, a share; nothing when
/// the run is not longer than that.
std::optional<double> growth(const std::vector<SoakPoint>& points, double period_s);

std::string table_head();
std::string table_line(const SoakPoint& point);

}  // namespace planemap::bench_soak
