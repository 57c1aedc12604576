// SPDX-License-Identifier: BSD-3-Clause
#include "run/report.hpp"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "run/losses.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

std::string format(const char* pattern, double value) {
    char text[64];
    std::snprintf(text, sizeof(text), pattern, value);
    return text;
}

std::string bytes_text(double bytes) {
    if (bytes < 1e3) return format("%.0f B", bytes);
    if (bytes < 1e6) return format("%.1f kB", bytes / 1e3);
    if (bytes < 1e9) return format("%.1f MB", bytes / 1e6);
    return format("%.2f GB", bytes / 1e9);
}

std::string share_text(const Json& share) {
    return share.is_number() ? format("%.1f %%", 100 * share.get<double>()) : "not measured";
}

void add_sizes(const Json& report, std::string& out) {
    const Json& sizes = report.at("sizes_bytes");
    const Json& coverage = report.at("coverage");
    const double message = sizes.at("plane_map_message").get<double>();
    const Json& octomap = report.at("octomap");
    const std::string resolution = octomap.at("resolution_m").is_number()
                                       ? format("%.0f cm", 100 * octomap.at("resolution_m").get<double>())
                                       : "";
    const struct {
        const char* key;
        std::string name;
    } rows[] = {{"plane_map_message", "plane map, the message"},
                {"plane_map_memory", "plane map, in memory"},
                {"octomap_memory", "OctoMap " + resolution + ", in memory"},
                {"octomap_ot", "OctoMap " + resolution + ", .ot file"},
                {"octomap_bt", "OctoMap " + resolution + ", .bt file"},
                {"octomap_occupied_leaves", "OctoMap " + resolution + ", occupied leaf centres at 12 B"},
                {"voxel_cloud_1cm", "cloud of 1 cm voxels at 12 B"},
                {"raw_cloud", "raw clouds of all frames at 12 B a point"}};
    out +=
        "## Size\n\nThe planes' outlines explain **" + share_text(coverage.at("leaves_explained")) +
        "** of the OctoMap's occupied leaves, and **" + share_text(coverage.at("area_supported")) +
        "** of the outlines' area has an occupied leaf beside it. Every ratio below is at that coverage.\n\n"
        "| map of the same run | size | times the plane map's message |\n| --- | ---: | ---: |\n";
    for (const auto& row : rows) {
        const Json& size = sizes.at(row.key);
        if (!size.is_number()) {
            out += "| " + row.name + " | not measured | |\n";
            continue;
        }
        const double value = size.get<double>();
        out += "| " + row.name + " | " + bytes_text(value) + " | " +
               (message > 0 ? format(value / message < 10 ? "%.2f" : "%.0f", value / message) : "") + " |\n";
    }
}

void add_times(const Json& report, std::string& out) {
    out += "\n## Time\n\n| stage | median ms | p95 ms | times |\n| --- | ---: | ---: | ---: |\n";
    for (const auto& [stage, figures] : report.at("stages_ms").items()) {
        const double count = figures.at("count").get<double>();
        out += "| " + stage + " | ";
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
    const auto number = [&](const char* key) { return format("%.0f", report.at(key).get<double>()); };
    out += number("frames") + " frames: " + number("tracked") + " tracked, " + number("lost") + " lost, " +
           number("broken") + " broken. " + number("keyframes") + " keyframes, " + number("loop_closures") +
           " loop closures, " + number("planes") + " planes.\n\n";
    if (report.contains("accuracy")) {
        const Json& accuracy = report.at("accuracy");
        out += "Against the truth beside the input: ATE " +
               format("%.4f m", accuracy.at("ate_rmse_m").get<double>()) + ", RPE per frame " +
               format("%.2f mm", 1000 * accuracy.at("rpe_frame_rmse_m").get<double>()) + " and " +
               format("%.3f deg", accuracy.at("rpe_frame_rmse_deg").get<double>()) + " (RMSE).\n\n";
    }
}

}  // namespace

std::string report_markdown(const Json& report) {
    try {
        std::string out = "# planemap: " + report.at("input").get<std::string>() + "\n\n";
        add_tracking(report, out);
        out += losses_markdown(report);
        add_sizes(report, out);
        add_times(report, out);
        return out;
    } catch (const Json::exception& error) {
        throw std::runtime_error(std::string("not a planemap report: ") + error.what());
    }
}

}  // namespace planemap
