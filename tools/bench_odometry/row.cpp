// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/row.hpp"

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
    double loops_true = kUnknown, loops_false = kUnknown, loops_unjudged = kUnknown;
};

Figures figures_of(const Row& row) {
    Figures f;
    if (row.evaluation) {
        const Evaluation& e = *row.evaluation;
        f.path_m = e.path_length_m;
        f.loops_true = row.loops.right;
        f.loops_false = row.loops.wrong;
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
    f.loops_unjudged = row.loops.unjudged;
    if (row.run.tracking.count > 0) {
        f.tracking_ms = row.run.tracking.median_ms;
        f.tracking_p95_ms = row.run.tracking.p95_ms;
    }
    if (row.run.segmentation.count > 0) f.segmentation_ms = row.run.segmentation.median_ms;
    return f;
}

std::string format(const char* pattern, double value) {
    char text[32];
    const bool known = std::isfinite(value);
    std::snprintf(text, sizeof(text), pattern, known ? value : 0.0);
    if (known) return text;
    return std::string(std::string(text).size() - 1, ' ') + "-";
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

}  // namespace

Row make_row(const std::string& sequence, const std::string& method, const std::optional<Trajectory>& truth,
             Run run) {
    Row row;
    row.sequence = sequence;
    row.method = method;
    row.run = std::move(run);
    if (truth) row.evaluation = evaluate(*truth, row.run.trajectory, {});
    row.loops = count_closures(truth.value_or(Trajectory()), row.run.closures);
    return row;
}

std::string table_heading() {
    return "method            frames lost |  ATE m | frame mm    deg |  1 s mm    deg | scale % | "
           "    ms    p95   seg ms  graph s | CPU s RSS MB |  kf true false\n";
}

std::string table_line(const Row& row) {
    const Figures f = figures_of(row);
    char start[64];
    std::snprintf(start, sizeof(start), "%-17s %6lld %4lld", row.method.c_str(),
                  static_cast<long long>(row.run.frames), static_cast<long long>(row.lost()));
    return start + format(" | %6.4f", f.ate_m) + format(" | %8.2f", 1e3 * f.frame_m) +
           format(" %6.3f", f.frame_deg) + format(" | %7.1f", 1e3 * f.second_m) +
           format(" %6.3f", f.second_deg) + format(" | %7.2f", 100 * (f.scale - 1)) +
           format(" | %6.2f", f.tracking_ms) + format(" %6.2f", f.tracking_p95_ms) +
           format(" %8.2f", f.segmentation_ms) + format(" %8.2f", row.run.graph.total_s) +
           format(" | %5.1f", row.cpu_s) + format(" %6.0f", row.peak_rss_mb) +
           format(" | %3.0f", row.run.keyframes) + format(" %4.0f", f.loops_true) +
           format(" %5.0f\n", f.loops_false);
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
            {"loops_unjudged", count(f.loops_unjudged)}};
}

}  // namespace planemap::bench_odometry
