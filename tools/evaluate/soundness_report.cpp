// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/soundness_report.hpp"

#include <nlohmann/json.hpp>

#include "evaluate/statistics.hpp"
#include "results/table.hpp"

namespace planemap::evaluation {

namespace {

using results::Json;
using results::text;

Json figure(const std::optional<double>& value) {
    return value ? Json(*value) : Json(nullptr);
}

Json to_json(const Residuals& residuals) {
    if (residuals.count == 0) return {{"readings", 0}, {"bias_m", nullptr}, {"rms_m", nullptr}};
    return {{"readings", residuals.count}, {"bias_m", residuals.mean_m}, {"rms_m", residuals.rms_m}};
}

Json planes_of(const Soundness& soundness) {
    Json planes = Json::array();
    for (const PlaneSoundness& plane : soundness.planes) {
        Json& row = planes.emplace_back(Json{{"id", plane.id},
                                             {"area_m2", plane.area_m2},
                                             {"seen_m2", plane.seen_m2},
                                             {"floating_m2", plane.floating_m2}});
        row.update(to_json(plane.residuals));
    }
    return planes;
}

void add_shares(const ReadingCounts& counts, Json& json) {
    json["within_2cm"] = figure(counts.share_of(&ReadingCounts::close));
    json["within_band"] = figure(counts.share_of(&ReadingCounts::explained));
    json["within_5cm"] = figure(counts.share_of(&ReadingCounts::near));
}

std::string percent_text(const Json& share) {
    return share.is_number() ? text("%.1f %%", 100 * share.get<double>()) : "nothing to measure";
}

}  // namespace

Json soundness_figures(const Soundness& soundness) {
    Json pairs = Json::array(), ranges = Json::array();
    for (const DoubledPair& pair : soundness.doubled)
        pairs.push_back({{"planes", {pair.id_a, pair.id_b}}, {"area_m2", pair.area_m2}});
    for (const RangeSoundness& range : soundness.by_range) {
        if (range.residuals.count == 0) continue;
        Json& row = ranges.emplace_back(Json{{"from_m", range.from_m}, {"to_m", range.to_m}});
        row.update(to_json(range.residuals));
    }
    const bool measured = soundness.residuals.count > 0;
    return {{"doubled_area", figure(soundness.doubled_share())},
            {"floating_area", figure(soundness.floating_share())},
            {"explained_points", figure(soundness.counts.share_of(&ReadingCounts::explained))},
            {"explained_points_5cm", figure(soundness.counts.share_of(&ReadingCounts::near))},
            {"point_to_plane_rms_m", measured ? Json(soundness.residuals.rms_m) : Json(nullptr)},
            {"point_to_plane_bias_m", measured ? Json(soundness.residuals.mean_m) : Json(nullptr)},
            {"outline_to_line_median_m", results::number(nearest_rank(soundness.outline_gaps, 0.5))},
            {"outline_to_line_p90_m", results::number(nearest_rank(soundness.outline_gaps, 0.9))},
            {"soundness",
             {{"views", soundness.views},
              {"readings", soundness.counts.readings},
              {"area_m2", soundness.area_m2},
              {"doubled_m2", soundness.doubled_m2},
              {"seen_m2", soundness.seen_m2},
              {"floating_m2", soundness.floating_m2},
              {"doubled_pairs", pairs},
              {"by_range", ranges},
              {"planes", planes_of(soundness)}}}};
}

std::string soundness_markdown(const Json& report) {
    const Json& details = report.at("soundness");
    std::string out = "\n## Soundness\n\nHeld against " + details.at("readings").dump() +
                      " depth readings of " + details.at("views").dump() +
                      " views spread over the run, at their poses in trajectory.txt:\n\n"
                      "| what | share |\n| --- | ---: |\n";
    const auto row = [&](const char* what, const char* key) {
        out += std::string("| ") + what + " | " + percent_text(report.at(key)) + " |\n";
    };
    row("readings within max(1.5 cm, 3 sigma) of a plane's outline", "explained_points");
    row("readings within 5 cm of one", "explained_points_5cm");
    row("outlines' area that another plane says again (15 cm, 12 deg)", "doubled_area");
    row("outlines' seen area that most views looked through", "floating_area");
    if (report.at("outline_to_line_p90_m").is_number()) {
        out += text("\nOutlines end %.1f mm (median; p90 %.1f mm) from the lines where planes meet.\n",
                    1e3 * report.at("outline_to_line_median_m").get<double>(),
                    1e3 * report.at("outline_to_line_p90_m").get<double>());
    }
    if (report.at("point_to_plane_rms_m").is_number()) {
        out += text(
            "\nExplained readings lie %.1f mm from their plane (RMS), %+.1f mm in the mean (+: before it).\n",
            1e3 * report.at("point_to_plane_rms_m").get<double>(),
            1e3 * report.at("point_to_plane_bias_m").get<double>());
    }
    return out;
}

Json coverage_figures(const Soundness& soundness) {
    Json figures;
    add_shares(soundness.counts, figures);
    figures["by_range"] = Json::array();
    for (const RangeSoundness& range : soundness.by_range) {
        Json& row = figures["by_range"].emplace_back(
            Json{{"from_m", range.from_m}, {"to_m", range.to_m}, {"readings", range.counts.readings}});
        add_shares(range.counts, row);
    }
    figures["outline_seen_within_band"] = figure(soundness.confirmed_share());
    return figures;
}

std::string coverage_markdown(const Json& coverage) {
    if (!coverage.contains("within_2cm") || coverage.at("within_2cm").is_null()) return "";
    std::string out =
        "\n## Coverage\n\nShare of the depth readings by their distance to the nearest plane whose outline "
        "they "
        "are on:\n\n"
        "| depth | readings | within 2 cm | within max(1.5 cm, 3 sigma) | within 5 cm |\n"
        "| --- | ---: | ---: | ---: | ---: |\n";
    const auto row = [&](const std::string& depth, const std::string& readings, const Json& shares) {
        out += "| " + depth + " | " + readings + " | ";
        for (const char* key : {"within_2cm", "within_band", "within_5cm"})
            out += percent_text(shares.at(key)) + (key == std::string("within_5cm") ? " |\n" : " | ");
    };
    std::int64_t all = 0;
    for (const Json& range : coverage.at("by_range")) {
        all += range.at("readings").get<std::int64_t>();
        row(text("%.0f to %.0f m", range.at("from_m").get<double>(), range.at("to_m").get<double>()),
            range.at("readings").dump(), range);
    }
    row("all", std::to_string(all), coverage);
    out += "\nOf the outlines' area " + percent_text(coverage.at("outline_seen_within_band")) +
           " was seen with a reading within max(1.5 cm, 3 sigma)";
    const Json half = coverage.value("leaves_explained_half", Json());
    if (half.is_number())
        out += "; of the OctoMap's occupied leaves " + percent_text(half) +
               " lie within half a leaf of an outline";
    return out + ".\n";
}

}  // namespace planemap::evaluation
