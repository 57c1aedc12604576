// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>

#include "results/progress_line.hpp"

namespace planemap {

class Input;
namespace pipeline {
class Pipeline;
}

/// A line on stderr while the work goes on: frame, rate, time left, planes, tracking state. On a terminal it
/// is redrawn in place; elsewhere one line every few seconds.
class Progress {
  public:
    explicit Progress(bool quiet);
    void show(const Input& input, pipeline::Pipeline& pipeline);
    /// Ends the line that is redrawn.
    void end();

  private:
    ProgressLine line_;
    std::chrono::steady_clock::time_point start_, last_;
    std::int64_t last_frames_ = 0;
};

}  // namespace planemap
