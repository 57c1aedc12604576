// SPDX-License-Identifier: BSD-3-Clause
#include "export/export.hpp"

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/components.hpp"
#include "core/files.hpp"
#include "export/formats.hpp"
#include "export/gis.hpp"
#include "exports/parts.hpp"
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

bool is_among(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Whether a format is to be written; `by_default`: if no format was asked for.
bool wants(const ExportOptions& options, const char* format, bool by_default) {
    return options.formats.empty() ? by_default : is_among(options.formats, format);
}
bool wants_cloud(const ExportOptions& options, const char* format) {
    return wants(options, format, !options.recording.empty());
}

/// The names in the output folder that may be the export's. What it is made from stays as it is; in a folder
/// of its own nothing may stand beside it that is of another map.
std::vector<std::string> possible_names(const ExportOptions& options, const fs::path& trajectory) {
    std::vector<std::string> names = map_result_names();
    if (!same_file(options.map, options.output / "plane_map.lcmlog")) {
        for (const char* name : {kOctomapFile, kPointsFile, kCloudPlyFile, kCloudPcdFile, kGeoPackageFile})
            names.emplace_back(name);
        return names;
    }
    if (wants_cloud(options, "cloud-ply")) names.emplace_back(kCloudPlyFile);
    if (wants_cloud(options, "cloud-pcd")) names.emplace_back(kCloudPcdFile);
    if (wants(options, "gpkg", false)) names.emplace_back(kGeoPackageFile);
    const bool keeps_trajectory =
        trajectory.empty() || same_file(trajectory, options.output / "trajectory.txt");
    for (std::size_t number = 1; number <= kMostComponentFiles; ++number) {
        std::erase(names, component_file("plane_map.lcmlog", number));
        if (keeps_trajectory || number > 1) std::erase(names, component_file("trajectory.txt", number));
    }
    return names;
}

/// Of these, those that were asked for.
std::vector<std::string> export_names(const ExportOptions& options, const fs::path& trajectory) {
    std::vector<std::string> names = possible_names(options, trajectory);
    if (options.formats.empty()) return names;
    std::erase_if(names,
                  [&](const std::string& name) { return !is_among(options.formats, format_of(name)); });
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
                         [] { return std::nullopt; }, [file] { return map::read_seen_space(file); }};
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
            throw std::runtime_error((options.output / name).string() +
                                     ": is there, and no report.json beside it says that an export made it: "
                                     "give another --output, "
                                     "or --replace");
        }
    }
}

/// cloud.ply, which stands as planes.ply does, and cloud.pcd, in the world frame.
std::vector<Result> cloud_results(const ExportOptions& options, const MapSource& source, Exported& exported) {
    std::vector<Result> results;
    const bool ply = wants_cloud(options, "cloud-ply"), pcd = wants_cloud(options, "cloud-pcd");
    if (!ply && !pcd) return results;
    if (!source.trajectory)
        throw std::runtime_error(options.map.string() +
                                 ": has no trajectory.txt beside it, which says where the recording's frames "
                                 "were: give --trajectory");
    const Trajectory trajectory = source.trajectory();
    const auto cloud = std::make_shared<const Cloud>(
        cloud_of(options.recording, options.source, options.cloud, *source.map, trajectory));
    exported.remarks.insert(exported.remarks.end(), cloud->remarks.begin(), cloud->remarks.end());
    if (pcd) {
        results.push_back({kCloudPcdFile, [cloud](const auto& file) {
                               write_file(
                                   file, exports::points_pcd(cloud->points, "planemap: world frame, metres"));
                           }});
    }
    if (ply) {
        const exports::UprightFrame frame = exports::upright_frame(*source.map, trajectory);
        results.push_back({kCloudPlyFile, [cloud, frame](const auto& file) {
                               std::string comment = "planemap: readings by plane";
                               for (const std::string& note : frame.notes(frame.level_from_world, 'z'))
                                   comment += "\ncomment " + note;
                               std::vector<CloudPoint> points = cloud->points;
                               const Eigen::Matrix3f level = frame.level_from_world.cast<float>();
                               for (CloudPoint& point : points) point.position = level * point.position;
                               write_file(file, exports::points_ply(points, comment));
                           }});
    }
    return results;
}

