// SPDX-License-Identifier: BSD-3-Clause
// How the maps grew over a run, and what each took a frame.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/spread.hpp"

namespace planemap {

namespace pipeline {
class Pipeline;
}

/// Samples of a run, at most kMost, spread evenly over its frames (evaluation::Spread); the last one is of
/// its end. Maps are only read, and only for a sample: the results do not depend on it.
class Growth {
  public:
    static constexpr std::size_t kMost = 200;

    /// How things stand after a frame.
    struct Moment {
        std::int64_t utime = 0;   ///< of the frame, microseconds
        std::int64_t frames = 0;  ///< so far
        std::size_t planes = 0, map_bytes = 0;
        bool has_octomap = false;
        std::size_t octomap_nodes = 0, octomap_bytes = 0, octomap_occupied_bytes = 0;
        double segmentation_ms = 0, map_ms = 0, octomap_ms = 0;  ///< CPU time of the thread, so far
    };

    /// After each step of the input: takes a sample if one is due.
    void watch(pipeline::Pipeline& pipeline);
    /// After the pipeline's end: the sizes of the finished maps. What it takes to finish them is no frame's.
    void finish(pipeline::Pipeline& pipeline);

    /// By time.
    std::vector<Moment> moments() const;

  private:
    Moment costs(pipeline::Pipeline& pipeline) const;
    void take_sizes(pipeline::Pipeline& pipeline, Moment& moment);

    evaluation::Spread<Moment> samples_{kMost - 1};
    std::optional<Moment> last_, end_;  ///< costs after the last frame; and the sizes at the end
    std::optional<Moment> octomap_;     ///< the sizes of the OctoMap when it was last looked at,
    std::int64_t octomap_works_ = 0;    ///< and how often it was worked on until then
};

/// "time_s" (of the frames, from the first), "planes", "map_bytes" (the message), "octomap_nodes" and
/// "octomap_bytes" (the .bt file), "octomap_occupied_bytes" (of the occupied space alone),
/// "planes_ms_per_frame" (segmentation and map; CPU time of the thread since the sample before),
/// "segmentation_ms_per_frame" (the former's part) and "octomap_ms_per_frame": a list each, one entry a
/// sample. Null for an OctoMap that is not built.
nlohmann::ordered_json growth_figures(const std::vector<Growth::Moment>& moments);

/// What "growth" of a report says, as a section of it: a few of the samples; nothing if there are none.
/// Throws nlohmann::json::exception for what is none.
std::string growth_markdown(const nlohmann::ordered_json& report);

}  // namespace planemap
