// SPDX-License-Identifier: BSD-3-Clause
#include "run/run_options.hpp"

#include <algorithm>
#include <opencv2/core/utility.hpp>
#include <thread>

namespace planemap {

OptionList thread_options(RunOptions& options) {
    OptionList list("Threads");
    list.add(
        "threads", options.threads, {0, 64},
        "Threads of the whole run; they do not change the result. All but the first read, decode and "
        "segment the next frames ahead. 1 leaves the other cores alone; 0: 2, or 1 where there is one core, "
        "which suits a robot of two weak ones");
    return list;
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
    flags.add_positional("input", options.input, std::string("What to map: ") + sensor::kInputs);
    flags.add("o,output", options.output, "Folder for the results; made if it is not there");
    flags.required();
    flags.add("frames", options.frames,
              "A:B: only frames A to B-1 of the input, counted from 0; either may be left out");
    options.camera.add_to(
        flags, "camera.json for a log that does not describe its camera, or instead of what INPUT says");
    flags.add("channel", options.source.channel, sensor::kChannelHelp);
    flags.add("duration", options.source.duration_s, sensor::kDurationHelp);
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

int rule_threads(RunOptions& options) {
    FieldErrors errors("options");
    thread_options(options).check(errors);
    errors.throw_if_any();
    const int threads =
        options.threads > 0 ? options.threads : std::clamp<int>(std::thread::hardware_concurrency(), 1, 2);
    int& rebuild = options.pipeline.map.map.threads;
    rebuild = std::min(rebuild, threads);
    cv::setNumThreads(1);  // frames side by side give more than pieces of one
    return threads;
}

}  // namespace planemap
