// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace planemap {

/// A line on stderr that says how far the work is: redrawn in place several times a second on a terminal,
/// elsewhere a line of its own every few seconds.
class ProgressLine {
  public:
    /// `every_s`: between lines where there is no terminal. Quiet: shows nothing.
    explicit ProgressLine(bool quiet, double every_s = 5);
    /// A line that is still drawn is cleared.
    ~ProgressLine() { clear(); }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    bool is_drawn_in_place() const { return terminal_ && !quiet_; }
    /// True when it is time for the next line: what it says may take work.
    bool is_due() const;
    void show(const std::string& text);
    /// Takes the drawn line away, for other words on stderr.
    void clear();
    /// Leaves the drawn line as it is, and ends it.
    void end();

  private:
    bool quiet_, terminal_, drawn_ = false;
    std::chrono::duration<double> every_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// ", 1 min 20 s left", going by the pace so far; empty where that is not known. `share` of the work is done,
/// 0 to 1.
std::string time_left(std::optional<double> share, double elapsed_s);

}  // namespace planemap
