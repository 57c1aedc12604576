// SPDX-License-Identifier: BSD-3-Clause
// The results that follow from a map, whether a run has it in memory or a file holds it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/plane_map.hpp"
#include "core/seen_space.hpp"
#include "core/trajectory.hpp"
#include "exports/exports.hpp"
#include "results/result_folder.hpp"

namespace planemap {

/// The map of one component and what is known beside it.
struct MapSource {
    std::shared_ptr<const PlaneMap> map;
    std::function<Trajectory()> trajectory;  ///< asked when a file needs it; empty: not known
    std::function<std::optional<exports::Sightings>()> sightings;
    std::function<SeenSpace()> seen = {};  ///< what was seen to be empty; empty: not known
};

/// What nobody wants to lose, small: plane_map.lcmlog, trajectory.txt where it is known, planes.json.
/// Of a component after the first their names bear its number (component_file()).
std::vector<Result> essential_results(const MapSource& source, std::size_t number = 1);

/// What can be had from the essential results: planes.ply, .obj, .mtl and .glb, the floor plan, the drawings.
std::vector<Result> drawn_results(const MapSource& source);

/// report.json and report.md; nothing if the report is null.
std::vector<Result> report_results(const nlohmann::ordered_json& report);

/// report.html, which shows them all, with the points.ply that is beside them, if it is there; the report may
/// be null: not known.
std::vector<Result> page_results(const MapSource& source, const nlohmann::ordered_json& report,
                                 const std::filesystem::path& points_file);

/// What else stands beside a map that a run made: of its depth.
inline constexpr char kOctomapFile[] = "octomap.bt", kPointsFile[] = "points.ply";

/// The names of what follows from a map, of as many components as can be.
std::vector<std::string> map_result_names();

}  // namespace planemap
