// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/bad_moments.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "benchmark/child.hpp"
#include "benchmark/choices.hpp"
#include "benchmark/rendering.hpp"
#include "core/geometry/angle.hpp"
#include "evaluate/closure_judge.hpp"
#include "sensor/source.hpp"

namespace planemap::bench_odometry {

// For the way from a child process to its parent.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MomentRow, frames, wrong, no_pose, degenerate, stale, unjudged, parts,
                                   worst_m, worst_deg, nees_count, nees_below)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ReturnsRow, cuts, found, wrong)

namespace {

constexpr int kCuts = 21;
constexpr std::size_t kReturnFrames = 12;
constexpr std::int64_t kPause_us = 180000000;
constexpr double kRate_hz = 30;

/// A small image: a row takes seconds.
constexpr const char* kSmall = "width=320&height=240&blur=4&jitter=0.005";

std::string small(const std::string& world, const std::string& more) {
    return world + "?" + kSmall + "&" + more;
}

/// The true pose of a later frame's camera in an earlier one's.
std::optional<Pose> true_relation(const Told& told, std::size_t from, std::size_t to) {
    if (from >= told.frames.size() || to >= told.frames.size()) return std::nullopt;
    const auto &a = told.frames[from].truth, &b = told.frames[to].truth;
    if (!a || !b) return std::nullopt;
    return a->inverse() * *b;
}

/// Against its keyframe; nothing for a frame that is its keyframe itself.
std::optional<double> nees_at(const Told& told, std::size_t frame) {
    const OdometryEstimate& estimate = told.frames[frame].estimate;
    const ToldKeyframe* keyframe = told.find(estimate.keyframe_id);
    if (!is_tracked(estimate.status) || keyframe == nullptr) return std::nullopt;
    const std::optional<Pose> truth = true_relation(told, keyframe->frame, frame);
    if (!truth) return std::nullopt;
    return nees_of(pose_error(estimate.keyframe_from_camera, *truth), estimate.covariance);
}

void count(const Judgement& judgement, TrackingStatus status, MomentRow& row) {
    using Verdict = Judgement::Verdict;
    row.wrong += judgement.verdict == Verdict::kWrong;
    row.no_pose += judgement.verdict == Verdict::kNoPose;
    row.unjudged += judgement.verdict == Verdict::kUnknown;
    row.degenerate += status == TrackingStatus::kDegenerate;
    row.stale += status == TrackingStatus::kStale;
    if (judgement.verdict != Verdict::kWrong && judgement.verdict != Verdict::kRight) return;
    row.worst_m = std::max(row.worst_m, judgement.metres);
    row.worst_deg = std::max(row.worst_deg, judgement.degrees);
}

const results::Table& moment_table() {
    using results::kBar;
    static const results::Table kTable{{"moment", "moment", -13},
                                       {"frames", "frames", 6},
                                       kBar,
                                       {"wrong", "wrong", 5},
                                       {"no pose", "no_pose", 7},
                                       {"degen.", "degenerate", 6},
                                       {"stale", "stale", 5},
                                       {"parts", "parts", 5},
                                       kBar,
                                       {"worst m", "worst_m", 7, 3},
                                       {"deg", "worst_deg", 5, 1},
                                       kBar,
                                       {"NEES %", "nees_share", 6, 0, results::percent}};
    return kTable;
}

Json to_json(const MomentRow& row) {
    return {{"bad_sequence", row.sequence},
            {"moment", row.moment},
            {"frames", row.frames},
            {"wrong", row.wrong},
            {"no_pose", row.no_pose},
            {"degenerate", row.degenerate},
            {"stale", row.stale},
            {"unjudged", row.unjudged},
            {"parts", row.parts},
            {"worst_m", row.worst_m},
            {"worst_deg", row.worst_deg},
            {"nees_share", row.nees_count > 0 ? Json(static_cast<double>(row.nees_below) / row.nees_count)
                                              : Json(nullptr)}};
}

Json to_json(const ReturnsRow& row) {
    return {
        {"returns_sequence", row.sequence}, {"cuts", row.cuts}, {"found", row.found}, {"false", row.wrong}};
}

/// A sequence that is there: where its frames and its truth are.
struct Opened {
    Sequence sequence;
    FrameRange range;
};

Opened open(const BenchmarkOptions& options, const BadSequence& bad) {
    Opened opened{Benchmark(options).open(bad.sequence), {bad.from, bad.from + bad.frames}};
    if (!opened.sequence.truth) throw benchmark::DataMissing("It has no groundtruth.txt");
    return opened;
}

Told run(const Opened& opened, const Script& script, bool with_graph, const BenchmarkOptions& options,
         const std::string& what) {
    pipeline::PipelineOptions pipeline = options.pipeline;
    pipeline.with_graph = with_graph;
    pipeline.with_map = pipeline.with_octomap = false;
    return run_script(sensor::open_source(opened.sequence.input, {.frames = opened.range}), script,
                      *opened.sequence.truth, pipeline, benchmark::frame_counter(what, options.quiet));
}

template <typename Row>
Row in_child(const std::string& what, const std::function<Row()>& work) {
    try {
        const benchmark::ChildResult result = benchmark::run_in_child([&]() -> nlohmann::json {
            // What the modules say of a bad moment is in the row.
            spdlog::set_level(spdlog::level::err);
            return work();
        });
        return result.value.template get<Row>();
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(what + ": " + error.what());
    }
}

/// The moments of a sequence that are asked for.
std::vector<Disturbance> moments_of(const BadSequence& bad, const std::string& asked) {
    std::vector<Disturbance> own = bad.moments.empty()
                                       ? known_disturbances()
                                       : benchmark::chosen("moments", bad.moments, known_disturbances());
    if (asked.empty()) return own;
    const std::vector<Disturbance> chosen = benchmark::chosen("moments", asked, known_disturbances());
    std::erase_if(own, [&](const Disturbance& one) {
        return std::none_of(chosen.begin(), chosen.end(),
                            [&](const Disturbance& other) { return other.name == one.name; });
    });
    return own;
}

void run_moments(const BenchmarkOptions& options, const BadSequence& bad, const std::string& asked,
                 MomentRow& sum, benchmark::Report& report) {
    const std::vector<Disturbance> moments = moments_of(bad, asked);
    if (moments.empty()) return;
    const Opened opened = open(options, bad);
    report.print("\n" + bad.sequence.name + ": " + bad.sequence.what + "\n" + moment_table().heading());
    for (const Disturbance& moment : moments) {
        const std::string what = bad.sequence.name + ", " + moment.name;
        MomentRow row = in_child<MomentRow>(what, [&] {
            const Script script = moment.script({bad.frames, bad.first, kRate_hz});
            return make_row(run(opened, script, false, options, what), bad.first);
        });
        row.sequence = bad.sequence.name;
        row.moment = moment.name;
        sum.frames += row.frames;
        sum.wrong += row.wrong;
        sum.no_pose += row.no_pose;
        report.add(to_json(row), moment_table());
    }
}

void run_returns(const BenchmarkOptions& options, const BadSequence& bad, benchmark::Report& report) {
    const Opened opened = open(options, bad);
    const std::string what = bad.sequence.name + ", returns";
    ReturnsRow row = in_child<ReturnsRow>(what, [&] {
        const Script script =
            returns(bad.walk, bad.frames - bad.walk, kCuts, kReturnFrames, kPause_us, kRate_hz);
        return make_returns_row(run(opened, script, true, options, what), bad.walk, kCuts, kReturnFrames);
    });
    row.sequence = bad.sequence.name;
    report.print(results::text("\n%s: %s\n  %d returns after 180 s, %d frames each: %d found, %d false\n",
                               bad.sequence.name.c_str(), bad.sequence.what.c_str(), row.cuts,
                               static_cast<int>(kReturnFrames), row.found, row.wrong));
    report.add(to_json(row));
}

const BadSequence& bad_sequence(const std::string& name) {
    const auto& all = bad_sequences();
    return *std::find_if(all.begin(), all.end(),
                         [&](const BadSequence& bad) { return bad.sequence.name == name; });
}

std::vector<BadSequence> disturbed_sequences() {
    return {
        {{"redkitchen", "frames 0 to 239 of the recording", "", "", 0}, 0, 240, 100, "", 0},
        {{"fr1_rpy_start", "frames 0 to 239 of the recording", "", "", 0}, 0, 240, 100, "", 0},
        {{"sim:bad-office", "simulated office, 320 x 240", small("office", "frames=240"), "", 0},
         0,
         240,
         100,
         "",
         0},
        {{"sim:bad-twins", "simulated: two rooms that nothing tells apart, 320 x 240",
          small("twins", "speed=1.5&turn=120&frames=1080"), "", 0},
         0,
         240,
         100,
         "none,covered-3s,restart,replay",
         0},
        {{"sim:bad-wallpaper", "simulated: a room whose wall pattern comes again every 2 m, 320 x 240",
          small("wallpaper", "frames=240"), "", 0},
         0,
         240,
         100,
         "none,covered-3s,restart,replay",
         0},
        {{"sim:bad-slide", "simulated: 1.8 m along a bare wall in the dark, 320 x 240",
          small("wall", "light=0&frames=330"), "", 0},
         200,
         120,
         2,
         "none",
         0},
    };
}

std::vector<BadSequence> returning_sequences() {
    return {
        {{"sim:returns-office", "simulated office, a round, and returns to places of it",
          small("office", "speed=1&turn=90&frames=900"), "", 0},
         0,
         900,
         0,
         "",
         450},
        {{"sim:returns-mural", "simulated: a room with pictures that all differ, a round, and returns",
          small("mural", "speed=1&turn=90&frames=900"), "", 0},
         0,
         900,
         0,
         "",
         450},
        {{"sim:returns-wallpaper",
          "simulated: the same room whose pattern comes again every 2 m, and returns",
          small("wallpaper", "speed=1&turn=90&frames=900"), "", 0},
         0,
         900,
         0,
         "",
         450},
        {{"sim:returns-twins", "simulated: two rooms that nothing tells apart, and returns to both",
          small("twins", "speed=1.5&turn=120&frames=2160"), "", 0},
         0,
         2160,
         0,
         "",
         1080},
    };
}

}  // namespace

