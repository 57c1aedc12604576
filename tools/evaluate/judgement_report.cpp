// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/judgement_report.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::evaluation {

namespace {

using results::known;
using results::text;

constexpr std::size_t kWorstPairs = 5;

/// The found plane with the worst outline; nullptr without one.
const TruePlaneVerdict* worst_outline(const Judgement& judgement) {
    const TruePlaneVerdict* worst = nullptr;
    for (const TruePlaneVerdict& plane : judgement.planes)
        if (plane.counts() && plane.found && (worst == nullptr || plane.iou < worst->iou)) worst = &plane;
    return worst;
}

void add_errors(const Judgement* judgement, Json& json) {
    const std::vector<PairMeasure> none;
    const std::vector<PairMeasure>& distances = judgement != nullptr ? judgement->distances : none;
    const std::vector<PairMeasure>& angles = judgement != nullptr ? judgement->angles : none;
    const Statistics metres = errors_of(distances), degrees = errors_of(angles);
    json["distance_pairs"] = judgement != nullptr ? Json(distances.size()) : Json(nullptr);
    json["distance_error_mean_m"] = figure_of(metres, &Statistics::mean);
    json["distance_error_median_m"] = figure_of(metres, &Statistics::median);
    json["distance_error_worst_m"] = figure_of(metres, &Statistics::max);
    json["distance_error_mean_percent"] = figure_of(relative_errors_of(distances), &Statistics::mean);
    json["angle_pairs"] = judgement != nullptr ? Json(angles.size()) : Json(nullptr);
    json["angle_error_mean_deg"] = figure_of(degrees, &Statistics::mean);
    json["angle_error_median_deg"] = figure_of(degrees, &Statistics::median);
    json["angle_error_worst_deg"] = figure_of(degrees, &Statistics::max);
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

}  // namespace

Json figure_of(const Statistics& errors, double Statistics::*figure) {
    return errors.count > 0 ? Json(errors.*figure) : Json(nullptr);
}

Statistics errors_of(const std::vector<PairMeasure>& pairs) {
    std::vector<double> errors;
    errors.reserve(pairs.size());
    for (const PairMeasure& pair : pairs) errors.push_back(pair.error());
    return statistics(std::move(errors));
}

Statistics relative_errors_of(const std::vector<PairMeasure>& pairs) {
    std::vector<double> errors;
    errors.reserve(pairs.size());
    for (const PairMeasure& pair : pairs) errors.push_back(100 * pair.error() / pair.truth);
    return statistics(std::move(errors));
}

Json figures_of(const std::optional<Judgement>& judged) {
    const TruePlaneVerdict* worst = judged ? worst_outline(*judged) : nullptr;
    Json json;
    json["planes_true"] = known(judged, [](const Judgement& j) { return j.seen(); });
    json["found"] = known(judged, [](const Judgement& j) { return j.found(); });
    json["split"] = known(judged, [](const Judgement& j) { return j.split(); });
    json["spurious"] = known(judged, [](const Judgement& j) { return j.spurious.size(); });
    add_errors(judged ? &*judged : nullptr, json);
    json["outline_iou"] = results::number(judged ? judged->outline_iou().value_or(NAN) : NAN);
    json["outline_iou_worst"] = results::number(worst != nullptr ? worst->iou : NAN);
    return json;
}

Json edge_figures(const std::optional<EdgeJudgement>& edges) {
    const auto share = [&](std::optional<double> (EdgeJudgement::*of)() const) {
        return results::number(edges ? (*edges.*of)().value_or(NAN) : NAN);
    };
    Json json;
    json["edges_true_m"] = known(edges, [](const EdgeJudgement& e) { return e.true_m; });
    json["edges_found"] = share(&EdgeJudgement::edges_found);
    json["lines_right"] = share(&EdgeJudgement::lines_right);
    json["corners_true"] = known(edges, [](const EdgeJudgement& e) { return e.corners; });
    json["corners_found"] = share(&EdgeJudgement::corners_found);
    json["points_right"] = share(&EdgeJudgement::points_right);
    return json;
}

Json inferred_figures(const std::optional<InferredJudgement>& inferred) {
    Json json;
    json["inferred_m2"] = known(inferred, [](const InferredJudgement& i) { return i.area_m2; });
    json["inferred_right"] = results::number(inferred ? inferred->right().value_or(NAN) : NAN);
    return json;
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

}  // namespace planemap::evaluation
