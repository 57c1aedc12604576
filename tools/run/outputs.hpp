// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "results/result_folder.hpp"

namespace planemap {

class DepthWatch;
class Growth;
class Input;
struct PlaneMap;
namespace pipeline {
class Pipeline;
}

/// Wall clock and CPU time of the run.
class RunClock {
  public:
    RunClock();
    void stop();
    double wall_s() const { return wall_s_; }
    double cpu_s() const { return cpu_s_; }

  private:
    std::chrono::steady_clock::time_point start_;
    double cpu_start_ = 0, wall_s_ = 0, cpu_s_ = 0;
};

/// Frames whose pose is known.
std::int64_t tracked_frames(const pipeline::Pipeline& pipeline);

/// What nobody wants to lose, small: plane_map.lcmlog, trajectory.txt, planes.json.
std::vector<Result> essential_results(pipeline::Pipeline& pipeline);

/// The names in the folder that are planemap-run's own, to be replaced or removed. The truth's files have
/// names that recordings use, too: they are ours only if the earlier run there was on the simulator. Throws
/// std::runtime_error naming the file if this run would write over one that is not.
std::vector<std::string> result_names(const std::filesystem::path& folder, const Input& input);

/// What watched a run while it went, and what to tell of it.
struct RunWatch {
    const DepthWatch& depth;
    const RunClock& clock;
    const Growth& growth;
    const std::vector<double>& size_resolutions_m;  ///< of OctoMaps whose sizes are told, too
    const PlaneMap& start;                          ///< what was started from; without planes: nothing
};

/// What became of a run's results.
// As PageSource.
// NOLINTNEXTLINE(bugprone-exception-escape)
struct Outputs {
    nlohmann::ordered_json report;      ///< null if it could not be made
    std::vector<std::string> files;     ///< names of those that were made
    std::vector<std::string> failures;  ///< a line for each that was not
    std::filesystem::path folder;       ///< where they are; empty: nowhere
    bool kept_earlier = false;          ///< they did not replace those of an earlier run
    std::string why_aside;              ///< why not, for what they are worth; words to follow a colon
};

/// Makes all results of a run, its report with what `about` says of it (run_info()); a failure is noted, and
/// the others are still made. They replace those of an earlier run if they are whole and not poorer: a map
/// without planes does not replace one with planes, nor a run that was interrupted or tracked few frames a
/// better one (why_not_replace()). Else they are set aside in a folder of their own, or, if
/// no frame was tracked, dropped. Without an earlier run they are put in place, whole or not.
Outputs write_outputs(ResultFolder& folder, const std::string& input_name, const Input& input,
                      pipeline::Pipeline& pipeline, const RunWatch& watch,
                      const nlohmann::ordered_json& about);

}  // namespace planemap
