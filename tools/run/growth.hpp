// SPDX-License-Identifier: BSD-3-Clause
// How the maps grew over a run, and what each took a frame.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "evaluate/spread.hpp"
#include "octomap/kept_keyframes.hpp"
#include "octomap/octomap_sizes.hpp"

namespace planemap {

namespace pipeline {
class Pipeline;
}

/// Samples of a run, at most kMost, spread evenly over its frames (evaluation::Spread); the last one is of
/// its end. Maps are only read, and only for a sample: the results do not depend on it.
///
/// The plane map is as it stood after each frame. The pipeline's OctoMap lets new depth wait for the end as
/// soon as poses were corrected, and is then built anew: its growth is heard there, with each depth image at
/// its last pose. So its times do not hold what following corrections costs, which the planes' do.
class Growth {
  public:
    static constexpr std::size_t kMost = 200;

    /// How things stand after a frame.
    struct Moment {
        std::int64_t utime = 0;   ///< of the frame, microseconds
        std::int64_t frames = 0;  ///< so far
        std::size_t planes = 0, map_bytes = 0;
        double segmentation_ms = 0, map_ms = 0;  ///< CPU time of the thread, so far
        // Of the OctoMap's .bt file; 0 without.
        std::size_t octomap_nodes = 0, octomap_bytes = 0, octomap_occupied_bytes = 0;
        double octomap_ms = 0;  ///< CPU time of the thread to insert the depth of keyframes and looks, so far
    };

    /// Listens to the pipeline's OctoMap as long as that goes on.
    explicit Growth(pipeline::Pipeline& pipeline);
    Growth(const Growth&) = delete;
    Growth& operator=(const Growth&) = delete;

    /// After each step of the input: takes a sample if one is due.
    void watch();
    /// After the pipeline's end: the finished maps. What it takes to finish them is no frame's.
    void finish();

    /// "time_s" (of the frames, from the first), "planes", "map_bytes" (the message), "octomap_nodes" and
    /// "octomap_bytes" (the .bt file), "octomap_occupied_bytes" (of the occupied space alone),
    /// "planes_ms_per_frame" (segmentation and map; CPU time of the thread since the sample before),
    /// "segmentation_ms_per_frame" (its first part) and "octomap_ms_per_frame": a list each, one entry a
    /// sample. Null for an OctoMap that is not built, or that was rebuilt after
    /// it let depth go (max_keyframes).
    nlohmann::ordered_json figures() const;

  private:
    /// The OctoMap after a scan had entered.
    struct Scan {
        int keyframe = -1;
        octomap::OctomapSizes sizes;
        double ms = 0;  ///< so far
    };
    void listen();
    void hear(octomap::ScanId id, const ::octomap::OcTree& tree, bool is_in);
    void fill_in_octomap();

    pipeline::Pipeline& pipeline_;
    evaluation::Spread<Moment> samples_{kMost - 1};
    std::optional<Moment> last_;   ///< after the last frame, without sizes
    std::vector<Moment> moments_;  ///< once it is finished
    bool has_octomap_ = false;
    evaluation::Spread<Scan> scans_{kMost};
    std::optional<octomap::ScanId> last_scan_;
    double since_ms_ = 0, spent_ms_ = 0;  ///< clock when the scan at hand began to enter; for all until then
};

/// The same of moments in order of time.
nlohmann::ordered_json growth_figures(const std::vector<Growth::Moment>& moments, bool has_octomap);

/// What "growth" of a report says, as a section of it: a few of the samples; nothing if there are none.
/// Throws nlohmann::json::exception for what is none.
std::string growth_markdown(const nlohmann::ordered_json& report);

}  // namespace planemap
