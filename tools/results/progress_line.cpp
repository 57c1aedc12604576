// SPDX-License-Identifier: BSD-3-Clause
#include "results/progress_line.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace planemap {

ProgressLine::ProgressLine(bool quiet, double every_s)
    : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), every_(terminal_ ? 0.25 : every_s) {}

bool ProgressLine::is_due() const {
    return !quiet_ && std::chrono::steady_clock::now() - last_ >= every_;
}

void ProgressLine::show(const std::string& text) {
    if (quiet_) return;
    std::fprintf(stderr, "%s%s%s", terminal_ ? "\r\033[K" : "", text.c_str(), terminal_ ? "" : "\n");
    std::fflush(stderr);
    drawn_ = terminal_;
    last_ = std::chrono::steady_clock::now();
}

void ProgressLine::clear() {
    if (drawn_) std::fputs("\r\033[K", stderr);
    drawn_ = false;
}

void ProgressLine::end() {
    if (drawn_) std::fputs("\n", stderr);
    drawn_ = false;
}

std::string time_left(std::optional<double> share, double elapsed_s) {
    if (!share || !(*share > 0)) return {};
    const double left_s = elapsed_s * std::max(1 / *share - 1, 0.0);
    char text[48];
    if (left_s < 60) {
        std::snprintf(text, sizeof(text), ", %.0f s left", left_s);
    } else if (left_s < 3600) {
        std::snprintf(text, sizeof(text), ", %d min %02d s left", static_cast<int>(left_s) / 60,
                      static_cast<int>(left_s) % 60);
    } else {
        std::snprintf(text, sizeof(text), ", %.1f h left", left_s / 3600);
    }
    return text;
}

}  // namespace planemap
