// SPDX-License-Identifier: BSD-3-Clause
#include "export/formats.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/nearest_name.hpp"
#include "core/text_file.hpp"

namespace planemap {

namespace {

/// Beginning and end of the names of a format's files: plane_map_2.lcmlog is of the second component.
struct FileNames {
    const char *format, *begin, *end;
};
constexpr FileNames kFileNames[] = {{"map", "plane_map", ".lcmlog"},  {"map", "trajectory", ".txt"},
                                    {"json", "planes", ".json"},      {"ply", "planes", ".ply"},
                                    {"obj", "planes", ".obj"},        {"obj", "planes", ".mtl"},
                                    {"gltf", "planes", ".glb"},       {"geojson", "floor_plan", ".geojson"},
                                    {"svg", "overhead", ".svg"},      {"svg", "map", ".svg"},
                                    {"report", "report", ""},         {"cloud-ply", kCloudPlyFile, ""},
                                    {"cloud-pcd", kCloudPcdFile, ""}, {"gpkg", kGeoPackageFile, ""}};

}  // namespace

const std::vector<ExportFormat>& export_formats() {
    static const std::vector<ExportFormat> formats{{"map", "plane_map.lcmlog, trajectory.txt"},
                                                   {"json", "planes.json"},
                                                   {"ply", "planes.ply"},
                                                   {"obj", "planes.obj, planes.mtl"},
                                                   {"gltf", "planes.glb"},
                                                   {"geojson", "floor_plan.geojson"},
                                                   {"svg", "overhead.svg, map.svg"},
                                                   {"report", "report.json, report.md, report.html"},
                                                   {"cloud-ply", kCloudPlyFile},
                                                   {"cloud-pcd", kCloudPcdFile},
                                                   {"gpkg", kGeoPackageFile}};
    return formats;
}

std::string export_format_names() {
    std::string names;
    for (const ExportFormat& format : export_formats())
        names += (names.empty() ? "" : ", ") + std::string(format.name);
    return names;
}

std::vector<std::string> parse_formats(const std::string& text) {
    std::vector<std::string> known, formats;
    for (const ExportFormat& format : export_formats()) known.emplace_back(format.name);
    for (std::size_t at = 0; !text.empty() && at <= text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size());
        const std::string name = text.substr(at, end - at);
        at = end + 1;
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            const std::string nearest = nearest_name(name, known);
            throw std::invalid_argument("--format: \"" + shown_text(name) + "\" is no format" +
                                        (nearest.empty() ? "; there are " + export_format_names()
                                                         : ", did you mean " + nearest + "?"));
        }
        if (std::find(formats.begin(), formats.end(), name) != formats.end())
            throw std::invalid_argument("--format: " + name + " is given twice");
        formats.push_back(name);
    }
    return formats;
}

std::string format_of(std::string_view file) {
    for (const FileNames& names : kFileNames)
        if (file.starts_with(names.begin) && file.ends_with(names.end)) return names.format;
    return {};
}

}  // namespace planemap
