// SPDX-License-Identifier: BSD-3-Clause
// planemap-run: a recording to a plane map, all modules in one process.
#include <spdlog/spdlog.h>

#include <cstdio>

#include "core/standard_output.hpp"
#include "core/trajectory_file.hpp"
#include "pipeline/pipeline.hpp"
#include "pipeline/preparation.hpp"
#include "run/depth_watch.hpp"
#include "run/growth.hpp"
#include "run/input.hpp"
#include "run/interim.hpp"
#include "run/outputs.hpp"
#include "run/progress.hpp"
#include "run/report.hpp"
#include "run/run_info.hpp"
#include "run/run_options.hpp"
#include "run/size_rows.hpp"

namespace planemap {
namespace {

/// Feeds the input to its end, or until a signal asks to stop. Returns the error that ended it early, if one
/// did: what was mapped until then is not lost.
std::string map(const RunOptions& options, Input& input, pipeline::Pipeline& pipeline, ResultFolder& folder,
                Growth& growth) {
    std::string error;
    Progress progress(options.quiet);
    InterimResults interim(folder);
    try {
        while (!messages::stop_requested() && input.feed()) {
            pipeline.settle();
            growth.watch();
            progress.show(input, pipeline);
            interim.write_if_due(pipeline);
        }
    } catch (const std::exception& failure) {
        error = failure.what();
    }
    progress.end();
    if (messages::stop_requested()) {
        spdlog::warn("stopped after {} frames: writing what was mapped so far (another Ctrl-C ends at once)",
                     input.frames());
    }
    spdlog::debug("kept what was mapped so far {} times: {:.1f} ms of CPU, {:.1f} ms by the clock",
                  interim.times(), interim.cpu_ms(), interim.wall_ms());
    pipeline.finish();
    return error;
}

/// What is wrong with the results, a line each; the last says what became of them.
std::vector<std::string> problems_of(const RunOptions& options, const Input& input,
                                     pipeline::Pipeline& pipeline, const ResultFolder& folder,
                                     const Outputs& outputs) {
    const std::string& input_name = options.input;
    const pipeline::GivenPoses* given = pipeline.given_poses();
    std::vector<std::string> lines = outputs.failures;
    const std::string earlier =
        outputs.kept_earlier ? "; " + folder.path().string() + " keeps the results of an earlier run" : "";
    const std::string aside = outputs.folder.empty() || outputs.folder == folder.path()
                                  ? ""
                                  : earlier + ", the new ones are in " + outputs.folder.string();
    if (pipeline.estimates().empty() && messages::stop_requested()) {
        lines.push_back("stopped before the first frame of " + input_name + " was mapped" + earlier);
    } else if (pipeline.estimates().empty()) {
        lines.push_back(input_name + ": no frame of it could be used" + earlier);
    } else if (given != nullptr && given->fit_nothing()) {
        lines.push_back(options.poses.string() + " covers " + span_text(given->poses()) + ", the input " +
                        span_text(pipeline.estimates().front().utime, pipeline.estimates().back().utime) +
                        ": no keyframe has a pose, and nothing is in the map" +
                        (aside.empty() ? earlier : aside));
    } else if (tracked_frames(pipeline) == 0) {
        lines.push_back(input_name + ": none of its " + std::to_string(input.frames()) +
                        " frames could be tracked: " + pipeline.why_lost() + earlier);
    } else if (!outputs.failures.empty()) {
        const std::string others =
            outputs.folder.empty() ? earlier : "; the others are in " + outputs.folder.string();
        const std::string failed = outputs.folder.empty() ? "none of the results could be put in place"
                                                          : std::to_string(outputs.failures.size()) +
                                                                " of the results could not be written";
        lines.push_back(failed + (aside.empty() ? others : aside));
    } else if (!aside.empty()) {
        lines.push_back(input_name + ": " + outputs.why_aside + aside);
    }
    return lines;
}

/// The report and where everything is, on standard output.
void print_report(const Outputs& outputs) {
    if (!outputs.report.is_null()) print(report_markdown(outputs.report));
    if (outputs.folder.empty()) return;
    std::string line = "\nIn " + outputs.folder.string() + ":";
    for (const std::string& file : outputs.files) line += " " + file;
    print(line + "\n");
}

void warn(const std::vector<std::string>& lines) {
    for (const std::string& line : lines) spdlog::warn("{}", line);
}

Trajectory read_given_poses(const std::filesystem::path& file) {
    std::vector<std::string> notes;
    Trajectory poses = read_trajectory(file, &notes);
    require_poses(file, poses);
    warn(notes);
    return poses;
}

int run(RunOptions options, const nlohmann::ordered_json& about) {
    if (options.seed) options.pipeline.segmentation.seed = options.pipeline.odometry.seed = *options.seed;
    options.pipeline.with_octomap = !options.no_octomap;
    options.pipeline.camera = options.camera.read();
    if (!options.poses.empty()) options.pipeline.poses = read_given_poses(options.poses);
    const int threads = rule_threads(options);
    options.source.camera = options.pipeline.camera;
    options.source.motion_channel = options.pipeline.odometry.motion.channel;
    if (!options.frames.empty()) options.source.frames = parse_frame_range(options.frames);
    const std::vector<double> size_resolutions_m = size_resolutions(options.size_resolutions);
    messages::catch_stop_signals();

    messages::Bus bus("memq://");
    pipeline::Pipeline pipeline(bus, options.pipeline);
    const PlaneMap start = pipeline.map().mapper().map();
    const DepthWatch depth(pipeline.decoder());
    pipeline::Preparation preparation(pipeline.decoder(), options.pipeline.segmentation, threads);
    const std::unique_ptr<Input> input = open_input(options.input, bus, options.source, &preparation);
    ResultFolder folder(options.output, result_names(options.output, *input));
    warn(folder.take_notes());

    RunClock clock;
    Growth growth(pipeline);
    const std::string error = map(options, *input, pipeline, folder, growth);
    clock.stop();
    growth.finish();
    if (const pipeline::GivenPoses* given = pipeline.given_poses();
        given != nullptr && given->missing() > 0 && !given->fit_nothing()) {
        spdlog::warn("{}: no pose within 0.1 s of {} keyframes, which are not in the map",
                     options.poses.string(), given->missing());
    }
    for (const std::string& line : input->complaints()) spdlog::warn("{}", line);
    bus.complaints().log_totals();

    const Outputs outputs = write_outputs(folder, options.input, *input, pipeline,
                                          {depth, clock, growth, size_resolutions_m, start}, about);
    warn(folder.take_notes());
    if (!outputs.report.is_null()) warn(outputs.report.at("warnings").get<std::vector<std::string>>());
    std::vector<std::string> problems = problems_of(options, *input, pipeline, folder, outputs);
    for (const std::string& failure : {input->failure(), error})
        if (!failure.empty()) problems.push_back(failure + "; what was mapped until then is kept");
    if (problems.empty() && pipeline.map().mapper().map().planes.empty())
        spdlog::warn("no plane was found: the map is empty");
    try {
        print_report(outputs);
    } catch (const std::exception& failure) {
        problems.emplace_back(failure.what());
    }
    for (const std::string& problem : problems) std::fprintf(stderr, "planemap-run: %s\n", problem.c_str());
    return problems.empty() ? 0 : 1;
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    planemap::messages::Flags flags(
        "planemap-run",
        "A recording to a plane map: runs all modules in one process, as fast as the machine allows, and "
        "writes the\n"
        "trajectory, the map (JSON, PLY, OBJ, glTF, GeoJSON, SVG, LCM), an OctoMap of the same depth and "
        "poses, and a report of what each takes.\n"
        "Example: planemap-run sim:office --output out/office");
    planemap::RunOptions options;
    planemap::add_run_flags(flags, options);
    return planemap::messages::run_program(flags, argc, argv, [&] {
        planemap::messages::start_logging(flags.program(), options.verbose);
        return planemap::run(options, planemap::run_info(flags));
    });
}
