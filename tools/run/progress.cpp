// SPDX-License-Identifier: BSD-3-Clause
#include "run/progress.hpp"

#include <unistd.h>

#include <cstdio>
#include <string>

#include "messages/process.hpp"
#include "run/input.hpp"
#include "run/pipeline.hpp"

namespace planemap {

Progress::Progress(bool quiet)
    : quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {
    if (terminal_ && !quiet_) log_over_a_drawn_line(true);
}

void Progress::show(const Input& input, Pipeline& pipeline) {
    if (quiet_) return;
    const auto now = std::chrono::steady_clock::now();
    const double since = std::chrono::duration<double>(now - last_).count();
    if (since < (terminal_ ? 0.25 : 5.0)) return;
    const double rate = static_cast<double>(input.frames() - last_frames_) / since;
    const OdometryEstimate* latest = pipeline.latest();
    const bool lost = latest == nullptr || latest->status == TrackingStatus::kLost;
    const std::string share =
        input.progress() ? std::to_string(static_cast<int>(100 * *input.progress())) + " %, " : "";
    std::fprintf(stderr, "%sframe %lld, %s%.0f frames/s, %zu planes, %zu keyframes, %s%s",
                 terminal_ ? "\r\033[K" : "", static_cast<long long>(input.frames()), share.c_str(), rate,
                 pipeline.map().mapper().map().planes.size(), pipeline.keyframes().keyframes.size(),
                 lost ? "lost" : "tracked", terminal_ ? "" : "\n");
    std::fflush(stderr);
    drawn_ = terminal_;
    last_ = now;
    last_frames_ = input.frames();
}

void Progress::end() {
    if (drawn_) std::fputs("\n", stderr);
    drawn_ = false;
    log_over_a_drawn_line(false);
}

}  // namespace planemap
