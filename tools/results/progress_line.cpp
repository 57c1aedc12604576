// SPDX-License-Identifier: BSD-3-Clause
#include "results/progress_line.hpp"

#include <unistd.h>

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

}  // namespace planemap
