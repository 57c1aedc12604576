// SPDX-License-Identifier: BSD-3-Clause
#include "run/report.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "run/losses.hpp"
#include "run/report_text.hpp"
#include "run/size_report.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

void add_times(const Json& report, std::string& out) {
    out += "\n## Time\n\n| stage | median ms | p95 ms | times |\n| --- | ---: | ---: | ---: |\n";
    for (const auto& [stage, figures] : report.at("stages_ms").items()) {
        const double count = figures.at("count").get<double>();
        const bool simulated = stage == "input" && report.at("input").get<std::string>().starts_with("sim:");
        out += "| " + (simulated ? "input: the simulator" : stage) + " | ";
        out += count > 0 ? format("%.2f", figures.at("median").get<double>()) + " | " +
                               format("%.2f", figures.at("p95").get<double>())
                         : std::string("- | -");
        out += " | " + format("%.0f", count) + " |\n";
    }
    out += "\nWall " + format("%.1f s", report.at("wall_s").get<double>()) + ", CPU " +
           format("%.1f s", report.at("cpu_s").get<double>()) + ", peak memory " +
           format("%.0f MB", report.at("peak_rss_mb").get<double>()) + ".\n";
}

void add_tracking(const Json& report, std::string& out) {
    if (report.contains("version")) {
        const Json seed = report.value("seed", Json());
        out += "planemap " + report.at("version").get<std::string>() + ", " +
               report.at("date").get<std::string>() + (seed.is_number() ? ", seed " + seed.dump() : "") +
               "; all options are in report.json.\n\n";
    }
    const auto number = [&](const char* key) { return format("%.0f", report.at(key).get<double>()); };
    out += number("frames") + " frames: " + number("tracked") + " tracked, " + number("lost") + " lost, " +
           number("broken") + " broken. " + number("keyframes") + " keyframes, " + number("loop_closures") +
           " loop closures, " + number("planes") + " planes.\n\n";
    if (report.contains("accuracy")) {
        const Json& accuracy = report.at("accuracy");
        out += "Against the truth beside the input: ATE " +
               format("%.4f m", accuracy.at("ate_rmse_m").get<double>()) + ", RPE per frame ";
        if (accuracy.at("rpe_frame_rmse_m").is_number()) {
            out += format("%.2f mm", 1000 * accuracy.at("rpe_frame_rmse_m").get<double>()) + " and " +
                   format("%.3f deg", accuracy.at("rpe_frame_rmse_deg").get<double>()) + " (RMSE)";
        } else {
            out += accuracy.value("rpe_frame_why", "not measured");
        }
        out += ".\n";
    }
    if (report.contains("accuracy_note"))
        out += "Accuracy: " + report.at("accuracy_note").get<std::string>() + ".\n";
    if (report.contains("accuracy") || report.contains("accuracy_note")) out += "\n";
    for (const Json& warning : report.value("warnings", Json::array()))
        out += "**Warning:** " + warning.get<std::string>() + ".\n\n";
    if (report.contains("complaints") && !report.at("complaints").empty()) {
        out += "What was wrong with the input:\n\n";
        for (const Json& line : report.at("complaints")) out += "- " + line.get<std::string>() + "\n";
        out += "\n";
    }
}

}  // namespace

std::string report_markdown(const Json& report) {
    try {
        std::string out = "# planemap: " + report.at("input").get<std::string>() + "\n\n";
        add_tracking(report, out);
        out += losses_markdown(report);
        out += sizes_markdown(report);
        add_times(report, out);
        return out;
    } catch (const Json::exception& error) {
        throw std::runtime_error(std::string("not a planemap report: ") + error.what());
    }
}

}  // namespace planemap
