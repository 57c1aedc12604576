// SPDX-License-Identifier: BSD-3-Clause
// planemap-export: a stored map to all that planemap-run makes of one.
#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>

#include "core/standard_output.hpp"
#include "export/export.hpp"
#include "export/formats.hpp"
#include "messages/camera_flag.hpp"
#include "messages/process.hpp"
#include "run/run_info.hpp"

namespace planemap {
namespace {

struct Arguments {
    ExportOptions options;
    std::string map, formats;
    messages::CameraFlag camera;
    bool quiet = false;
};

void add_flags(messages::Flags& flags, Arguments& arguments) {
    ExportOptions& options = arguments.options;
    flags.add_positional(
        "map", arguments.map,
        "plane_map.lcmlog, or a log with PLANEMAP_MAP recorded, of which the last map counts");
    flags.add("o,output", options.output,
              "Folder for the results; made if it is not there; may be the map's own");
    flags.add("format", arguments.formats,
              "Only these files, separated by commas: " + export_format_names() +
                  ". Default: all but gpkg; clouds only with --cloud");
    flags.add("trajectory", options.trajectory,
              "Trajectory for report, drawings and clouds, in the map's world frame (default: trajectory.txt "
              "beside "
              "the map, where there is one)");
    flags.add(
        "cloud", options.recording,
        std::string("Recording that the map is of, for cloud-ply and cloud-pcd, its readings coloured by the "
                    "planes that explain them: ") +
            sensor::kInputs);
    arguments.camera.add_to(
        flags, "camera.json for a recording that does not describe its camera, or instead of what it says");
    flags.add("channel", options.source.channel,
              "Of a log that is the recording: the channel of the frames; default: the first that has depth");
    flags.add(options_of(options.cloud), "cloud-");
    flags.add("database", options.database,
              "Database to put planes and lines into as tables, as GDAL names it, e.g. \"PG:dbname=maps\"; "
              "--output is then not needed");
    flags.add("replace", options.replace,
              "Replace results in the folder that are not an earlier export's, and tables in the database");
    flags.add("q,quiet", arguments.quiet, "No report on standard output");
}

int run(Arguments arguments, const nlohmann::ordered_json& about) {
    ExportOptions& options = arguments.options;
    options.map = arguments.map;
    options.formats = parse_formats(arguments.formats);
    options.source.camera = arguments.camera.read();
    const Exported exported = export_map(options, about);
    for (const std::string& remark : exported.remarks) spdlog::warn("{}", remark);
    if (arguments.quiet || exported.files.empty()) return 0;
    std::string line = (exported.report.empty() ? "In " : "\nIn ") + options.output.string() + ":";
    for (const std::string& file : exported.files) line += " " + file;
    print(exported.report + line + "\n");
    return 0;
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    planemap::messages::Flags flags(
        "planemap-export",
        "A stored map to the files that planemap-run makes of its own: planes.json, PLY, OBJ, glTF, GeoJSON, "
        "drawings, and a\n"
        "report of what is known; to clouds of a recording coloured by plane, a GeoPackage, or a database. "
        "What only "
        "the run knew\n"
        "(which keyframes saw a plane, times, tracking) is said to be unknown.\n"
        "Example: planemap-export out/launch/plane_map.lcmlog --output out/launch");
    planemap::Arguments arguments;
    planemap::add_flags(flags, arguments);
    const int parsed = flags.parse(argc, argv);
    if (parsed >= 0) return parsed;
    const nlohmann::ordered_json about = planemap::run_info(flags);
    planemap::messages::start_logging("planemap-export", false);
    if (!arguments.options.recording.empty()) planemap::messages::catch_stop_signals();
    return planemap::messages::run_main("planemap-export", [&] { return planemap::run(arguments, about); });
}
