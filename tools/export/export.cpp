// SPDX-License-Identifier: BSD-3-Clause
#include "export/export.hpp"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/components.hpp"
#include "core/files.hpp"
#include "map/map_file.hpp"
#include "run/map_results.hpp"
#include "run/report.hpp"
#include "run/stored_map.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Both there, and one file.
bool same_file(const fs::path& a, const fs::path& b) {
    std::error_code error;
    return fs::equivalent(a, b, error) && !error;
}

/// The trajectory's file; empty if there is none.
fs::path trajectory_file(const ExportOptions& options) {
    if (!options.trajectory.empty()) return options.trajectory;
    const fs::path beside = options.map.parent_path() / "trajectory.txt";
    std::error_code ignored;
    return fs::exists(beside, ignored) ? beside : fs::path();
}

/// The names in the output folder that are the export's. What it is made from stays as it is; in a folder of
/// its own nothing may stand beside it that is of another map.
std::vector<std::string> export_names(const ExportOptions& options, const fs::path& trajectory) {
    std::vector<std::string> names = map_result_names();
    if (!same_file(options.map, options.output / "plane_map.lcmlog")) {
        for (const char* name : {kOctomapFile, kPointsFile}) names.emplace_back(name);
        return names;
    }
    const bool keeps_trajectory =
        trajectory.empty() || same_file(trajectory, options.output / "trajectory.txt");
    for (std::size_t number = 1; number <= kMostComponentFiles; ++number) {
        std::erase(names, component_file("plane_map.lcmlog", number));
        if (keeps_trajectory || number > 1) std::erase(names, component_file("trajectory.txt", number));
    }
    return names;
}

/// What can be had of the maps of further components, where they lie beside the map.
std::vector<Result> further_components(const ExportOptions& options) {
    std::vector<Result> results;
    for (std::size_t number = 2; number <= kMostComponentFiles; ++number) {
        const fs::path file =
            options.map.parent_path() / component_file(options.map.filename().string(), number);
        std::error_code ignored;
        if (!fs::exists(file, ignored)) break;
        MapSource source{std::make_shared<const PlaneMap>(map::read_plane_map(file)), nullptr,
                         [] { return std::nullopt; }};
        for (Result& result : essential_results(source, number)) results.push_back(std::move(result));
    }
    return results;
}

bool holds_an_export(const fs::path& folder) {
    try {
        return read_report(folder).value("exported", false);
    } catch (const std::exception&) {
        return false;  // no report: then nothing there is known to be an export's
    }
}

/// Throws if results that say more, or are of another map, would be lost.
void require_ours(const ExportOptions& options, const std::vector<std::string>& names) {
    if (options.replace || holds_an_export(options.output)) return;
    std::error_code ignored;
    for (const std::string& name : names) {
        if (fs::exists(options.output / name, ignored)) {
            throw std::runtime_error(
                (options.output / name).string() +
                ": is there, and not of an earlier export: give another --output, or --replace");
        }
    }
}

}  // namespace

Exported export_map(const ExportOptions& options, const Json& about) {
    Exported exported;
    const PlaneMap map = map::read_plane_map(options.map);
    const fs::path file = trajectory_file(options);
    Trajectory trajectory;
    if (!file.empty()) trajectory = read_trajectory(file, &exported.remarks);
    const std::vector<std::string> names = export_names(options, file);
    require_ours(options, names);
    ResultFolder folder(options.output, names);

    MapSource source{std::make_shared<const PlaneMap>(map), nullptr, [] { return std::nullopt; }};
    if (!file.empty()) source.trajectory = [&trajectory] { return trajectory; };
    Json report = stored_map_report(options.map, map, file.empty() ? nullptr : &trajectory);
    const auto warnings = report.at("warnings").get<std::vector<std::string>>();
    report.update(about);
    std::vector<Result> results = essential_results(source);
    for (const auto& more : {further_components(options), report_results(report), drawn_results(source),
                             page_results(source, report, options.map.parent_path() / kPointsFile)})
        results.insert(results.end(), more.begin(), more.end());
    try {
        for (const Result& result : results) {
            if (std::find(names.begin(), names.end(), result.name) == names.end()) continue;
            folder.make(result);
            exported.files.push_back(result.name);
        }
        folder.replace();
    } catch (const std::exception&) {
        folder.discard();
        throw;
    }
    exported.report = report_markdown(report);
    for (const auto& more : {warnings, folder.take_notes()})
        exported.remarks.insert(exported.remarks.end(), more.begin(), more.end());
    return exported;
}

}  // namespace planemap
