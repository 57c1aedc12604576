// SPDX-License-Identifier: BSD-3-Clause
#include "run/map_results.hpp"

#include <nlohmann/json.hpp>

#include "core/components.hpp"
#include "core/files.hpp"
#include "map/map_file.hpp"
#include "report_page/page.hpp"
#include "run/report.hpp"

namespace planemap {

namespace {

Result text_result(const std::string& name, std::function<std::string()> bytes) {
    return {name, [bytes = std::move(bytes)](const auto& file) { write_file(file, bytes()); }};
}

}  // namespace

std::vector<Result> essential_results(const MapSource& source, std::size_t number) {
    const std::shared_ptr<const PlaneMap> map = source.map;
    std::vector<Result> results{
        {component_file("plane_map.lcmlog", number), [map, seen = source.seen](const auto& file) {
             map::write_plane_map(file, *map, seen ? seen() : SeenSpace());
         }}};
    if (source.trajectory) {
        results.push_back(
            {component_file("trajectory.txt", number),
             [trajectory = source.trajectory](const auto& file) { write_trajectory(file, trajectory()); }});
    }
    results.push_back(text_result(component_file("planes.json", number), [map, sightings = source.sightings] {
        return exports::planes_json(*map, sightings());
    }));
    return results;
}

std::vector<Result> drawn_results(const MapSource& source) {
    const std::shared_ptr<const PlaneMap> map = source.map;
    const auto of_trajectory = [&](const char* name, auto function) {
        return text_result(name, [map, trajectory = source.trajectory, function] {
            return function(*map, trajectory ? trajectory() : Trajectory());
        });
    };
    return {
        of_trajectory("planes.ply", exports::planes_ply),
        of_trajectory("planes.obj", [](const auto& m, const auto& t) { return exports::planes_obj(m, t); }),
        text_result("planes.mtl", [map] { return exports::planes_mtl(*map); }),
        of_trajectory("planes.glb", exports::planes_glb),
        of_trajectory("floor_plan.geojson", exports::floor_plan_geojson),
        of_trajectory("overhead.svg", exports::overhead_svg),
        of_trajectory("map.svg", exports::perspective_svg)};
}

std::vector<Result> report_results(const nlohmann::ordered_json& report) {
    if (report.is_null()) return {};
    return {text_result("report.json",
                        [&report] {
                            return report.dump(2, ' ', false,
                                               nlohmann::ordered_json::error_handler_t::replace) +
                                   "\n";
                        }),
            text_result("report.md", [&report] { return report_markdown(report); })};
}

std::vector<Result> page_results(const MapSource& source, const nlohmann::ordered_json& report,
                                 const std::filesystem::path& points_file) {
    const auto page = [map = source.map, trajectory = source.trajectory, &report, points_file] {
        PageSource shown;
        shown.report = report;
        shown.planes = nlohmann::ordered_json::parse(exports::planes_json(*map));
        if (trajectory) shown.trajectory = trajectory();
        shown.read_points(points_file);
        return report_page(shown);
    };
    return {text_result("report.html", page)};
}

std::vector<std::string> map_result_names() {
    std::vector<std::string> names{"plane_map.lcmlog", "trajectory.txt", "planes.json",        "report.json",
                                   "report.md",        "report.html",    "planes.ply",         "planes.obj",
                                   "planes.mtl",       "planes.glb",     "floor_plan.geojson", "overhead.svg",
                                   "map.svg"};
    for (std::size_t number = 2; number <= kMostComponentFiles; ++number)
        for (const char* name : {"plane_map.lcmlog", "trajectory.txt", "planes.json"})
            names.push_back(component_file(name, number));
    return names;
}

}  // namespace planemap