/// All results that were asked for, in the order in which they are made.
std::vector<Result> results_of(const ExportOptions& options, const MapSource& source, const Json& report,
                               const std::vector<std::string>& names, Exported& exported) {
    std::vector<Result> results = essential_results(source);
    for (const auto& more : {further_components(options), report_results(report), drawn_results(source),
                             page_results(source, report, options.map.parent_path() / kPointsFile),
                             cloud_results(options, source, exported)})
        results.insert(results.end(), more.begin(), more.end());
    if (wants(options, "gpkg", false)) {
        results.push_back({kGeoPackageFile, [&source](const auto& file) {
                               write_geopackage(file, *source.map,
                                                source.trajectory ? source.trajectory() : Trajectory());
                           }});
    }
    std::erase_if(results, [&](const Result& result) { return !is_among(names, result.name); });
    return results;
}

/// Makes the results and puts them in place.
void write_folder(const ExportOptions& options, const MapSource& source, const Json& report,
                  const std::vector<std::string>& names, Exported& exported) {
    require_ours(options, names);
    ResultFolder folder(options.output, names);
    try {
        for (const Result& result : results_of(options, source, report, names, exported)) {
            folder.make(result);
            exported.files.push_back(result.name);
        }
        folder.replace();
    } catch (const std::exception&) {
        folder.discard();
        throw;
    }
    for (const std::string& note : folder.take_notes()) exported.remarks.push_back(note);
}

}  // namespace

void ExportOptions::validate() const {
    if (output.empty() && database.empty())
        throw std::invalid_argument("--output is required, a folder for the results, or a --database");
    if (output.empty() && !formats.empty())
        throw std::invalid_argument("--format: names files, and there is no --output for them");
    const bool clouds = is_among(formats, "cloud-ply") || is_among(formats, "cloud-pcd");
    if (clouds && recording.empty())
        throw std::invalid_argument("--format: a cloud is of a recording's readings: give --cloud");
    if (!recording.empty() && !clouds && (!formats.empty() || output.empty()))
        throw std::invalid_argument(
            "--cloud: is in vain, as neither cloud-ply nor cloud-pcd is to be written");
    cloud.validate();
    if (!database.empty() || is_among(formats, "gpkg")) require_gis();
}

Exported export_map(const ExportOptions& options, const Json& about) {
    options.validate();
    Exported exported;
    MapSource source{std::make_shared<const PlaneMap>(map::read_plane_map(options.map)), nullptr,
                     [] { return std::nullopt; }, [&options] { return map::read_seen_space(options.map); }};
    const fs::path file = trajectory_file(options);
    Trajectory trajectory;
    if (!file.empty()) {
        trajectory = read_trajectory(file, &exported.remarks);
        source.trajectory = [&trajectory] { return trajectory; };
    }
    std::vector<std::string> warnings;
    if (source.map->planes.empty()) warnings.push_back(options.map.string() + ": its map has no planes");
    const std::vector<std::string> names = export_names(options, file);
    if (!options.output.empty()) {
        Json report;
        if (wants(options, "report", true)) {
            report = stored_map_report(options.map, *source.map, file.empty() ? nullptr : &trajectory);
            warnings = report.at("warnings").get<std::vector<std::string>>();
            report.update(about);
            exported.report = report_markdown(report);
        }
        write_folder(options, source, report, names, exported);
    }
    if (!options.database.empty())
        write_to_database(options.database, *source.map, trajectory, options.replace);
    exported.remarks.insert(exported.remarks.begin(), warnings.begin(), warnings.end());
    return exported;
}

}  // namespace planemap
