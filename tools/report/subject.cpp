// SPDX-License-Identifier: BSD-3-Clause
#include "report/subject.hpp"

#include "exports/exports.hpp"
#include "map/map_file.hpp"
#include "run/report.hpp"
#include "run/stored_map.hpp"

namespace planemap {

namespace fs = std::filesystem;

namespace {

bool is_there(const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
}

/// Beside the log, or in the folder.
fs::path beside(const Subject& subject, const char* name) {
    return (subject.is_folder ? subject.path : subject.path.parent_path()) / name;
}

}  // namespace

std::optional<PlaneMap> Subject::map() const {
    const fs::path file = is_folder ? path / "plane_map.lcmlog" : path;
    if (!is_there(file)) return std::nullopt;
    return map::read_plane_map(file);
}

Trajectory Subject::trajectory() const {
    const fs::path file = beside(*this, "trajectory.txt");
    return is_there(file) ? read_trajectory(file) : Trajectory();
}

PageSource Subject::page_source() const {
    if (is_folder) return page_source_of(path, report);
    PageSource source;
    source.report = report;
    source.planes = nlohmann::ordered_json::parse(exports::planes_json(map::read_plane_map(path)));
    source.read_trajectory(beside(*this, "trajectory.txt"));
    source.read_points(beside(*this, "points.ply"));
    return source;
}

fs::path Subject::page_file() const {
    if (is_folder) return path / "report.html";
    fs::path file = path;
    return file.replace_extension(".html");
}

Subject read_subject(const fs::path& path) {
    std::error_code ignored;
    Subject subject;
    subject.path = path;
    subject.is_folder = !fs::is_regular_file(path, ignored);
    if (subject.is_folder) {
        subject.report = read_report(path);
        return subject;
    }
    const PlaneMap map = map::read_plane_map(path);
    const fs::path file = beside(subject, "trajectory.txt");
    const std::optional<Trajectory> trajectory =
        is_there(file) ? std::optional(read_trajectory(file)) : std::nullopt;
    subject.report = stored_map_report(path, map, trajectory ? &*trajectory : nullptr);
    return subject;
}

}  // namespace planemap
