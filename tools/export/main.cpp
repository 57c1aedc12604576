// SPDX-License-Identifier: BSD-3-Clause
// planemap-export: a stored map to all that planemap-run makes of one.
#include <spdlog/spdlog.h>

#include <nlohmann/json.hpp>

#include "core/standard_output.hpp"
#include "export/export.hpp"
#include "messages/process.hpp"
#include "run/run_info.hpp"

int main(int argc, char** argv) {
    planemap::messages::Flags flags(
        "planemap-export",
        "A stored map to the files that planemap-run makes of its own: planes.json, PLY, OBJ, glTF, GeoJSON, "
        "drawings, and a\n"
        "report of what is known. What only the run knew (which keyframes saw a plane, times, tracking) is "
        "said to be unknown.\n"
        "Example: planemap-export out/launch/plane_map.lcmlog --output out/launch");
    planemap::ExportOptions options;
    bool quiet = false;
    std::string map;
    flags.add_positional(
        "map", map, "plane_map.lcmlog, or a log with PLANEMAP_MAP recorded, of which the last map counts");
    flags.add("o,output", options.output,
              "Folder for the results; made if it is not there; may be the map's own");
    flags.required();
    flags.add("trajectory", options.trajectory,
              "Trajectory for report and drawings, in the map's world frame (default: trajectory.txt beside "
              "the map, where there is one)");
    flags.add("replace", options.replace, "Replace results in the folder that are not an earlier export's");
    flags.add("q,quiet", quiet, "No report on standard output");
    const int parsed = flags.parse(argc, argv);
    if (parsed >= 0) return parsed;
    options.map = map;
    const nlohmann::ordered_json about = planemap::run_info(flags);
    planemap::messages::start_logging("planemap-export", false);
    return planemap::messages::run_main("planemap-export", [&] {
        const planemap::Exported exported = planemap::export_map(options, about);
        for (const std::string& remark : exported.remarks) spdlog::warn("{}", remark);
        if (quiet) return 0;
        std::string line = "\nIn " + options.output.string() + ":";
        for (const std::string& file : exported.files) line += " " + file;
        planemap::print(exported.report + line + "\n");
        return 0;
    });
}
