// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/benchmark.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "bench_segmentation/local_normals.hpp"
#include "core/validation.hpp"
#include "segment/overlay.hpp"
#include "sensor/png.hpp"

namespace planemap::bench {

namespace {

bool is_slow(const MethodName& method) {
    for (const MethodInfo& info : known_methods()) {
        if (info.name != method.name) continue;
        return std::count(info.slow_subsamplings.begin(), info.slow_subsamplings.end(), method.subsampling) >
               0;
    }
    return false;
}

/// Times one frame: the median of a few runs, so that a moment's interruption does not count; a run that
/// takes long is not repeated.
double time_frame(Method& method, const DepthImage& depth, const CameraInfo& camera) {
    constexpr std::size_t kRuns = 3;
    constexpr double kLong_ms = 20;
    std::vector<double> ms{method.run(depth, camera)};
    while (ms.size() < kRuns && ms.front() < kLong_ms) ms.push_back(method.run(depth, camera));
    return median(ms);
}

/// The truth as a method that is always right would return it.
segmentation::Segmentation as_segmentation(const Truth& truth) {
    segmentation::Segmentation segmentation;
    segmentation.labels = truth.pieces_of_pixels;
    for (const TruePiece& piece : truth.pieces) segmentation.regions.emplace_back().plane = piece.plane;
    return segmentation;
}

}  // namespace

void BenchmarkOptions::validate() const {
    FieldErrors errors("benchmark options");
    errors.require(frames >= 0, "frames", frames, "at least 0");
    errors.require(slow_frames >= 1, "slow-frames", slow_frames, "at least 1");
    errors.require(overlay_every >= 1, "overlay-every", overlay_every, "at least 1");
    errors.throw_if_any();
}

/// A row, the method that fills it, and the frames of the recording that it gets.
struct Benchmark::Contender {
    Row row;
    Method method;
    std::vector<std::size_t> indices;
};

Benchmark::Benchmark(const BenchmarkOptions& options) : options_(options) {
    options_.validate();
}

std::vector<Row> Benchmark::run(const SequenceInfo& info, const std::vector<MethodName>& methods,
                                std::string& missing) {
    const int frames = options_.frames > 0 ? options_.frames : info.frames;
    const auto sequence = open_sequence(info, frames, options_.data, missing);
    if (!sequence) return {};
    std::vector<Contender> contenders;
    for (const MethodName& name : methods) {
        const auto count = static_cast<std::size_t>(is_slow(name) ? options_.slow_frames : frames);
        Row row;
        row.sequence = info.name;
        row.method = name;
        contenders.push_back({row, Method(name), {}});
        for (const std::size_t i : evenly_spread(sequence->indices.size(), count))
            contenders.back().indices.push_back(sequence->indices[i]);
    }
    Row truth;
    truth.sequence = info.name;
    truth.method = {"truth", 1};
    for (std::size_t i = 0; i < sequence->indices.size(); ++i) {
        const bool draw =
            !options_.overlays.empty() && i % static_cast<std::size_t>(options_.overlay_every) == 0;
        run_frame(*sequence, sequence->indices[i], draw, contenders, truth);
    }
    end_progress();
    std::vector<Row> rows;
    if (truth.has_truth) rows.push_back(std::move(truth));
    for (Contender& contender : contenders) rows.push_back(std::move(contender.row));
    return rows;
}

void Benchmark::run_frame(const Sequence& sequence, std::size_t index, bool draw,
                          std::vector<Contender>& contenders, Row& truth) {
    BenchFrame frame;
    try {
        frame = sequence.load(index);
    } catch (const std::runtime_error& error) {
        end_progress();
        std::fprintf(stderr, "planemap-bench-segmentation: frame left out: %s\n", error.what());
        return;
    }
    const auto normals = local_normals(frame.depth, sequence.camera);
    if (frame.truth) {
        const segmentation::Segmentation perfect = as_segmentation(*frame.truth);
        truth.add(std::nullopt, frame, sequence.camera, normals, perfect);
        if (draw) this->draw(sequence, index, "truth", frame.depth, perfect);
    }
    for (Contender& contender : contenders) {
        if (!std::binary_search(contender.indices.begin(), contender.indices.end(), index)) continue;
        const MethodName& name = contender.row.method;
        show_progress(sequence, index, name);
        const double ms = time_frame(contender.method, frame.depth, sequence.camera);
        const segmentation::Segmentation& result = contender.method.result(frame.depth, sequence.camera);
        contender.row.add(ms, frame, sequence.camera, normals, result);
        if (draw)
            this->draw(sequence, index, name.name + "-" + std::to_string(name.subsampling), frame.depth,
                       result);
    }
}

void Benchmark::draw(const Sequence& sequence, std::size_t index, const std::string& name,
                     const DepthImage& depth, const segmentation::Segmentation& segmentation) const {
    std::string folder_name = sequence.name;
    std::replace(folder_name.begin(), folder_name.end(), ':', '-');
    const std::filesystem::path folder = options_.overlays / folder_name;
    std::filesystem::create_directories(folder);
    char number[24];
    std::snprintf(number, sizeof(number), "%04zu-", index);
    write_color_png(folder / (number + name + ".png"), draw_overlay(depth, sequence.camera, segmentation));
}

void Benchmark::show_progress(const Sequence& sequence, std::size_t index, const MethodName& method) {
    if (options_.quiet || ::isatty(STDERR_FILENO) != 1) return;
    std::fprintf(stderr, "\r\033[K%s frame %zu, %s/%d", sequence.name.c_str(), index, method.name.c_str(),
                 method.subsampling);
    drawn_ = true;
}

void Benchmark::end_progress() {
    if (drawn_) std::fputs("\r\033[K", stderr);
    drawn_ = false;
}

}  // namespace planemap::bench
