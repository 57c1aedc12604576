// SPDX-License-Identifier: BSD-3-Clause
#include "report/figures.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "run/report_text.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;
using Kind = FigureKind;

const std::vector<Figure>& fixed_figures() {
    static const std::vector<Figure> figures = {
        {"/frames", "frames", Kind::kCount},
        {"/tracked", "tracked", Kind::kCount, true},
        {"/keyframes", "keyframes", Kind::kCount},
        {"/loop_closures", "loop closures", Kind::kCount},
        {"/planes", "planes", Kind::kCount, true},
        {"/sizes_bytes/plane_map_message", "plane map, message", Kind::kBytes},
        {"/sizes_bytes/plane_map_zstd", "plane map, message, zstd", Kind::kBytes, true},
        {"/sizes_bytes/plane_map_working", "plane map, to go on mapping", Kind::kBytes},
        {"/sizes_bytes/octomap_bt_occupied_zstd", "OctoMap, occupied space alone, zstd", Kind::kBytes, true},
        {"/headline/ratio", "times smaller than the smallest that is no finer than as accurate", Kind::kTimes,
         true},
        {"/explained_points", "readings on planes", Kind::kShare, true},
        {"/coverage/within_2cm", "readings within 2 cm", Kind::kShare},
        {"/coverage/within_5cm", "readings within 5 cm", Kind::kShare},
        {"/coverage/leaves_explained", "OctoMap leaves on planes", Kind::kShare},
        {"/point_to_plane_rms_m", "readings to their planes, RMS", Kind::kMillimetres, true},
        {"/doubled_area", "area said twice", Kind::kShare},
        {"/floating_area", "area looked through", Kind::kShare},
        {"/outline_to_line_median_m", "outlines to the lines where planes meet, median", Kind::kMillimetres},
        {"/accuracy/ate_rmse_m", "ATE, RMSE", Kind::kMetres, true},
        {"/accuracy/rpe_frame_rmse_m", "RPE a frame, RMSE", Kind::kMillimetres},
        {"/accuracy/rpe_frame_rmse_deg", "RPE a frame, RMSE", Kind::kDegrees},
        {"/wall_s", "time by the clock", Kind::kSeconds, true},
        {"/cpu_s", "time of processors", Kind::kSeconds},
        {"/peak_rss_mb", "most memory", Kind::kMegabytes}};
    return figures;
}

}  // namespace

std::vector<Figure> figures_of(const Json& report) {
    std::vector<Figure> figures = fixed_figures();
    const Json stages = report.is_object() ? report.value("stages_ms", Json()) : Json();
    if (!stages.is_object()) return figures;
    for (const auto& [stage, unused] : stages.items()) {
        Json::json_pointer pointer("/stages_ms");
        pointer /= stage;
        pointer /= "median";
        figures.push_back({pointer.to_string(), stage + ", median", Kind::kMilliseconds});
    }
    return figures;
}

std::optional<double> value_of(const Json& report, const Figure& figure) {
    const Json::json_pointer pointer(figure.pointer);
    if (!report.contains(pointer) || !report.at(pointer).is_number()) return std::nullopt;
    // What never happened took no time: no figure.
    const Json& beside = report.at(pointer.parent_pointer());
    if (beside.is_object() && beside.value("count", Json(1)) == 0) return std::nullopt;
    const double value = report.at(pointer).get<double>();
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string figure_text(const std::optional<double>& value, Kind kind) {
    if (!value) return "-";
    switch (kind) {
        case Kind::kBytes:
            return bytes_text(*value, 2);
        case Kind::kTimes:
            return format("%.2f", *value);
        case Kind::kShare:
            return format("%.1f %%", 100 * *value);
        case Kind::kMetres:
            return format("%.4f m", *value);
        case Kind::kMillimetres:
            return format("%.2f mm", 1000 * *value);
        case Kind::kDegrees:
            return format("%.3f deg", *value);
        case Kind::kSeconds:
            return format("%.1f s", *value);
        case Kind::kMilliseconds:
            return format("%.2f ms", *value);
        case Kind::kMegabytes:
            return format("%.0f MB", *value);
        case Kind::kCount:
            break;
    }
    return format("%.0f", *value);
}

std::string change_text(const std::optional<double>& a, const std::optional<double>& b, Kind kind) {
    if (!a || !b) return "";
    if (kind == Kind::kShare) return format("%+.1f points", 100 * (*b - *a));
    return *a == 0 ? "" : format("%+.1f %%", 100 * (*b - *a) / std::abs(*a));
}

}  // namespace planemap
