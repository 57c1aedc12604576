// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ctime>

namespace planemap {

/// CPU time of this thread since it started, milliseconds: what others do on the machine hardly shows in it.
inline double thread_ms() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

}  // namespace planemap
