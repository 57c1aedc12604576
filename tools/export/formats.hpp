// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace planemap {

/// What planemap-export writes, by the names of --format.
struct ExportFormat {
    const char* name;
    const char* files;  ///< as a user finds them
};
const std::vector<ExportFormat>& export_formats();

/// "ply, obj, ...": all of them.
std::string export_format_names();

/// Reads "ply,obj". Throws std::invalid_argument, one line, for a name that is none, with the nearest that
/// is, and for one that stands twice; an empty text gives none.
std::vector<std::string> parse_formats(const std::string& text);

/// The format that a result in the folder is of, by its file's name; empty for none.
std::string format_of(std::string_view file);

inline constexpr const char* kGeoPackageFile = "planes.gpkg";
inline constexpr const char* kCloudPlyFile = "cloud.ply";
inline constexpr const char* kCloudPcdFile = "cloud.pcd";

}  // namespace planemap
