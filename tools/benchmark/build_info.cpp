// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/build_info.hpp"

#include "results/host.hpp"

namespace planemap::benchmark {

namespace {

/// Of those that the project's kernels or its libraries choose between when they run.
std::string vector_instructions() {
#if defined(__x86_64__)
    std::string text = "SSE2";
    if (__builtin_cpu_supports("sse4.2")) text += " SSE4.2";
    if (__builtin_cpu_supports("avx2")) text += " AVX2";
    if (__builtin_cpu_supports("avx512f")) text += " AVX-512";
    return text;
#elif defined(__aarch64__)
    return "NEON";
#else
    return "no known vector instructions";
#endif
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

std::string build_info(const std::string& peers) {
    std::string text =
        "CPU       " + cpu_model().value_or("unknown") + " (" + vector_instructions() + "), one thread\n";
    text += std::string("compiler  GCC-compatible ") + __VERSION__ + ", " + PLANEMAP_BUILD_FLAGS + "\n";
    text += "peers     " + peers + "\n";
    if (!kOptimised) text += "WARNING   this build is not optimised: its times mean nothing\n";
    if (kSanitized) text += "WARNING   this build is sanitized: its times mean nothing\n";
    return text;
}

}  // namespace planemap::benchmark
