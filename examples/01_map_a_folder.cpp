// SPDX-License-Identifier: BSD-3-Clause
// Maps a recording to planes: all modules in this process, on a bus of their own, as planemap-run does it.
//   01_map_a_folder INPUT plane_map.lcmlog     INPUT: a folder in the layout of the TUM benchmark, or
//   sim:office?frames=60
#include <cstdio>
#include <exception>

#include "map/map_file.hpp"
#include "pipeline/pipeline.hpp"
#include "sensor/sensor_shell.hpp"

namespace {

void map_recording(const char* input, const char* output) {
    planemap::messages::Bus bus("memq://");
    planemap::pipeline::PipelineOptions options;
    options.with_octomap = false;  // only for comparison
    planemap::pipeline::Pipeline pipeline(bus, options);

    planemap::sensor::SensorShellOptions pace;
    pace.speed = 0;  // as fast as the modules go
    planemap::sensor::SensorShell sensor(bus, planemap::sensor::open_source(input), pace);
    while (sensor.poll() >= 0) pipeline.settle();
    sensor.finish();
    pipeline.finish();

    const planemap::PlaneMap& map = pipeline.map().mapper().map();
    planemap::map::write_plane_map(output, map, pipeline.map().mapper().seen_space());
    std::printf("%zu poses, %zu planes in %s\n", pipeline.trajectory().size(), map.planes.size(), output);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "Usage: %s INPUT plane_map.lcmlog\n", argv[0]);
        return 2;
    }
    try {
        map_recording(argv[1], argv[2]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return 1;
    }
}
