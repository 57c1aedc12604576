// SPDX-License-Identifier: BSD-3-Clause
// Where the time of a run goes: "stages_ms" of report.json.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "core/histogram.hpp"
#include "messages/module_status.hpp"

namespace planemap {

namespace pipeline {
class Pipeline;
}
class Input;

/// One stage: "median", "p95" and "total_s" by the clock, the same in CPU time of the thread that worked,
/// which a busy machine does not lengthen ("cpu_median", "cpu_p95", "cpu_total_s"), and "count"; "part_of"
/// names the stage that holds it.
nlohmann::ordered_json stage_figures(const Histogram& ms, const Histogram& cpu_ms,
                                     const std::string& part_of = {});

/// The stages of a run, by name. Those that it did not have count nothing.
nlohmann::ordered_json stages_of(const Input& input, pipeline::Pipeline& pipeline);

/// Measures work that is done once, from construction on.
class StageTimer {
  public:
    /// The figures of what passed until now.
    nlohmann::ordered_json figures() const;

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double cpu_start_ms_ = messages::thread_cpu_ms();
};

/// "stages_ms" of a report, as a section of it. Throws nlohmann::json::exception for what is none.
std::string stages_markdown(const nlohmann::ordered_json& report);

}  // namespace planemap
