// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "camera/cameras.hpp"
#include "messages/camera_flag.hpp"
#include "sensor/sensor_shell.hpp"
#include "simulator/simulated_source.hpp"

namespace {

/// --list needs no INPUT, which the flags ask for.
bool is_given(int argc, char** argv, std::string_view flag) {
    return std::find(argv + 1, argv + argc, flag) != argv + argc;
}

int print_cameras() {
    return planemap::messages::run_main("planemap-sensor", [] {
        std::fputs(planemap::camera::list_cameras().c_str(), stdout);
        return 0;
    });
}

}  // namespace

int main(int argc, char** argv) {
    planemap::messages::Process process(
        "sensor", "Publishes RGB-D frames: of a camera, a recording or the simulator.\n" +
                      planemap::simulator::simulator_help());
    std::string input;
    planemap::sensor::SensorShellOptions options;
    options.live = true;
    planemap::sensor::SourceOptions source;
    process.flags().add_positional("input", input, planemap::sensor::kInputs);
    planemap::messages::CameraFlag camera;
    camera.add_to(process.flags(),
                  "camera.json for a log that does not describe its camera, or instead of what INPUT says");
    process.flags().add("channel", source.channel, planemap::sensor::kChannelHelp);
    process.flags().add("record", source.device.record,
                        ".oni file to record a live OpenNI2 camera to, put in place when it is whole");
    process.flags().add("repeat", source.device.repeat, "Begin an .oni file again at its end");
    process.flags().add("duration", source.duration_s, planemap::sensor::kDurationHelp);
    bool list = false;
    process.flags().add("list", list, "Only list the cameras there are, with their modes; needs no INPUT");
    bool check = false;
    process.flags().add("check", check, "Only say whether input, flags and URL are good; nothing is sent");
    process.flags().add(pacing_of(options));
    process.flags().add(encoding_of(options));
    process.flags().add(planemap::camera::options_of(source.device.options), "camera-");
    if (is_given(argc, argv, "--list")) return print_cameras();
    return process.run(argc, argv, [&](planemap::messages::Bus& bus) {
        source.camera = camera.read();
        if (check) source.device.record.clear();  // nothing is left behind
        if (!process.state().empty()) options.position = process.state() / "sensor.position";
        auto shell = std::make_unique<planemap::sensor::SensorShell>(
            bus, planemap::sensor::open_source(input, source), options);
        if (check) {
            planemap::messages::require_shared(bus);
            std::exit(0);
        }
        return shell;
    });
}
