// SPDX-License-Identifier: BSD-3-Clause
#include "run/progress.hpp"

#include <cstdio>
#include <string>

#include "messages/process.hpp"
#include "pipeline/pipeline.hpp"
#include "run/input.hpp"

namespace planemap {

Progress::Progress(bool quiet) : line_(quiet), start_(std::chrono::steady_clock::now()), last_(start_) {
    if (line_.is_drawn_in_place()) messages::log_over_a_drawn_line(true);
}

void Progress::show(const Input& input, pipeline::Pipeline& pipeline) {
    if (!line_.is_due()) return;
    const auto now = std::chrono::steady_clock::now();
    const double since = std::chrono::duration<double>(now - last_).count();
    const double rate = static_cast<double>(input.frames() - last_frames_) / since;
    const OdometryEstimate* latest = pipeline.latest();
    const bool tracked = latest != nullptr && is_tracked(latest->status);
    const bool stale = latest != nullptr && latest->status == TrackingStatus::kStale;
    const std::string share =
        input.progress() ? std::to_string(static_cast<int>(100 * *input.progress())) + " %, " : "";
    char text[160];
    std::snprintf(text, sizeof(text), "frame %lld, %s%.0f frames/s%s, %zu planes, %zu keyframes, %s",
                  static_cast<long long>(input.frames()), share.c_str(), rate,
                  time_left(input.progress(), std::chrono::duration<double>(now - start_).count()).c_str(),
                  pipeline.map().mapper().map().planes.size(), pipeline.keyframes().keyframes.size(),
                  tracked ? "tracked" : (stale ? "stale" : "lost"));
    line_.show(text);
    last_ = now;
    last_frames_ = input.frames();
}

void Progress::end() {
    line_.end();
    messages::log_over_a_drawn_line(false);
}

}  // namespace planemap
