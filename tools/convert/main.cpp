// SPDX-License-Identifier: BSD-3-Clause
// planemap-convert: recordings of others to an LCM log, and any input to a folder in the TUM layout.
#include "convert/conversion.hpp"
#include "messages/camera_flag.hpp"
#include "messages/process.hpp"
#include "sensor/source.hpp"

int main(int argc, char** argv) {
    planemap::messages::Flags flags(
        "planemap-convert",
        "Recordings of others to an LCM log, and any input to a folder in the layout of the TUM benchmark.\n"
        "INPUT: a ROS 1 bag (Image, CompressedImage, CameraInfo, tf; RealSense's own topics), a folder of a "
        "RealSense or\n"
        "Azure Kinect camera (depth/ and color/ with intrinsic.json and the like), an LCM log, a TUM folder, "
        "sim:WORLD.\n"
        "Example: planemap-convert recording.bag --output recording.lcmlog");
    std::string input;
    std::filesystem::path output;
    planemap::convert::ConvertOptions options;
    options.encoding.speed = 0;      // as fast as it can be written
    options.encoding.color = "raw";  // nothing is lost
    planemap::messages::CameraFlag camera;
    flags.add_positional("input", input, "See above");
    flags.add("o,output", output, "NAME.lcmlog, or the TUM folder to make; must not be there yet");
    flags.required();
    flags.add_choice(
        "to", options.to, {"auto", "log", "tum", "fakenect"},
        "What to write; auto: a log or a TUM folder, by the output's name; fakenect: what libfreenect's "
        "fakenect plays in place of a Kinect v1");
    camera.add_to(flags, "camera.json, instead of what INPUT says of its camera");
    flags.add("channel", options.channel, planemap::sensor::kChannelHelp);
    flags.add("depth-topic", options.depth_topic, "Of a bag; default: chosen by type and encoding");
    flags.add("color-topic", options.color_topic, "Of a bag; default: chosen by type and encoding");
    flags.add("color-gap", options.max_color_gap_s,
              "Seconds between the stamps of depth and its colour, at most");
    flags.add("rate", options.rate_hz, "Hz of images that are only numbered");
    flags.add("depth-units", options.depth_units_per_metre,
              "Units a metre of a camera's folder that does not say");
    flags.add_choice("color", options.encoding.color, {"raw", "jpeg"},
                     "How colour pixels go to a log; a stored JPEG goes as it is");
    flags.add("q,quiet", options.quiet, "No progress lines");
    const int parsed = flags.parse(argc, argv);
    if (parsed >= 0) return parsed;
    planemap::messages::start_logging("planemap-convert", false);
    return planemap::messages::run_main("planemap-convert", [&] {
        options.camera = camera.read();
        planemap::convert::convert(input, output, options);
        return 0;
    });
}
