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
///
/// The plane map is as it stood after each frame. The pipeline's OctoMap lets new depth wait for the end as
/// soon as poses were corrected, so it tells nothing of its growth: it is grown once more, with each depth
/// image at its last pose. So its times do not hold what following corrections costs, which the planes' do.
class Growth {
  public:
    static constexpr std::size_t kMost = 200;

    /// How things stand after a frame.
    struct Moment {
        std::int64_t utime = 0;   ///< of the frame, microseconds
        std::int64_t frames = 0;  ///< so far
        std::size_t planes = 0, map_bytes = 0;
        double segmentation_ms = 0, map_ms = 0;  ///< CPU time of the thread, so far
        // Of the OctoMap's .bt file; meaningless unless has_octomap.
        std::size_t octomap_nodes = 0, octomap_bytes = 0, octomap_occupied_bytes = 0;
        double octomap_ms = 0;  ///< CPU time of the thread to insert the depth of keyframes and looks, so far
    };

    /// After each step of the input: takes a sample if one is due.
    void watch(pipeline::Pipeline& pipeline);
    /// After the pipeline's end: the finished maps, and the OctoMap's growth, which takes as long as
    /// inserting its depth. What it takes to finish the maps is no frame's.
    void finish(pipeline::Pipeline& pipeline);

    /// "time_s" (of the frames, from the first), "planes", "map_bytes" (the message), "octomap_nodes" and
    /// "octomap_bytes" (the .bt file), "octomap_occupied_bytes" (of the occupied space alone),
    /// "planes_ms_per_frame" (segmentation and map; CPU time of the thread since the sample before),
    /// "segmentation_ms_per_frame" (its first part) and "octomap_ms_per_frame": a list each, one entry a
    /// sample. Null for an OctoMap that is not built, or that let depth go (max_keyframes).
    nlohmann::ordered_json figures() const;

  private:
    evaluation::Spread<Moment> samples_{kMost - 1};
    std::optional<Moment> last_;   ///< after the last frame, without sizes
    std::vector<Moment> moments_;  ///< once it is finished
    bool has_octomap_ = false;
};

/// The same of moments in order of time.
nlohmann::ordered_json growth_figures(const std::vector<Growth::Moment>& moments, bool has_octomap);

/// What "growth" of a report says, as a section of it: a few of the samples; nothing if there are none.
/// Throws nlohmann::json::exception for what is none.
std::string growth_markdown(const nlohmann::ordered_json& report);

}  // namespace planemap
