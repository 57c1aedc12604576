// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/row.hpp"

#include <algorithm>
#include <cmath>

#include "evaluate/soundness_report.hpp"

namespace planemap::bench_map {

namespace {

using namespace evaluation;
using results::cell;
using results::figure;
using results::known;
using results::text;

void add_surfaces(const std::vector<SurfaceCheck>& surfaces, Json& json) {
    std::vector<double> degrees, metres;
    for (const SurfaceCheck& check : surfaces) {
        degrees.push_back(check.angle_deg);
        metres.push_back(check.distance_m);
    }
    const Statistics angle = statistics(std::move(degrees)), distance = statistics(std::move(metres));
    json["surface_angle_worst_deg"] = figure_of(angle, &Statistics::max);
    json["surface_angle_mean_deg"] = figure_of(angle, &Statistics::mean);
    json["surface_distance_worst_m"] = figure_of(distance, &Statistics::max);
    json["surface_distance_mean_m"] = figure_of(distance, &Statistics::mean);
}

double found_share(const Json& row, const char* found) {
    return figure(row, found) / figure(row, "planes_true");
}
double messages(const Json& row, const char* bytes) {
    return figure(row, bytes) / figure(row, "message_bytes");
}
double kilobytes(const Json& row, const char* bytes) {
    return row.at(bytes) == 0 ? NAN : figure(row, bytes) / 1000;
}
double of_keyframes(const Json& row, const char* key) {
    return row.at("keyframes") == 0 ? NAN : figure(row, key);
}
double at_true_poses(const Json& row, const char* key) {
    return row.at("poses") == "true" ? figure(row, key) : NAN;
}
double at_estimated_poses(const Json& row, const char* key) {
    return row.at("poses") == "true" ? NAN : figure(row, key);
}

struct Goal {
    const char* what;
    bool at_least;  ///< or at most
    double bound;
    int decimals;
    const char* key;  ///< of a row's JSON
    double (*measure)(const Json& row, const char* key) = figure;
};

constexpr Goal kGoals[] = {
    {"true planes found, share", true, 1, 3, "found", found_share},
    {"map planes too many (split)", false, 0, 0, "split"},
    {"spurious map planes", false, 0, 0, "spurious"},
    {"distance error, mean, m", false, 0.01, 4, "distance_error_mean_m"},
    {"distance error, mean, % (the paper: up to 6)", false, 1, 2, "distance_error_mean_percent"},
    {"angle error, mean, deg (the paper: up to 2.5)", false, 0.3, 2, "angle_error_mean_deg",
     at_estimated_poses},
    {"the same with true poses", false, 0.15, 2, "angle_error_mean_deg", at_true_poses},
    {"outline IoU", true, 0.9, 3, "outline_iou"},
    {"doubled area, share", false, 0.01, 3, "doubled_area"},
    {"floating area, share", false, 0.01, 3, "floating_area"},
    {"edges found, share", true, 0.9, 3, "edges_found"},
    {"lines on an edge, share", true, 0.95, 3, "lines_right"},
    {"corners found, share", true, 0.9, 3, "corners_found"},
    {"points on a corner, share", true, 0.95, 3, "points_right"},
    {"inferred, on the true plane, share", true, 0.95, 3, "inferred_right"},
    {"outline to its line, p90, m", false, 0.02, 4, "outline_to_line_p90_m"},
    {"leaves explained, share", true, 0.75, 3, "leaves_explained"},
    {"area supported, share", true, 0.9, 3, "area_supported"},
    {"message, kB", false, 8, 1, "message_bytes", kilobytes},
    {"memory, messages", false, 2, 2, "memory_bytes", messages},
    {"update of a keyframe, median, ms", false, 1, 2, "update_median_ms", of_keyframes},
    {"surface angle, worst, deg", false, 0.5, 2, "surface_angle_worst_deg"},
    {"surface distance, worst, m", false, 0.01, 4, "surface_distance_worst_m"},
};

}  // namespace

Json to_json(const Row& row) {
    Json json;
    json["sequence"] = row.sequence;
    json["poses"] = row.poses;
    json["keyframes"] = row.run.poses.keyframes.size();
    json["planes"] = row.run.map.planes.size();
    json.update(figures_of(row.judgement));
    json.update(edge_figures(row.edges));
    json.update(inferred_figures(row.inferred));
    json["leaves_explained"] =
        known(row.run.coverage, [](const Coverage& coverage) { return coverage.leaves_explained; });
    json["area_supported"] =
        known(row.run.coverage, [](const Coverage& coverage) { return coverage.area_supported; });
    json.update(evaluation::soundness_figures(row.run.soundness));
    json["message_bytes"] = row.run.message_bytes;
    json["memory_bytes"] = row.run.memory_bytes;
    json["update_median_ms"] = results::number(row.run.update_median_ms);
    json["update_p95_ms"] = results::number(row.run.update_p95_ms);
    json["rebuild_ms"] = results::number(row.run.rebuild_ms);
    add_surfaces(row.surfaces, json);
    return json;
}

const results::Table& table() {
    using results::kBar;
    using results::milli;
    using results::percent;
    static const results::Table kTable{{"sequence", "sequence", -20},
                                       {"poses", "poses", -9},
                                       {"kf", "keyframes", 5},
                                       {"planes", "planes", 6},
                                       kBar,
                                       {"true", "planes_true", 4},
                                       {"found", "found", 5},
                                       {"split", "split", 5},
                                       {"spur", "spurious", 4},
                                       kBar,
                                       {"dist mm", "distance_error_mean_m", 8, 1, milli},
                                       {"med", "distance_error_median_m", 4, 0, milli},
                                       {"worst", "distance_error_worst_m", 5, 0, milli},
                                       {"%", "distance_error_mean_percent", 5, 2},
                                       kBar,
                                       {"ang deg", "angle_error_mean_deg", 7, 2},
                                       {"med", "angle_error_median_deg", 5, 2},
                                       {"worst", "angle_error_worst_deg", 5, 2},
                                       kBar,
                                       {"IoU", "outline_iou", 5, 3},
                                       {"worst", "outline_iou_worst", 5, 3},
                                       kBar,
                                       {"edge %", "edges_found", 6, 1, percent},
                                       {"right", "lines_right", 5, 1, percent},
                                       {"corn %", "corners_found", 6, 1, percent},
                                       {"right", "points_right", 5, 1, percent},
                                       {"gap mm", "outline_to_line_p90_m", 6, 1, milli},
                                       kBar,
                                       {"dbl %", "doubled_area", 5, 1, percent},
                                       {"flt %", "floating_area", 5, 1, percent},
                                       {"expl %", "explained_points", 6, 1, percent},
                                       {"5 cm", "explained_points_5cm", 5, 1, percent},
                                       {"rms mm", "point_to_plane_rms_m", 6, 1, milli},
                                       {"bias", "point_to_plane_bias_m", 5, 1, milli},
                                       kBar,
                                       {"leaves", "leaves_explained", 6, 3},
                                       {"area", "area_supported", 5, 3},
                                       kBar,
                                       {"msg B", "message_bytes", 8},
                                       {"mem B", "memory_bytes", 8},
                                       kBar,
                                       {"upd ms", "update_median_ms", 7, 2},
                                       {"p95", "update_p95_ms", 5, 1},
                                       {"rebuild", "rebuild_ms", 7, 1}};
    return kTable;
}

std::string details(const Row& row, bool all) {
    std::string lines;
    if (row.judgement) lines += judgement_details(*row.judgement, all);
    for (const SurfaceCheck& check : row.surfaces)
        lines += text("  surface of map plane %d (%.2f m2, %.0f readings): %.2f deg, %.1f mm off\n", check.id,
                      check.area, check.points, check.angle_deg, 1e3 * check.distance_m);
    if (lines.empty()) return lines;
    return row.sequence + ", " + row.poses + " poses\n" + lines;
}

std::string goals(const std::vector<Json>& rows) {
    std::string lines;
    for (const Goal& goal : kGoals) {
        std::string measured;
        bool met = true;
        for (const Json& row : rows) {
            const double value = goal.measure(row, goal.key);
            if (!std::isfinite(value)) continue;
            met = met && (goal.at_least ? value >= goal.bound : value <= goal.bound);
            measured.append(" ").append(cell(value, 0, goal.decimals));
        }
        if (measured.empty()) continue;
        lines += text("  %-47s %s %-5g %s:", goal.what, goal.at_least ? ">=" : "<=", goal.bound,
                      met ? "met" : "NOT met") +
                 measured + "\n";
    }
    return lines.empty() ? lines : "Goals, and the rows' figures\n" + lines;
}

}  // namespace planemap::bench_map
