// SPDX-License-Identifier: BSD-3-Clause
// planemap-run: a recording to a plane map, all modules in one process.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <opencv2/core/utility.hpp>
#include <thread>

#include "core/standard_output.hpp"
#include "core/trajectory_file.hpp"
#include "messages/camera_flag.hpp"
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
#include "run/size_rows.hpp"

namespace planemap {
namespace {

struct RunOptions {
    std::string input, frames, size_resolutions = "0.1,0.05,0.02";
    std::filesystem::path output, poses;
    messages::CameraFlag camera;
    sensor::SourceOptions source;
    bool no_octomap = false, quiet = false, verbose = false;
    std::optional<std::uint64_t> seed;
    int threads = 0;
    pipeline::PipelineOptions pipeline;
};

OptionList thread_options(RunOptions& options) {
    OptionList list("Threads");
    list.add(
        "threads", options.threads, {0, 64},
        "Threads of the whole run; they do not change the result. All but the first read, decode and "
        "segment the next frames ahead. 1 leaves the other cores alone; 0: 2, or 1 where there is one core, "
        "which suits a robot of two weak ones");
    return list;
}

/// The number of threads that --threads asks for: it holds for the libraries, too.
int rule_threads(RunOptions& options) {
    const int threads =
        options.threads > 0 ? options.threads : std::clamp<int>(std::thread::hardware_concurrency(), 1, 2);
    int& rebuild = options.pipeline.map.map.threads;
    rebuild = std::min(rebuild, threads);
    cv::setNumThreads(1);  // frames side by side give more than pieces of one
    return threads;
}

OptionList report_options(RunOptions& options) {
    OptionList list("Report");
    list.add(
        "size_resolutions", options.size_resolutions, {},
        "Resolutions, metres with commas between, that the report tells the OctoMap's sizes at besides "
        "its own; each takes a pass over the keyframes' depth, 0.01 a long one. One whose tree would take "
        "more than 512 MB is left out, which the report says",
        Audience::kExpert);
    return list;
}

void add_run_flags(messages::Flags& flags, RunOptions& options) {
    flags.add_positional("input", options.input, std::string("LCM log, ") + sensor::kInputs);
    flags.add("o,output", options.output, "Folder for the results; made if it is not there");
    flags.required();
    flags.add("frames", options.frames,
              "A:B: only frames A to B-1 of the input, counted from 0; either may be left out");
    options.camera.add_to(
        flags, "camera.json for a log that does not describe its camera, or instead of what INPUT says");
    flags.add("channel", options.source.channel,
              "Of a log: the channel of the frames; default: the first that has depth");
    flags.add("duration", options.source.duration_s,
              "A live camera ends after so many seconds; 0: with Ctrl-C");
    flags.add("poses", options.poses,
              "Trajectory (TUM or EuRoC format, of the colour camera) that keyframes take their poses from, "
              "instead of the "
              "graph's; e.g. groundtruth.txt");
    flags.add("map", options.pipeline.map.start,
              "plane_map.lcmlog to start from: its planes keep their ids and grow on. It must be in the "
              "world frame "
              "of this run: with --poses theirs, else the first camera's");
    flags.add("seed", options.seed, "Of everything random; the same seed gives the same bytes out");
    flags.add("no-octomap", options.no_octomap, "Do not build the OctoMap to compare with");
    flags.add("q,quiet", options.quiet, "No progress lines");
    flags.add("v,verbose", options.verbose, "Log more");
    flags.add(thread_options(options));
    flags.add(report_options(options));
    flags.add(camera::options_of(options.source.device.options), "camera-");
    flags.add(options_of(options.pipeline.segmentation), "segmentation-");
    flags.add(options_of(options.pipeline.odometry), "odometry-");
    flags.add(options_of(options.pipeline.odometry.motion));
    flags.add(options_of(options.pipeline.graph), "graph-");
    flags.add(options_of(options.pipeline.map.map), "map-");
    flags.add(options_of(options.pipeline.octomap), "octomap-");
}

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
                                          {depth, clock, growth, size_resolutions_m}, about);
    warn(folder.take_notes());
    if (!outputs.report.is_null()) warn(outputs.report.at("warnings").get<std::vector<std::string>>());
    std::vector<std::string> problems = problems_of(options, *input, pipeline, folder, outputs);
    for (const std::string& failure : {input->failure(), error})
        if (!failure.empty()) problems.push_back(failure + "; what was mapped until then is kept");
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
