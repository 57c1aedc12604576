// SPDX-License-Identifier: BSD-3-Clause
#include "run/stored_map.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "run/map_results.hpp"
#include "run/size_report.hpp"
#include "run/size_rows.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

/// The OctoMap of the same session, where it lies beside the map.
void add_octomap_beside(const std::filesystem::path& map_file, const PlaneMap& map,
                        std::vector<std::string>& warnings, Json& report) {
    const std::filesystem::path beside = map_file.parent_path() / kOctomapFile;
    std::error_code ignored;
    if (!std::filesystem::exists(beside, ignored)) return;
    try {
        add_stored_octomap(beside, map, report);
    } catch (const std::runtime_error& error) {
        warnings.push_back(std::string(error.what()) + ": there is nothing to compare the map's size with");
    }
}

}  // namespace

Json stored_map_report(const std::filesystem::path& map_file, const PlaneMap& map,
                       const Trajectory* trajectory) {
    std::vector<std::string> warnings;
    if (map.planes.empty()) warnings.push_back(map_file.string() + ": its map has no planes");
    Json report;
    report["input"] = map_file.string();
    report["exported"] = true;
    report["frames"] = nullptr;
    report["tracked"] = trajectory == nullptr ? Json() : Json(trajectory->size());
    for (const char* key : {"lost", "broken", "interrupted", "keyframes", "loop_closures"})
        report[key] = nullptr;
    report["planes"] = map.planes.size();
    for (const char* key : {"wall_s", "cpu_s", "peak_rss_mb", "stages_ms", "frames_per_s_without_octomap"})
        report[key] = nullptr;
    report["complaints"] = Json::array();
    add_map_sizes(map, report);
    add_octomap_beside(map_file, map, warnings, report);
    for (const char* key : {"accuracy_beside_size", "growth"}) report[key] = nullptr;
    report["headline"] = headline_of(report);
    report["warnings"] = warnings;
    return report;
}

}  // namespace planemap
