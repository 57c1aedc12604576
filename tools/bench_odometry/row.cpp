// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/row.hpp"

#include <algorithm>

#include "evaluate/evaluation_report.hpp"

namespace planemap::bench_odometry {

namespace {

/// Where to look: moments and errors of the false closures.
Json false_loops(const Row& row) {
    Json list = Json::array();
    for (std::size_t i = 0; i < row.loops.size(); ++i) {
        if (!row.loops[i] || !row.loops[i]->is_false) continue;
        list.push_back({{"from_utime", row.run.closures[i].from_utime},
                        {"to_utime", row.run.closures[i].to_utime},
                        {"error_m", row.loops[i]->metres},
                        {"error_deg", row.loops[i]->degrees}});
    }
    return list;
}

/// Closures that are true or false; null without truth.
Json loops(const Row& row, bool is_false) {
    if (!row.evaluation) return nullptr;
    return std::count_if(row.loops.begin(), row.loops.end(),
                         [&](const auto& loop) { return loop && loop->is_false == is_false; });
}

Json times_known(const StageTime& stage, double ms) {
    return stage.count > 0 ? Json(ms) : Json(nullptr);
}

/// Truth is recorded at 25 to 100 Hz; a fifth of a second without is a gap.
constexpr std::int64_t kMaxGap_us = 200000;

std::optional<double> nees_share(const Trajectory& truth, const std::vector<Relative>& relatives) {
    int count = 0, below = 0;
    for (const Relative& relative : relatives) {
        const auto keyframe = pose_at(truth, relative.keyframe_utime, kMaxGap_us);
        const auto camera = pose_at(truth, relative.utime, kMaxGap_us);
        if (!keyframe || !camera) continue;
        const auto nees = nees_of(pose_error(relative.keyframe_from_camera, keyframe->inverse() * *camera),
                                  relative.covariance);
        count += nees.has_value();
        below += nees && *nees < kNees95;
    }
    if (count == 0) return std::nullopt;
    return static_cast<double>(below) / count;
}

double too_large_percent(double scale) {
    return 100 * (scale - 1);
}

}  // namespace

Row make_row(const std::string& sequence, const std::string& method, const std::optional<Trajectory>& truth,
             MethodRun run) {
    Row row;
    row.sequence = sequence;
    row.method = method;
    row.run = std::move(run);
    if (truth) row.evaluation = evaluate(*truth, row.run.trajectory, {});
    if (truth) row.nees_share = nees_share(*truth, row.run.relatives);
    for (const evaluation::Closure& closure : row.run.closures)
        row.loops.push_back(evaluation::judge_closure(truth.value_or(Trajectory()), closure));
    return row;
}

const results::Table& table() {
    using results::kBar;
    using results::milli;
    static const results::Table kTable{{"method", "method", -17},
                                       {"frames", "frames", 6},
                                       {"lost", "lost", 4},
                                       kBar,
                                       {"ATE m", "ate_m", 7, 4},
                                       kBar,
                                       {"frame mm", "rpe_frame_m", 8, 2, milli},
                                       {"deg", "rpe_frame_deg", 6, 3},
                                       kBar,
                                       {"1 s mm", "rpe_1s_m", 8, 1, milli},
                                       {"deg", "rpe_1s_deg", 6, 3},
                                       kBar,
                                       {"scale %", "scale", 7, 2, too_large_percent},
                                       kBar,
                                       {"NEES %", "nees_share", 6, 0, results::percent},
                                       kBar,
                                       {"ms", "median_ms", 6, 2},
                                       {"p95", "p95_ms", 6, 2},
                                       {"seg ms", "segmentation_ms", 8, 2},
                                       {"graph s", "graph_cpu_s", 8, 2},
                                       kBar,
                                       {"CPU s", "cpu_s", 7, 1},
                                       {"RSS MB", "peak_rss_mb", 7, 0},
                                       kBar,
                                       {"kf", "keyframes", 4},
                                       {"true", "loops_true", 4},
                                       {"false", "loops_false", 5}};
    return kTable;
}

Json to_json(const Row& row) {
    Json json{{"sequence", row.sequence}, {"method", row.method}, {"frames", row.run.frames}};
    json.update(evaluation::row_figures(row.evaluation));
    json.update(Json{{"nees_share", results::known(row.nees_share, [](double share) { return share; })},
                     {"lost", row.lost()},
                     {"median_ms", times_known(row.run.tracking, row.run.tracking.median_ms)},
                     {"p95_ms", times_known(row.run.tracking, row.run.tracking.p95_ms)},
                     {"segmentation_ms", times_known(row.run.segmentation, row.run.segmentation.median_ms)},
                     {"odometry_cpu_s", row.run.tracking.total_s},
                     {"segmentation_cpu_s", row.run.segmentation.total_s},
                     {"graph_cpu_s", row.run.graph.total_s},
                     {"decoding_s", row.run.decoding.total_s},
                     {"cpu_s", row.cpu_s},
                     {"peak_rss_mb", row.peak_rss_mb},
                     {"keyframes", row.run.keyframes},
                     {"loops_true", loops(row, false)},
                     {"loops_false", loops(row, true)},
                     {"loops_unjudged",
                      std::count_if(row.loops.begin(), row.loops.end(), [](const auto& l) { return !l; })},
                     {"false_loops", false_loops(row)}});
    return json;
}

}  // namespace planemap::bench_odometry