const std::vector<BadSequence>& bad_sequences() {
    static const std::vector<BadSequence> kSequences = [] {
        std::vector<BadSequence> all = disturbed_sequences();
        const std::vector<BadSequence> returning = returning_sequences();
        all.insert(all.end(), returning.begin(), returning.end());
        return all;
    }();
    return kSequences;
}

std::vector<SequenceInfo> bad_sequence_infos() {
    std::vector<SequenceInfo> infos;
    for (const BadSequence& bad : bad_sequences()) infos.push_back(bad.sequence);
    return infos;
}

MomentRow make_row(const Told& told, std::size_t first) {
    const PoseJudge judge(told.frames, told.keyframes, first);
    MomentRow row;
    row.parts = judge.parts_begun();
    for (std::size_t i = first; i < told.frames.size(); ++i) {
        ++row.frames;
        count(judge.judge(i), told.frames[i].estimate.status, row);
        const std::optional<double> nees = nees_at(told, i);
        row.nees_count += nees.has_value();
        row.nees_below += nees && *nees < kNees95;
    }
    return row;
}

ReturnsRow make_returns_row(const Told& told, std::size_t walk, int cuts, std::size_t frames) {
    ReturnsRow row;
    row.cuts = cuts;
    for (int cut = 0; cut < cuts; ++cut) {
        const std::size_t begin = walk + static_cast<std::size_t>(cut) * frames, end = begin + frames;
        bool is_placed = false, is_wrong = false;
        const auto hear = [&](std::size_t from, std::size_t to, const Pose& from_from_to) {
            if (from >= begin || to < begin || to >= end) return;
            const std::optional<Pose> truth = true_relation(told, from, to);
            if (!truth) return;
            is_placed = true;
            is_wrong = is_wrong || evaluation::closure_error(from_from_to, *truth).is_false;
        };
        for (std::size_t i = begin; i < std::min(end, told.frames.size()); ++i) {
            const OdometryEstimate& estimate = told.frames[i].estimate;
            const ToldKeyframe* keyframe = told.find(estimate.keyframe_id);
            if (!is_tracked(estimate.status) || keyframe == nullptr || is_unknown(estimate.covariance))
                continue;
            hear(keyframe->frame, i, estimate.keyframe_from_camera);
        }
        for (const ToldClosure& closure : told.closures) {
            const ToldKeyframe *from = told.find(closure.from_id), *to = told.find(closure.to_id);
            if (from != nullptr && to != nullptr) hear(from->frame, to->frame, closure.from_from_to);
        }
        row.wrong += is_wrong;
        row.found += is_placed && !is_wrong;
    }
    return row;
}

void print_bad_moments(const BenchmarkOptions& given, const std::string& sequences,
                       const std::string& moments, benchmark::Report& report) {
    BenchmarkOptions options = given;
    options.frames = 0;  // each has its own
    const std::vector<SequenceInfo> infos = bad_sequence_infos();
    MomentRow sum;
    report.for_each(benchmark::chosen("sequences", sequences, infos), [&](const SequenceInfo& info) {
        const BadSequence& bad = bad_sequence(info.name);
        if (bad.walk > 0) {
            if (moments.empty()) run_returns(options, bad, report);
        } else {
            run_moments(options, bad, moments, sum, report);
        }
    });
    report.print(results::text("\nAll moments: %d frames, %d wrong, %d without a pose\n", sum.frames,
                               sum.wrong, sum.no_pose));
}

}  // namespace planemap::bench_odometry
