// SPDX-License-Identifier: BSD-3-Clause
// What planemap-report is asked about: the folder of a run, or a log with a map in it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/plane_map.hpp"
#include "report_page/page.hpp"

namespace planemap {

struct Subject {
    std::filesystem::path path;
    nlohmann::ordered_json report;
    bool is_folder = false;

    /// The map itself; nothing if a folder holds none. Throws std::runtime_error naming the file if it cannot
    /// be read.
    std::optional<PlaneMap> map() const;
    /// Empty if it is not known.
    Trajectory trajectory() const;
    PageSource page_source() const;
    /// report.html in the folder, or beside the log under its name.
    std::filesystem::path page_file() const;
};

/// A folder gives its report.json; a log the last map in it, of which a report is made that says what a map
/// tells, with the trajectory.txt and octomap.bt beside it. Throws std::runtime_error or
/// std::invalid_argument with one line that names the file and the reason.
Subject read_subject(const std::filesystem::path& path);

}  // namespace planemap
