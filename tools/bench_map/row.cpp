// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/row.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::bench_map {

namespace {

using namespace evaluation;
using benchmark::cell;
using benchmark::figure;
using benchmark::known;
using benchmark::text;

constexpr std::size_t kWorstPairs = 5;

/// The found plane with the worst outline; nullptr without one.
const TruePlaneVerdict* worst_outline(const Judgement& judgement) {
    const TruePlaneVerdict* worst = nullptr;
    for (const TruePlaneVerdict& plane : judgement.planes)
        if (plane.counts() && plane.found && (worst == nullptr || plane.iou < worst->iou)) worst = &plane;
    return worst;
}

/// One of the figures; null for no values.
Json of(const Statistics& errors, double Statistics::*figure) {
    return errors.count > 0 ? Json(errors.*figure) : Json(nullptr);
}

void add_errors(const Judgement* judgement, Json& json) {
    const std::vector<PairMeasure> none;
    const std::vector<PairMeasure>& distances = judgement != nullptr ? judgement->distances : none;
    const std::vector<PairMeasure>& angles = judgement != nullptr ? judgement->angles : none;
    const Statistics metres = errors_of(distances), degrees = errors_of(angles);
    json["distance_pairs"] = judgement != nullptr ? Json(distances.size()) : Json(nullptr);
    json["distance_error_mean_m"] = of(metres, &Statistics::mean);
    json["distance_error_median_m"] = of(metres, &Statistics::median);
    json["distance_error_worst_m"] = of(metres, &Statistics::max);
    json["distance_error_mean_percent"] = of(relative_errors_of(distances), &Statistics::mean);
    json["angle_pairs"] = judgement != nullptr ? Json(angles.size()) : Json(nullptr);
    json["angle_error_mean_deg"] = of(degrees, &Statistics::mean);
    json["angle_error_median_deg"] = of(degrees, &Statistics::median);
    json["angle_error_worst_deg"] = of(degrees, &Statistics::max);
}

void add_surfaces(const std::vector<SurfaceCheck>& surfaces, Json& json) {
    std::vector<double> degrees, metres;
    for (const SurfaceCheck& check : surfaces) {
        degrees.push_back(check.angle_deg);
        metres.push_back(check.distance_m);
    }
    const Statistics angle = statistics(std::move(degrees)), distance = statistics(std::move(metres));
    json["surface_angle_worst_deg"] = of(angle, &Statistics::max);
    json["surface_angle_mean_deg"] = of(angle, &Statistics::mean);
    json["surface_distance_worst_m"] = of(distance, &Statistics::max);
    json["surface_distance_mean_m"] = of(distance, &Statistics::mean);
}

/// "wall (12)": a true plane and the map plane that it was found as.
std::string named(const Judgement& judgement, std::size_t index) {
    const TruePlaneVerdict& plane = judgement.planes[index];
    return plane.name + " (" + std::to_string(plane.best) + ")";
}

std::string plane_line(const TruePlaneVerdict& plane) {
    std::string line = text("    %-32s %6.2f m2", plane.name.c_str(), plane.area);
    if (plane.best < 0) return line + ", no map plane on it\n";
    line += text(", map plane %d covers %.0f %%, %.2f deg, %+.0f mm, IoU %.2f", plane.best,
                 100 * plane.covered, plane.angle_deg, 1e3 * plane.distance_m, plane.iou);
    if (plane.parts.size() > 1) {
        line += ", parts";
        for (const int id : plane.parts) line.append(" ").append(std::to_string(id));
    }
    return line + "\n";
}

/// The lines of the planes that satisfy `wanted`, under a heading.
template <typename Wanted>
std::string plane_lines(const Judgement& judgement, const char* heading, const Wanted& wanted) {
    std::string lines;
    for (const TruePlaneVerdict& plane : judgement.planes)
        if (plane.counts() && wanted(plane)) lines += plane_line(plane);
    return lines.empty() ? lines : "  " + std::string(heading) + ":\n" + lines;
}

std::string worst_pairs(const Judgement& judgement, std::vector<PairMeasure> pairs, const char* heading,
                        const char* unit, int decimals) {
    if (pairs.empty()) return "";
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const auto& a, const auto& b) { return a.error() > b.error(); });
    pairs.resize(std::min(pairs.size(), kWorstPairs));
    std::string lines = "  " + std::string(heading) + ":\n";
    for (const PairMeasure& pair : pairs)
        lines += text("    %-52s true %.*f %s, map %.*f %s\n",
                      (named(judgement, pair.a) + " - " + named(judgement, pair.b)).c_str(), decimals,
                      pair.truth, unit, decimals, pair.map, unit);
    return lines;
}

