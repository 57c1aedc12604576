// SPDX-License-Identifier: BSD-3-Clause
// Work in a process of its own, so that its CPU time and its memory are its own, too.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

namespace planemap::benchmark {

struct ChildResult {
    nlohmann::json value;  ///< what the work returned
    double cpu_s = 0;      ///< user and system time of the whole process
    double peak_rss_mb = 0;
};

/// Runs `work` in a forked process and waits for it. Throws std::runtime_error with the work's own words if
/// it threw, or with the signal that ended it. The caller must have no other threads, and should be small:
/// its memory counts in the child's peak.
ChildResult run_in_child(const std::function<nlohmann::json()>& work);

}  // namespace planemap::benchmark
