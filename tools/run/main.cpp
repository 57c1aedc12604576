// SPDX-License-Identifier: BSD-3-Clause
// planemap-run: a recording to a plane map, all modules in one process.
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "run/input.hpp"
#include "run/outputs.hpp"
#include "run/pipeline.hpp"
#include "run/progress.hpp"
#include "run/report.hpp"
#include "sensor/camera_file.hpp"

namespace planemap {
namespace {

struct RunOptions {
    std::string input;
    std::filesystem::path output, camera, poses;
    bool no_octomap = false, quiet = false, verbose = false;
    std::optional<std::uint64_t> seed;
    PipelineOptions pipeline;
};

void add_run_flags(Flags& flags, RunOptions& options) {
    flags.add_positional(
        "input", options.input,
        "TUM-layout folder (rgb.txt, depth.txt, camera.json), LCM log, or sim:office[?frames=N&seed=N...]");
    flags.add("o,output", options.output, "Folder for the results; made if it is not there");
    flags.required();
    flags.add("camera", options.camera, "camera.json for a log that does not describe its camera");
    flags.add(
        "poses", options.poses,
        "Trajectory (TUM format, of the colour camera) that keyframes take their poses from, instead of the "
        "graph's; e.g. groundtruth.txt");
    flags.add("map", options.pipeline.map.start,
              "plane_map.lcmlog to start from: its planes keep their ids and grow on. It must be in the "
              "world frame "
              "of this run: with --poses theirs, else the first camera's");
    flags.add("seed", options.seed, "Of everything random; the same seed gives the same bytes out");
    flags.add("no-octomap", options.no_octomap, "Do not build the OctoMap to compare with");
    flags.add("q,quiet", options.quiet, "No progress lines");
    flags.add("v,verbose", options.verbose, "Log more");
    add_flags(flags, options.pipeline.segmentation, "segmentation-");
    add_flags(flags, options.pipeline.odometry, "odometry-");
    add_flags(flags, options.pipeline.graph, "graph-");
    add_flags(flags, options.pipeline.map.map, "map-");
    add_flags(flags, options.pipeline.octomap, "octomap-");
}

/// The output folder, made and tried, so that a run of an hour does not end in an error that could be seen at
/// the start.
void prepare_output(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw std::runtime_error(folder.string() + ": cannot be made: " + error.message());
    if (::access(folder.c_str(), W_OK | X_OK) != 0 || !std::filesystem::is_directory(folder)) {
        throw std::runtime_error(folder.string() + ": is no folder that can be written to");
    }
}

int run(RunOptions options) {
    if (options.seed) options.pipeline.segmentation.seed = options.pipeline.odometry.seed = *options.seed;
    options.pipeline.with_octomap = !options.no_octomap;
    if (!options.camera.empty()) options.pipeline.camera = read_camera_file(options.camera);
    if (!options.poses.empty()) options.pipeline.poses = read_trajectory(options.poses);
    catch_stop_signals();

    Bus bus("memq://");
    Pipeline pipeline(bus, options.pipeline);
    const std::unique_ptr<Input> input = open_input(options.input, bus, options.pipeline.camera);
    prepare_output(options.output);

    RunClock clock;
    Progress progress(options.quiet);
    while (!stop_requested() && input->feed()) {
        pipeline.settle();
        progress.show(*input, pipeline);
    }
    pipeline.finish();
    clock.stop();
    progress.end();
    if (stop_requested())
        spdlog::warn("stopped after {} frames; what was mapped so far is written", input->frames());
    if (const GivenPoses* given = pipeline.given_poses(); given != nullptr && given->missing() > 0) {
        spdlog::warn("{}: no pose within 0.1 s of {} keyframes, which are not in the map",
                     options.poses.string(), given->missing());
    }
    if (!input->complaints().empty()) spdlog::warn("{}", input->complaints());

    const nlohmann::ordered_json report =
        write_outputs(options.output, options.input, *input, pipeline, clock);
    std::fputs(report_markdown(report).c_str(), stdout);
    std::printf(
        "\nIn %s: trajectory.txt planes.json planes.ply planes.obj planes.mtl planes.glb "
        "floor_plan.geojson plane_map.lcmlog%s map.svg overhead.svg report.json report.md\n",
        options.output.c_str(), pipeline.octomap() != nullptr ? " octomap.bt" : "");
    if (pipeline.estimates().empty())
        throw std::runtime_error(options.input + ": no frame of it could be used");
    if (report.at("tracked") == 0) {
        throw std::runtime_error(options.input + ": none of its " + std::to_string(input->frames()) +
                                 " frames could be tracked: " + pipeline.why_lost());
    }
    return 0;
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    planemap::Flags flags(
        "planemap-run",
        "A recording to a plane map: runs all modules in one process, as fast as the machine allows, and "
        "writes the\n"
        "trajectory, the map (JSON, PLY, OBJ, glTF, GeoJSON, SVG, LCM), an OctoMap of the same depth and "
        "poses, and a report of what each takes.\n"
        "Example: planemap-run sim:office --output out/office");
    planemap::RunOptions options;
    planemap::add_run_flags(flags, options);
    const int parsed = flags.parse(argc, argv);
    if (parsed >= 0) return parsed;
    planemap::start_logging("planemap-run", options.verbose);
    return planemap::run_main("planemap-run", [&] { return planemap::run(options); });
}
