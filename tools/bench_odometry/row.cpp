// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/row.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>

namespace planemap::bench_odometry {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// The figures of a row that may be unknown: NaN.
struct Figures {
    double path_m = kUnknown, ate_m = kUnknown, scale = kUnknown;
    double frame_m = kUnknown, frame_deg = kUnknown, second_m = kUnknown, second_deg = kUnknown;
    double tracking_ms = kUnknown, tracking_p95_ms = kUnknown, segmentation_ms = kUnknown;
    double loops_true = kUnknown, loops_false = kUnknown;
};

Figures figures_of(const Row& row) {
    Figures f;
    if (row.evaluation) {
        const Evaluation& e = *row.evaluation;
        f.path_m = e.path_length_m;
        f.loops_true = f.loops_false = 0;
        for (const auto& loop : row.loops)
            if (loop) ++(loop->is_false ? f.loops_false : f.loops_true);
        if (e.ate) {
            f.ate_m = e.ate->metres.rmse;
            f.scale = e.ate->scale;
        }
        if (e.rpe_frame) {
            f.frame_m = e.rpe_frame->metres.rmse;
            f.frame_deg = e.rpe_frame->degrees.rmse;
        }
        if (e.rpe_1s) {
            f.second_m = e.rpe_1s->metres.rmse;
            f.second_deg = e.rpe_1s->degrees.rmse;
        }
    }
    if (row.run.tracking.count > 0) {
        f.tracking_ms = row.run.tracking.median_ms;
        f.tracking_p95_ms = row.run.tracking.p95_ms;
    }
    if (row.run.segmentation.count > 0) f.segmentation_ms = row.run.segmentation.median_ms;
    return f;
}

/// A number right-aligned in `width` characters; "-" if it is not known.
std::string cell(double value, int width, int decimals) {
    char text[32];
    if (std::isfinite(value)) {
        std::snprintf(text, sizeof(text), "%*.*f", width, decimals, value);
    } else {
        std::snprintf(text, sizeof(text), "%*s", width, "-");
    }
    return text;
}

/// JSON has no NaN.
nlohmann::ordered_json number(double value) {
    if (!std::isfinite(value)) return nullptr;
    return value;
}

nlohmann::ordered_json count(double value) {
    if (!std::isfinite(value)) return nullptr;
    return std::lround(value);
}

/// Where to look: moments and errors of the false closures.
nlohmann::ordered_json false_loops(const Row& row) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < row.loops.size(); ++i) {
        if (!row.loops[i] || !row.loops[i]->is_false) continue;
        list.push_back({{"from_utime", row.run.closures[i].from_utime},
                        {"to_utime", row.run.closures[i].to_utime},
                        {"error_m", row.loops[i]->metres},
                        {"error_deg", row.loops[i]->degrees}});
    }
    return list;
}

}  // namespace

Row make_row(const std::string& sequence, const std::string& method, const std::optional<Trajectory>& truth,
             MethodRun run) {
    Row row;
    row.sequence = sequence;
    row.method = method;
    row.run = std::move(run);
    if (truth) row.evaluation = evaluate(*truth, row.run.trajectory, {});
    for (const Closure& closure : row.run.closures)
        row.loops.push_back(judge(truth.value_or(Trajectory()), closure));
    return row;
}

std::string table_heading() {
    return "method            frames lost |   ATE m | frame mm    deg |   1 s mm    deg | scale % |     ms   "
           " p95 "
           "  seg ms  graph s |   CPU s  RSS MB |   kf true false\n";
}

std::string table_line(const Row& row) {
    const Figures f = figures_of(row);
    char start[64];
    std::snprintf(start, sizeof(start), "%-17s %6lld %4lld", row.method.c_str(),
                  static_cast<long long>(row.run.frames), static_cast<long long>(row.lost()));
    return start + (" | " + cell(f.ate_m, 7, 4)) + " | " + cell(1e3 * f.frame_m, 8, 2) +
           cell(f.frame_deg, 7, 3) + " | " + cell(1e3 * f.second_m, 8, 1) + cell(f.second_deg, 7, 3) + " | " +
           cell(100 * (f.scale - 1), 7, 2) + " | " + cell(f.tracking_ms, 6, 2) +
           cell(f.tracking_p95_ms, 7, 2) + cell(f.segmentation_ms, 9, 2) + cell(row.run.graph.total_s, 9, 2) +
           " | " + cell(row.cpu_s, 7, 1) + cell(row.peak_rss_mb, 8, 0) + " | " +
           cell(row.run.keyframes, 4, 0) + cell(f.loops_true, 5, 0) + cell(f.loops_false, 6, 0) + "\n";
}

nlohmann::ordered_json to_json(const Row& row) {
    const Figures f = figures_of(row);
    return {{"sequence", row.sequence},
            {"method", row.method},
            {"frames", row.run.frames},
            {"path_m", number(f.path_m)},
            {"ate_m", number(f.ate_m)},
            {"rpe_frame_m", number(f.frame_m)},
            {"rpe_frame_deg", number(f.frame_deg)},
            {"rpe_1s_m", number(f.second_m)},
            {"rpe_1s_deg", number(f.second_deg)},
            {"scale", number(f.scale)},
            {"lost", row.lost()},
            {"median_ms", number(f.tracking_ms)},
            {"p95_ms", number(f.tracking_p95_ms)},
            {"segmentation_ms", number(f.segmentation_ms)},
            {"odometry_cpu_s", row.run.tracking.total_s},
            {"segmentation_cpu_s", row.run.segmentation.total_s},
            {"graph_cpu_s", row.run.graph.total_s},
            {"decoding_s", row.run.decoding.total_s},
            {"cpu_s", row.cpu_s},
            {"peak_rss_mb", row.peak_rss_mb},
            {"keyframes", row.run.keyframes},
            {"loops_true", count(f.loops_true)},
            {"loops_false", count(f.loops_false)},
            {"loops_unjudged",
             std::count_if(row.loops.begin(), row.loops.end(), [](const auto& l) { return !l; })},
            {"false_loops", false_loops(row)}};
}

}  // namespace planemap::bench_odometry
