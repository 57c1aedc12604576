// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

#include "results/result_folder.hpp"

namespace planemap {

namespace pipeline {
class Pipeline;
}

/// Writes what is mapped so far to the workspace of the results' folder every few seconds, so that a run that
/// is killed leaves it there. Reads only: the results at the end do not depend on it.
class InterimResults {
  public:
    explicit InterimResults(ResultFolder& folder);

    /// Waits three seconds from one time to the next, and fifty times as long as writing took: at most 2 % of
    /// the run, however long that is. A failure is logged once, and tried again.
    void write_if_due(pipeline::Pipeline& pipeline);

    int times() const { return times_; }         ///< written
    double cpu_ms() const { return cpu_ms_; }    ///< CPU time of all of them
    double wall_ms() const { return wall_ms_; }  ///< and by the clock: waiting for the disk included

  private:
    using Clock = std::chrono::steady_clock;

    ResultFolder& folder_;
    Clock::time_point due_;
    int times_ = 0;
    double cpu_ms_ = 0, wall_ms_ = 0;
    bool failed_ = false;
};

}  // namespace planemap
