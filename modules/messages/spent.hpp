// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>

namespace planemap::messages {

/// CPU time of the calling thread since it began, milliseconds.
double thread_cpu_ms();

/// What work took, milliseconds: by the clock, and in CPU time of the thread that did it, which a busy
/// machine does not lengthen.
struct Spent {
    double ms = 0, cpu_ms = 0;
};

/// Adds what passes from its construction to its destruction, on one thread.
class SpentTimer {
  public:
    explicit SpentTimer(Spent& spent) : spent_(spent) {}
    ~SpentTimer() {
        spent_.ms +=
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
        spent_.cpu_ms += thread_cpu_ms() - cpu_start_ms_;
    }
    SpentTimer(const SpentTimer&) = delete;
    SpentTimer& operator=(const SpentTimer&) = delete;

  private:
    Spent& spent_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double cpu_start_ms_ = thread_cpu_ms();
};

}  // namespace planemap::messages
