// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/row.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

namespace planemap::bench_map {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kWorstPairs = 5;

using Json = nlohmann::ordered_json;

/// As printf().
template <typename... Values>
std::string text(const char* format, Values... values) {
    char line[256];
    std::snprintf(line, sizeof(line), format, values...);
    return line;
}

/// A number right-aligned in `width` characters; "-" if it is not known.
std::string cell(double value, int width, int decimals) {
    return std::isfinite(value) ? text("%*.*f", width, decimals, value) : text("%*s", width, "-");
}

/// JSON has no NaN.
Json number(double value) {
    if (!std::isfinite(value)) return nullptr;
    return value;
}
Json count(double value) {
    if (!std::isfinite(value)) return nullptr;
    return std::lround(value);
}

std::optional<ErrorFigures> figures_of(std::vector<double> values) {
    if (values.empty()) return std::nullopt;
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return ErrorFigures{std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n),
                        0.5 * (values[(n - 1) / 2] + values[n / 2]), values.back()};
}

/// The figures of a row that may be unknown: NaN.
struct Figures {
    double planes_true = kUnknown, found = kUnknown, split = kUnknown, spurious = kUnknown;
    ErrorFigures metres{kUnknown, kUnknown, kUnknown}, percent = metres, degrees = metres;
    double distance_pairs = kUnknown, angle_pairs = kUnknown;
    double iou = kUnknown, iou_worst = kUnknown;
    double leaves_explained = kUnknown, area_supported = kUnknown;
    double surface_angle_worst = kUnknown, surface_angle_mean = kUnknown;
    double surface_distance_worst = kUnknown, surface_distance_mean = kUnknown;
    double message_kb = kUnknown, memory_per_message = kUnknown, update_ms = kUnknown;
    bool true_poses = false;
};

/// The found plane with the worst outline; nullptr without one.
const TruePlaneVerdict* worst_outline(const Judgement& judgement) {
    const TruePlaneVerdict* worst = nullptr;
    for (const TruePlaneVerdict& plane : judgement.planes)
        if (plane.counts() && plane.found && (worst == nullptr || plane.iou < worst->iou)) worst = &plane;
    return worst;
}

void add_judgement(const Judgement& judgement, Figures& f) {
    f.planes_true = static_cast<double>(judgement.seen());
    f.found = static_cast<double>(judgement.found());
    f.split = static_cast<double>(judgement.split());
    f.spurious = static_cast<double>(judgement.spurious.size());
    f.metres = errors_of(judgement.distances).value_or(f.metres);
    f.percent = relative_errors_of(judgement.distances).value_or(f.percent);
    f.degrees = errors_of(judgement.angles).value_or(f.degrees);
    f.distance_pairs = static_cast<double>(judgement.distances.size());
    f.angle_pairs = static_cast<double>(judgement.angles.size());
    f.iou = judgement.outline_iou().value_or(kUnknown);
    if (const TruePlaneVerdict* worst = worst_outline(judgement)) f.iou_worst = worst->iou;
}

Figures figures_of(const Row& row) {
    Figures f;
    f.true_poses = row.poses == "true";
    if (row.run.message_bytes > 0) f.message_kb = static_cast<double>(row.run.message_bytes) / 1000;
    f.memory_per_message =
        static_cast<double>(row.run.memory_bytes) / static_cast<double>(row.run.message_bytes);
    if (!row.run.poses.keyframes.empty()) f.update_ms = row.run.update_median_ms;
    if (row.judgement) add_judgement(*row.judgement, f);
    if (row.run.coverage) {
        f.leaves_explained = row.run.coverage->leaves_explained;
        f.area_supported = row.run.coverage->area_supported;
    }
    std::vector<double> angles, distances;
    for (const SurfaceCheck& check : row.surfaces) {
        angles.push_back(check.angle_deg);
        distances.push_back(check.distance_m);
    }
    if (const auto figures = figures_of(std::move(angles))) {
        f.surface_angle_mean = figures->mean;
        f.surface_angle_worst = figures->worst;
    }
    if (const auto figures = figures_of(std::move(distances))) {
        f.surface_distance_mean = figures->mean;
        f.surface_distance_worst = figures->worst;
    }
    return f;
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

struct Goal {
    const char* what;
    bool at_least;  ///< or at most
    double bound;
    double (*figure)(const Figures&);
    int decimals;
};

constexpr Goal kGoals[] = {
    {"true planes found, share", true, 1, [](const Figures& f) { return f.found / f.planes_true; }, 3},
    {"map planes too many (split)", false, 0, [](const Figures& f) { return f.split; }, 0},
    {"spurious map planes", false, 0, [](const Figures& f) { return f.spurious; }, 0},
    {"distance error, mean, m", false, 0.01, [](const Figures& f) { return f.metres.mean; }, 4},
    {"distance error, mean, % (the paper: up to 6)", false, 1,
     [](const Figures& f) { return f.percent.mean; }, 2},
    {"angle error, mean, deg (the paper: up to 2.5)", false, 0.3,
     [](const Figures& f) { return f.true_poses ? kUnknown : f.degrees.mean; }, 2},
    {"the same with true poses", false, 0.15,
     [](const Figures& f) { return f.true_poses ? f.degrees.mean : kUnknown; }, 2},
    {"outline IoU", true, 0.9, [](const Figures& f) { return f.iou; }, 3},
    {"leaves explained, share", true, 0.75, [](const Figures& f) { return f.leaves_explained; }, 3},
    {"area supported, share", true, 0.9, [](const Figures& f) { return f.area_supported; }, 3},
    {"message, kB", false, 8, [](const Figures& f) { return f.message_kb; }, 1},
    {"memory, messages", false, 2, [](const Figures& f) { return f.memory_per_message; }, 2},
    {"update of a keyframe, median, ms", false, 1, [](const Figures& f) { return f.update_ms; }, 2},
    {"surface angle, worst, deg", false, 0.5, [](const Figures& f) { return f.surface_angle_worst; }, 2},
    {"surface distance, worst, m", false, 0.01, [](const Figures& f) { return f.surface_distance_worst; }, 4},
};

}  // namespace

