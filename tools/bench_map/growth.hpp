// SPDX-License-Identifier: BSD-3-Clause
// How a map grows while a camera goes round after round.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/pipeline.hpp"
#include "results/table.hpp"

namespace planemap::bench_map {

using results::Json;

/// A point is what there is after so many frames: frames, keyframes, planes, message_bytes, memory_bytes, and
/// since the point before map_ms (CPU time of the mapper, a keyframe: median) and frame_ms (CPU time of all
/// modules, a frame: mean).
struct Growth {
    std::vector<Json> points;  ///< every thousand frames, and the last
    std::vector<Json> rounds;  ///< at the end of each whole round; without times
    /// Bytes of the message that the second round added, as a share of the first's.
    std::optional<double> second_round() const;
    /// Cost of a frame between the last two points, over the cost of one between the first two. The first
    /// point's own frames are left out: a map begins small.
    std::optional<double> cost_ratio() const;
};

/// Runs the whole pipeline, without OctoMap, over all frames of a simulated world. Calls `on_frame` with the
/// frames so far.
Growth measure_growth(const std::string& simulator_name, std::int64_t frames,
                      pipeline::PipelineOptions options, const std::function<void(std::int64_t)>& on_frame);

std::string growth_table(const Growth& growth);
Json to_json(const std::string& sequence, const Growth& growth);

}  // namespace planemap::bench_map