std::string judgement_details(const Judgement& judgement, bool all) {
    std::string lines =
        plane_lines(judgement, "not found", [](const auto& plane) { return !plane.found; }) +
        plane_lines(judgement, "split", [](const auto& plane) { return plane.parts.size() > 1; });
    if (!judgement.spurious.empty()) lines += "  spurious:\n";
    for (const SpuriousPlane& plane : judgement.spurious)
        lines += text("    map plane %d, %.2f m2, %.0f %% of it on a true plane\n", plane.id, plane.area,
                      100 * plane.on_true_plane);
    if (const TruePlaneVerdict* worst = worst_outline(judgement))
        lines += "  worst outline:\n" + plane_line(*worst);
    lines += worst_pairs(judgement, judgement.distances, "worst distances", "m", 3) +
             worst_pairs(judgement, judgement.angles, "worst angles", "deg", 2);
    if (!judgement.shared.empty()) lines += "  map planes on several true planes:\n";
    for (const SharedPlane& plane : judgement.shared) {
        lines += text("    map plane %d:", plane.id);
        for (const SharedPlane::Share& share : plane.shares)
            lines += text("%s %s %.2f m2", &share == plane.shares.data() ? "" : ",",
                          judgement.planes[share.plane].name.c_str(), share.area);
        lines += "\n";
    }
    for (const LookAlikes& pair : judgement.look_alikes)
        lines += text("  two planes, but one by the mapper's rules: %s - %s, %.1f deg, %.0f mm\n",
                      named(judgement, pair.a).c_str(), named(judgement, pair.b).c_str(), pair.angle_deg,
                      1e3 * pair.distance_m);
    if (all) lines += plane_lines(judgement, "all", [](const auto&) { return true; });
    return lines;
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
    {"leaves explained, share", true, 0.75, 3, "leaves_explained"},
    {"area supported, share", true, 0.9, 3, "area_supported"},
    {"message, kB", false, 8, 1, "message_bytes", kilobytes},
    {"memory, messages", false, 2, 2, "memory_bytes", messages},
    {"update of a keyframe, median, ms", false, 1, 2, "update_median_ms", of_keyframes},
    {"surface angle, worst, deg", false, 0.5, 2, "surface_angle_worst_deg"},
    {"surface distance, worst, m", false, 0.01, 4, "surface_distance_worst_m"},
};

}  // namespace

Statistics errors_of(const std::vector<PairMeasure>& pairs) {
    std::vector<double> errors;
    for (const PairMeasure& pair : pairs) errors.push_back(pair.error());
    return statistics(std::move(errors));
}

Statistics relative_errors_of(const std::vector<PairMeasure>& pairs) {
    std::vector<double> errors;
    for (const PairMeasure& pair : pairs) errors.push_back(100 * pair.error() / pair.truth);
    return statistics(std::move(errors));
}

Json to_json(const Row& row) {
    const std::optional<Judgement>& judged = row.judgement;
    const TruePlaneVerdict* worst = judged ? worst_outline(*judged) : nullptr;
    Json json;
    json["sequence"] = row.sequence;
    json["poses"] = row.poses;
    json["keyframes"] = row.run.poses.keyframes.size();
    json["planes"] = row.run.map.planes.size();
    json["planes_true"] = known(judged, [](const Judgement& j) { return j.seen(); });
    json["found"] = known(judged, [](const Judgement& j) { return j.found(); });
    json["split"] = known(judged, [](const Judgement& j) { return j.split(); });
    json["spurious"] = known(judged, [](const Judgement& j) { return j.spurious.size(); });
    add_errors(judged ? &*judged : nullptr, json);
    json["outline_iou"] = benchmark::number(judged ? judged->outline_iou().value_or(NAN) : NAN);
    json["outline_iou_worst"] = benchmark::number(worst != nullptr ? worst->iou : NAN);
    json["leaves_explained"] =
        known(row.run.coverage, [](const Coverage& coverage) { return coverage.leaves_explained; });
    json["area_supported"] =
        known(row.run.coverage, [](const Coverage& coverage) { return coverage.area_supported; });
    json["message_bytes"] = row.run.message_bytes;
    json["memory_bytes"] = row.run.memory_bytes;
    json["update_median_ms"] = benchmark::number(row.run.update_median_ms);
    json["update_p95_ms"] = benchmark::number(row.run.update_p95_ms);
    json["rebuild_ms"] = benchmark::number(row.run.rebuild_ms);
    add_surfaces(row.surfaces, json);
    return json;
}

const benchmark::Table& table() {
    using benchmark::kBar;
    using benchmark::milli;
    static const benchmark::Table kTable{{"sequence", "sequence", -20},
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
