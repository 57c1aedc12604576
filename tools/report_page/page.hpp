// SPDX-License-Identifier: BSD-3-Clause
// report.html: one file that shows a map and what it takes, and opens without a network.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/trajectory.hpp"
#include "report_page/point_file.hpp"

namespace planemap {

/// What the page shows. What is not known is null or empty; the page then says so.
// nlohmann::json's moves are noexcept, though what they call in debug builds is not.
// NOLINTNEXTLINE(bugprone-exception-escape)
struct PageSource {
    nlohmann::ordered_json report;                  ///< report.json
    nlohmann::ordered_json planes;                  ///< planes.json
    Trajectory trajectory;                          ///< world_from_camera
    std::optional<std::vector<CloudPoint>> points;  ///< points.ply
    std::vector<std::string> notes;                 ///< what could not be read, a line each

    /// From files; what is not there is not known, what is there and cannot be read becomes a note.
    void read_planes(const std::filesystem::path& file);
    void read_trajectory(const std::filesystem::path& file);
    void read_points(const std::filesystem::path& file);
};

/// Of the output folder of a planemap-run or planemap-export: planes.json, trajectory.txt and points.ply
/// beside its report.json, which is given.
PageSource page_source_of(const std::filesystem::path& folder, nlohmann::ordered_json report);

/// The page. Text of the source cannot break out of the JSON that it is embedded as. Positions of points are
/// rounded to 1/65535 of the points' extent; at most 80,000 points and 5,000 poses, evenly taken. The same
/// source gives the same bytes.
std::string report_page(const PageSource& source);

}  // namespace planemap
