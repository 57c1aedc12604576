// SPDX-License-Identifier: BSD-3-Clause
// planemap-segment: depth images to label images and regions.
#include <cstdio>

#include "core/camera_file.hpp"
#include "core/standard_output.hpp"
#include "messages/process.hpp"
#include "segment/segment_images.hpp"
#include "segmentation/segmentation_shell.hpp"

namespace planemap {
namespace {

constexpr const char* kProgram = "planemap-segment";
constexpr const char* kDescription =
    "The planar regions of depth images.\n"
    "For each image, DIR/STEM.png holds its labels (16-bit greyscale; 0: none, i: region i) and "
    "DIR/STEM.json "
    "its\n"
    "regions: plane, pixels, RMS, box, moments and outline in the camera's frame, metres.\n"
    "Exit code 1 if an image could not be done; the others are.\n"
    "Example: planemap-segment redkitchen/depth/*.png --camera redkitchen/camera.json --output labels "
    "--overlay";

int run(const SegmentImagesOptions& options, const std::filesystem::path& camera_file) {
    std::vector<std::string> notes;
    const CameraInfo camera = read_camera_file(camera_file, &notes);
    for (const std::string& note : notes) std::fprintf(stderr, "%s: %s\n", kProgram, note.c_str());
    const SegmentImagesReport report = segment_images(options, camera);
    for (const std::string& note : report.notes) std::fprintf(stderr, "%s: %s\n", kProgram, note.c_str());
    for (const std::string& error : report.errors) std::fprintf(stderr, "%s: %s\n", kProgram, error.c_str());
    const std::size_t done = options.images.size() - report.errors.size();
    std::printf("%s: %zu of %zu images, %zu regions\n", options.output.c_str(), done, options.images.size(),
                report.regions);
    finish_printing();
    return report.errors.empty() ? 0 : 1;
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    using namespace planemap;
    SegmentImagesOptions options;
    std::filesystem::path camera;
    std::string first;
    messages::Flags flags(kProgram, kDescription);
    flags.add_positional("DEPTH.png...", first, "16-bit greyscale PNG, in the units of camera.json");
    flags.add("camera", camera, "camera.json of the sensor");
    flags.required();
    flags.add("o,output", options.output, "folder for the results; made if it is not there");
    flags.required();
    flags.add("repeat", options.repeat,
              "segment each image this often and write the time: median and 95th percentile of the thread's "
              "CPU time");
    flags.add("overlay", options.overlay, "write STEM.overlay.png, too: a picture to look at");
    flags.add("q,quiet", options.quiet, "no progress on stderr");
    flags.add(options_of(options.segmentation));

    std::vector<std::string> arguments(argv + 1, argv + argc);
    const std::vector<std::string> files = take_files(
        arguments,
        {"--overlay", "-q", "--quiet", "-h", "--help", "--help-all", "--version", "--dump-config"});
    options.images.assign(files.begin(), files.end());
    std::vector<const char*> known{kProgram};
    for (const std::string& argument : arguments) known.push_back(argument.c_str());
    if (!files.empty()) {  // the first stands for all: the flags' reader takes one
        known.push_back("--");
        known.push_back(files.front().c_str());
    }
    return messages::run_program(flags, static_cast<int>(known.size()), known.data(),
                                 [&] { return run(options, camera); });
}
