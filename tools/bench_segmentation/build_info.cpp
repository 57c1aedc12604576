// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/build_info.hpp"

#include <pcl/pcl_config.h>

#include <fstream>
#include <opencv2/core/version.hpp>

namespace planemap::bench {

namespace {

std::string cpu_model() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    }
    return "unknown";
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
#ifdef __OPTIMIZE__
constexpr bool kOptimised = true;
#else
constexpr bool kOptimised = false;
#endif

}  // namespace

std::string build_info() {
    std::string text = "CPU       " + cpu_model() + ", one thread\n";
    text += std::string("compiler  GCC-compatible ") + __VERSION__ + ", " + PLANEMAP_BUILD_FLAGS + "\n";
    text += std::string("peers     PCL ") + PCL_VERSION_PRETTY +
            " compiled with these flags (PCL_NO_PRECOMPILE); ransac-debian: Debian's build of it; OpenCV " +
            CV_VERSION + " as Debian builds it\n";
    if (!kOptimised) text += "WARNING   this build is not optimised: its times mean nothing\n";
    if (kSanitized) text += "WARNING   this build is sanitized: its times mean nothing\n";
    return text;
}

}  // namespace planemap::bench
