// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/benchmark.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stdexcept>

#include "bench_odometry/child.hpp"
#include "core/validation.hpp"

namespace planemap::bench_odometry {

namespace {

/// Frames so far, on stderr: redrawn on a terminal, else a line every ten seconds.
class Counter {
  public:
    Counter(std::string what, bool quiet)
        : what_(std::move(what)), quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1) {}
    Counter(const Counter&) = delete;
    Counter& operator=(const Counter&) = delete;
    ~Counter() {
        if (terminal_ && !quiet_) std::fputs("\r\033[K", stderr);
    }
    void show(std::int64_t frames) {
        if (quiet_) return;
        const auto now = std::chrono::steady_clock::now();
        if (std::chrono::duration<double>(now - last_).count() < (terminal_ ? 0.25 : 10)) return;
        std::fprintf(stderr, "%s%s, frame %lld%s", terminal_ ? "\r\033[K" : "", what_.c_str(),
                     static_cast<long long>(frames), terminal_ ? "" : "\n");
        last_ = now;
    }

  private:
    std::string what_;
    bool quiet_, terminal_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

void BenchmarkOptions::validate() const {
    FieldErrors errors("benchmark options");
    errors.require(frames >= 0, "frames", frames, "at least 0");
    errors.require(slow_frames >= 0, "slow-frames", slow_frames, "at least 0");
    errors.throw_if_any();
}

Benchmark::Benchmark(const BenchmarkOptions& options) : options_(options) {
    options_.validate();
}

std::optional<Sequence> Benchmark::open(const SequenceInfo& info, std::string& missing) const {
    Counter counter(info.name + ", rendering", options_.quiet);
    return open_sequence(
        info, {options_.data, options_.cache, options_.frames},
        [&](std::int64_t frames) { counter.show(frames); }, missing);
}

Row Benchmark::run(const Sequence& sequence, const MethodInfo& method) const {
    std::int64_t frames = options_.frames;
    if (method.slow && options_.slow_frames > 0)
        frames = frames > 0 ? std::min<std::int64_t>(frames, options_.slow_frames) : options_.slow_frames;
    try {
        const ChildResult result = run_in_child([&] {
            Counter counter(sequence.name + ", " + method.name, options_.quiet);
            return to_json(run_method(method.name, sequence.input, frames, options_.pipeline,
                                      [&](std::int64_t count) { counter.show(count); }));
        });
        Row row = make_row(sequence.name, method.name, sequence.truth, run_from_json(result.value));
        row.cpu_s = result.cpu_s;
        row.peak_rss_mb = result.peak_rss_mb;
        return row;
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(method.name + " on " + sequence.name + ": " + error.what());
    }
}

}  // namespace planemap::bench_odometry