std::optional<ErrorFigures> errors_of(const std::vector<PairMeasure>& pairs) {
    std::vector<double> errors;
    for (const PairMeasure& pair : pairs) errors.push_back(pair.error());
    return figures_of(std::move(errors));
}

std::optional<ErrorFigures> relative_errors_of(const std::vector<PairMeasure>& pairs) {
    std::vector<double> errors;
    for (const PairMeasure& pair : pairs) errors.push_back(100 * pair.error() / pair.truth);
    return figures_of(std::move(errors));
}

std::string table_heading() {
    return "sequence             poses        kf planes | true found split spur |  dist mm  med worst     % "
           "| "
           "ang deg   med worst |   IoU worst | leaves  area |    msg B    mem B |  upd ms   p95 rebuild\n";
}

std::string table_line(const Row& row) {
    const Figures f = figures_of(row);
    return text("%-20s %-9s %5zu %6zu", row.sequence.c_str(), row.poses.c_str(),
                row.run.poses.keyframes.size(), row.run.map.planes.size()) +
           " | " + cell(f.planes_true, 4, 0) + cell(f.found, 6, 0) + cell(f.split, 6, 0) +
           cell(f.spurious, 5, 0) + " | " + cell(1e3 * f.metres.mean, 8, 1) +
           cell(1e3 * f.metres.median, 5, 0) + cell(1e3 * f.metres.worst, 6, 0) + cell(f.percent.mean, 6, 2) +
           " | " + cell(f.degrees.mean, 7, 2) + cell(f.degrees.median, 6, 2) + cell(f.degrees.worst, 6, 2) +
           " | " + cell(f.iou, 5, 3) + cell(f.iou_worst, 6, 3) + " | " + cell(f.leaves_explained, 6, 3) +
           cell(f.area_supported, 6, 3) + text(" | %8zu %8zu", row.run.message_bytes, row.run.memory_bytes) +
           " | " + cell(row.run.update_median_ms, 7, 2) + cell(row.run.update_p95_ms, 6, 1) +
           cell(row.run.rebuild_ms, 8, 1) + "\n";
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

std::string goals(const std::vector<Row>& rows) {
    std::string lines;
    for (const Goal& goal : kGoals) {
        std::string measured;
        bool met = true;
        for (const Row& row : rows) {
            const double figure = goal.figure(figures_of(row));
            if (!std::isfinite(figure)) continue;
            met = met && (goal.at_least ? figure >= goal.bound : figure <= goal.bound);
            measured.append(" ").append(cell(figure, 0, goal.decimals));
        }
        if (measured.empty()) continue;
        lines += text("  %-47s %s %-5g %s:", goal.what, goal.at_least ? ">=" : "<=", goal.bound,
                      met ? "met" : "NOT met") +
                 measured + "\n";
    }
    return lines.empty() ? lines : "Goals, and the rows' figures\n" + lines;
}

Json to_json(const Row& row) {
    const Figures f = figures_of(row);
    Json json;
    json["sequence"] = row.sequence;
    json["poses"] = row.poses;
    json["keyframes"] = row.run.poses.keyframes.size();
    json["planes"] = row.run.map.planes.size();
    json["planes_true"] = count(f.planes_true);
    json["found"] = count(f.found);
    json["split"] = count(f.split);
    json["spurious"] = count(f.spurious);
    json["distance_pairs"] = count(f.distance_pairs);
    json["distance_error_mean_m"] = number(f.metres.mean);
    json["distance_error_median_m"] = number(f.metres.median);
    json["distance_error_worst_m"] = number(f.metres.worst);
    json["distance_error_mean_percent"] = number(f.percent.mean);
    json["angle_pairs"] = count(f.angle_pairs);
    json["angle_error_mean_deg"] = number(f.degrees.mean);
    json["angle_error_median_deg"] = number(f.degrees.median);
    json["angle_error_worst_deg"] = number(f.degrees.worst);
    json["outline_iou"] = number(f.iou);
    json["outline_iou_worst"] = number(f.iou_worst);
    json["leaves_explained"] = number(f.leaves_explained);
    json["area_supported"] = number(f.area_supported);
    json["message_bytes"] = row.run.message_bytes;
    json["memory_bytes"] = row.run.memory_bytes;
    json["update_median_ms"] = number(row.run.update_median_ms);
    json["update_p95_ms"] = number(row.run.update_p95_ms);
    json["rebuild_ms"] = number(row.run.rebuild_ms);
    json["surface_angle_worst_deg"] = number(f.surface_angle_worst);
    json["surface_angle_mean_deg"] = number(f.surface_angle_mean);
    json["surface_distance_worst_m"] = number(f.surface_distance_worst);
    json["surface_distance_mean_m"] = number(f.surface_distance_mean);
    return json;
}

}  // namespace planemap::bench_map
