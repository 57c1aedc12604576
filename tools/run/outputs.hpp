// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace planemap {

class Input;
class Pipeline;

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

/// Writes all results of a run into the folder, each beside and renamed, report.json last, and returns the
/// report. Throws std::runtime_error naming the file that could not be written.
nlohmann::ordered_json write_outputs(const std::filesystem::path& folder, const std::string& input_name,
                                     const Input& input, Pipeline& pipeline, const RunClock& clock);

}  // namespace planemap
