// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace planemap {

struct ExportOptions {
    std::filesystem::path map;         ///< plane_map.lcmlog, or any log with a map in it: the last one counts
    std::filesystem::path output;      ///< folder of the results; may be the map's own
    std::filesystem::path trajectory;  ///< empty: trajectory.txt beside the map, where there is one
    bool replace = false;              ///< also results that are not an earlier export's
};

struct Exported {
    std::string report;                ///< report.md
    std::vector<std::string> files;    ///< names in the folder
    std::vector<std::string> remarks;  ///< what the user should know, a line each
};

/// Writes what follows from a map, and from those of further components beside it, into the folder, all
/// together, in place of an earlier export's. `about` is run_info(). Throws std::runtime_error with one line
/// naming file and reason: no map can be read, the folder holds others' results, or a file cannot be written;
/// what is in the folder is then untouched.
Exported export_map(const ExportOptions& options, const nlohmann::ordered_json& about);

}  // namespace planemap
