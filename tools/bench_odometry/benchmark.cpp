// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/benchmark.hpp"

#include <algorithm>
#include <stdexcept>

#include "benchmark/child.hpp"
#include "benchmark/rendering.hpp"

namespace planemap::bench_odometry {

namespace {

/// Colour blurred over 15 ms and up to 9 ms away from depth, as a Kinect's.
constexpr const char* kHandHeld = "office?blur=4&jitter=0.009";

}  // namespace

const std::vector<SequenceInfo>& known_sequences() {
    static const std::vector<SequenceInfo> kSequences = benchmark::with_recordings({
        {"sim:kt0", "simulated office, a recorded hand-held trajectory of 6.5 m, Kinect noise, blur, jitter",
         kHandHeld, "handheld_poses/kt0.txt", 0},
        {"sim:kt1", "simulated office, the same, a trajectory of 2.1 m", kHandHeld, "handheld_poses/kt1.txt",
         0},
        {"sim:kt2", "simulated office, the same, a trajectory of 8.4 m", kHandHeld, "handheld_poses/kt2.txt",
         0},
        {"sim:kt3", "simulated office, the same, a trajectory of 11.3 m", kHandHeld, "handheld_poses/kt3.txt",
         0},
        {"sim:building", "simulated corridor around a block, 1.1 rounds of 100 m at walking speed",
         "building?blur=4&jitter=0.009&speed=1.2&turn=60&frames=2850", "", 0},
        {"sim:spin", "simulated office, fast rotations with blur",
         "office?blur=8&jitter=0.009&speed=1&turn=180&frames=600", "", 0},
        {"sim:wall", "simulated: along a wall, 6 m of it bare", "wall?blur=4&jitter=0.009&frames=1300", "",
         0},
        {"sim:clutter", "simulated: small boxes any way up, no plane",
         "clutter?blur=4&jitter=0.009&frames=600", "", 0},
        {"sim:dark", "simulated office without light: depth alone", "office?light=0&jitter=0.009&frames=870",
         "", 0},
        {"sim:twins", "simulated: two rooms that nothing tells apart, and a corridor",
         "twins?blur=4&jitter=0.009&speed=0.8&turn=70&frames=2100", "", 0},
    });
    return kSequences;
}

void BenchmarkOptions::validate() const {
    FieldErrors errors("benchmark options");
    check(errors);
    errors.require(slow_frames >= 0, "slow-frames", slow_frames, "at least 0");
    errors.throw_if_any();
}

Benchmark::Benchmark(const BenchmarkOptions& options) : options_(options) {
    options_.validate();
}

Sequence Benchmark::open(const SequenceInfo& info) const {
    if (!info.simulator.empty()) {
        std::filesystem::path truth_file =
            benchmark::rendered_log(info, options_.data, options_.cache, options_.frames,
                                    benchmark::frame_counter(info.name + ", rendering", options_.quiet));
        const std::string log = truth_file.string();
        return {info.name, log, read_trajectory(truth_file.replace_extension(".txt"))};
    }
    Sequence sequence{info.name, benchmark::input_of(info, options_.data), std::nullopt};
    const std::filesystem::path truth_file = std::filesystem::path(sequence.input) / "groundtruth.txt";
    if (std::filesystem::is_regular_file(truth_file)) sequence.truth = read_trajectory(truth_file);
    return sequence;
}

Row Benchmark::run(const Sequence& sequence, const MethodInfo& method) const {
    std::int64_t frames = options_.frames;
    if (method.slow && options_.slow_frames > 0)
        frames = frames > 0 ? std::min<std::int64_t>(frames, options_.slow_frames) : options_.slow_frames;
    try {
        const benchmark::ChildResult result = benchmark::run_in_child([&] {
            return to_json(
                run_method(method.name, sequence.input, frames, options_.pipeline,
                           benchmark::frame_counter(sequence.name + ", " + method.name, options_.quiet)));
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
