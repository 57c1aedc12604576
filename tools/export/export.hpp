// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "export/cloud.hpp"

namespace planemap {

struct ExportOptions {
    std::filesystem::path map;  ///< plane_map.lcmlog, or any log with a map in it: the last one counts
    std::filesystem::path
        output;  ///< folder of the results; may be the map's own; empty: none, only a database
    std::filesystem::path trajectory;  ///< empty: trajectory.txt beside the map, where there is one
    bool replace = false;              ///< also results that are not an earlier export's
    std::vector<std::string> formats;  ///< parse_formats(); none: all but gpkg, clouds only with a recording
    std::string recording;             ///< of the map, for the clouds; empty: none
    sensor::SourceOptions source;      ///< how it is read
    CloudOptions cloud;
    std::string database;  ///< as GDAL names it, to put the map into; empty: none

    /// Throws std::invalid_argument that names what is missing or in vain.
    void validate() const;
};

struct Exported {
    std::string report;                ///< report.md; empty where it was not asked for
    std::vector<std::string> files;    ///< names in the folder
    std::vector<std::string> remarks;  ///< what the user should know, a line each
};

/// Writes what follows from a map, and from those of further components beside it, into the folder, all
/// together, in place of an earlier export's; with formats only these, and nothing else there is touched.
/// `about` is run_info(). Throws std::runtime_error with one line naming file and reason: no map can be read,
/// the folder holds others' results, or a file cannot be written; what is in the folder is then untouched.
Exported export_map(const ExportOptions& options, const nlohmann::ordered_json& about);

}  // namespace planemap
