// SPDX-License-Identifier: BSD-3-Clause
// planemap-calibrate: what a recording says of its sensor's depth, as a camera.json.
#include <cstdio>

#include "calibrate/calibration.hpp"
#include "core/standard_output.hpp"
#include "messages/camera_flag.hpp"
#include "messages/process.hpp"
#include "results/output_file.hpp"

namespace planemap {
namespace {

constexpr const char* kProgram = "planemap-calibrate";
constexpr const char* kDescription =
    "What a recording says of its sensor's depth, as a camera.json.\n"
    "Walls are flat, however far they are: from surfaces seen from near and far, by different parts of the\n"
    "image, the error of depth is learnt that grows with the square of the range (a smooth field of inverse\n"
    "depth over the image, 5 x 4 nodes). What the recording does not say stays zero. Let the camera see "
    "walls\n"
    "and floor from 1 to 4 m, in all parts of its image, and come back to where it was.\n"
    "The file goes to whatever reads a camera.json: planemap-run INPUT --camera FILE, planemap-sensor INPUT\n"
    "--camera FILE, or camera.json of a folder; readings are then corrected before anything is made of "
    "them.\n"
    "Example: planemap-calibrate redkitchen --output redkitchen.json";

struct CalibrateOptions {
    CalibrationOptions calibration;
    messages::CameraFlag camera;
    std::string frames;
    std::filesystem::path output;
};

/// The camera.json that the new one is made of; empty if there is none.
std::filesystem::path file_of(const CalibrateOptions& options) {
    if (!options.camera.file().empty()) return options.camera.file();
    std::error_code ignored;
    const std::filesystem::path file = std::filesystem::path(options.calibration.input) / "camera.json";
    return std::filesystem::exists(file, ignored) ? file : std::filesystem::path();
}

int run(CalibrateOptions& options) {
    CalibrationOptions& calibration = options.calibration;
    calibration.source.camera = options.camera.read();
    if (!options.frames.empty()) calibration.source.frames = parse_frame_range(options.frames);
    messages::catch_stop_signals();
    OutputFile output(options.output);
    const Calibration found = calibrate(calibration);
    std::fprintf(output.for_people(), "%s", correction_text(*found.camera.depth_correction).c_str());
    for (std::size_t i = 0; i < found.passes.size(); ++i)
        std::fprintf(output.for_people(),
                     "pass %zu: %d sightings of shared surfaces; their distances, in standard deviations: "
                     "%.2f before, %.2f after\n",
                     i + 1, found.passes[i].sightings, found.passes[i].rms_before, found.passes[i].rms_after);
    std::fprintf(output.for_people(), "%lld frames, %zu keyframes; %s\n",
                 static_cast<long long>(found.frames), found.keyframes, options.output.c_str());
    output.finish(calibrated_file_text(found.camera, file_of(options)));
    finish_printing();
    return 0;
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    using namespace planemap;
    CalibrateOptions options;
    CalibrationOptions& calibration = options.calibration;
    messages::Flags flags(kProgram, kDescription);
    flags.add_positional("input", calibration.input,
                         "A recording: an LCM log, FILE.oni, a TUM-layout folder (rgb.txt, depth.txt, "
                         "camera.json), or sim:WORLD[?KEY=VALUE&...]");
    flags.add("o,output", options.output, "camera.json to write; - is standard output");
    flags.required();
    options.camera.add_to(flags, "camera.json to start from, instead of what INPUT says of its camera");
    flags.add("frames", options.frames,
              "A:B: only frames A to B-1 of the input, counted from 0; either may be left out");
    flags.add("channel", calibration.source.channel, sensor::kChannelHelp);
    flags.add("passes", calibration.passes,
              "Times that the recording is mapped, each with what the one before learnt: 1 to 20");
    flags.add("q,quiet", calibration.quiet, "No progress lines");
    return messages::run_program(flags, argc, argv, [&] {
        messages::start_logging(kProgram, false);
        return run(options);
    });
}
