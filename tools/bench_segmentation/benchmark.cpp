// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/benchmark.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "bench_segmentation/local_normals.hpp"
#include "results/progress_line.hpp"
#include "segment/overlay.hpp"
#include "sensor/png.hpp"

namespace planemap::bench {

namespace {

/// Times one frame: the median of a few runs, so that a moment's interruption does not count; a run that
/// takes long is not repeated.
double time_frame(Method& method, const DepthImage& depth, const CameraInfo& camera) {
    constexpr std::size_t kRuns = 3;
    constexpr double kLong_ms = 20;
    std::vector<double> ms{method.run(depth, camera)};
    while (ms.size() < kRuns && ms.front() < kLong_ms) ms.push_back(method.run(depth, camera));
    return median(ms);
}

}  // namespace

void BenchmarkOptions::validate() const {
    FieldErrors errors("benchmark options");
    check(errors);
    errors.require(slow_frames >= 1, "slow-frames", slow_frames, "at least 1");
    errors.require(overlay_every >= 1, "overlay-every", overlay_every, "at least 1");
    errors.throw_if_any();
}

segmentation::Segmentation as_segmentation(const Truth& truth) {
    segmentation::Segmentation segmentation;
    segmentation.labels = truth.pieces_of_pixels;
    for (const TruePiece& piece : truth.pieces) segmentation.regions.emplace_back().plane = piece.plane;
    return segmentation;
}

/// A row, the method that fills it, and the frames of the recording that it gets.
struct Benchmark::Contender {
    Row row;
    Method method;
    std::vector<std::size_t> indices;
};

/// All rows of one sequence, while they are measured.
struct Benchmark::Run {
    Sequence sequence;
    std::vector<Contender> contenders;
    Row truth;
    ProgressLine progress;
};

Benchmark::Benchmark(const BenchmarkOptions& options) : options_(options) {
    options_.validate();
}

std::vector<Row> Benchmark::run(const SequenceInfo& info, const std::vector<MethodName>& methods) const {
    Run run{open_sequence(info, options_.frames, options_.data), {}, {}, ProgressLine(options_.quiet, 10)};
    const std::vector<std::size_t>& all = run.sequence.indices;
    for (const MethodName& name : methods) {
        Row row;
        row.sequence = info.name;
        row.method = name;
        Contender& contender = run.contenders.emplace_back(Contender{row, Method(name), {}});
        const auto count = is_slow(name) ? static_cast<std::size_t>(options_.slow_frames) : all.size();
        for (const std::size_t i : evenly_spread(all.size(), count)) contender.indices.push_back(all[i]);
    }
    run.truth.sequence = info.name;
    run.truth.method = {"truth", 1};
    for (std::size_t i = 0; i < all.size(); ++i)
        run_frame(run, all[i],
                  !options_.overlays.empty() && i % static_cast<std::size_t>(options_.overlay_every) == 0);
    std::vector<Row> rows;
    if (run.truth.has_truth) rows.push_back(std::move(run.truth));
    for (Contender& contender : run.contenders) rows.push_back(std::move(contender.row));
    return rows;
}

void Benchmark::run_frame(Run& run, std::size_t index, bool draw) const {
    const CameraInfo& camera = run.sequence.camera;
    BenchFrame frame;
    try {
        frame = run.sequence.load(index);
    } catch (const std::runtime_error& error) {
        run.progress.clear();
        std::fprintf(stderr, "planemap-bench-segmentation: frame left out: %s\n", error.what());
        return;
    }
    const auto normals = local_normals(frame.depth, camera);
    if (frame.truth) {
        const segmentation::Segmentation perfect = as_segmentation(*frame.truth);
        run.truth.add(std::nullopt, frame, camera, normals, perfect);
        if (draw) this->draw(run.sequence, index, "truth", frame.depth, perfect);
    }
    for (Contender& contender : run.contenders) {
        if (!std::binary_search(contender.indices.begin(), contender.indices.end(), index)) continue;
        const MethodName& name = contender.row.method;
        const std::string subsampling = std::to_string(name.subsampling);
        if (run.progress.is_due())
            run.progress.show(run.sequence.name + " frame " + std::to_string(index) + ", " + name.name + "/" +
                              subsampling);
        const double ms = time_frame(contender.method, frame.depth, camera);
        const segmentation::Segmentation& result = contender.method.result(frame.depth, camera);
        contender.row.add(ms, frame, camera, normals, result);
        if (draw) this->draw(run.sequence, index, name.name + "-" + subsampling, frame.depth, result);
    }
}

void Benchmark::draw(const Sequence& sequence, std::size_t index, const std::string& name,
                     const DepthImage& depth, const segmentation::Segmentation& segmentation) const {
    const std::filesystem::path folder = options_.overlays / benchmark::file_name_of(sequence.name);
    std::filesystem::create_directories(folder);
    sensor::write_color_png(folder / (results::text("%04zu-", index) + name + ".png"),
                            draw_overlay(depth, sequence.camera, segmentation));
}

}  // namespace planemap::bench
