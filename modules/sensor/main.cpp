// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>

#include "messages/camera_flag.hpp"
#include "sensor/sensor_shell.hpp"
#include "simulator/simulated_source.hpp"

int main(int argc, char** argv) {
    planemap::messages::Process process(
        "sensor", "Publishes RGB-D frames: an LCM log, a TUM-layout folder or the simulator.\n" +
                      planemap::simulator::simulator_help());
    std::string input;
    planemap::sensor::SensorShellOptions options;
    options.live = true;
    planemap::sensor::SourceOptions source;
    process.flags().add_positional("input", input,
                                   "LCM log, TUM-layout folder, or sim:WORLD[?KEY=VALUE&...], see above");
    planemap::messages::CameraFlag camera;
    camera.add_to(process.flags(),
                  "camera.json for a log that does not describe its camera, or instead of what INPUT says");
    process.flags().add("channel", source.channel,
                        "Of a log: the channel of the frames; default: the first that has depth");
    bool check = false;
    process.flags().add("check", check, "Only say whether input, flags and URL are good; nothing is sent");
    process.flags().add(pacing_of(options));
    process.flags().add(encoding_of(options));
    return process.run(argc, argv, [&](planemap::messages::Bus& bus) {
        source.camera = camera.read();
        auto shell = std::make_unique<planemap::sensor::SensorShell>(
            bus, planemap::sensor::open_source(input, source), options);
        if (check) {
            planemap::messages::require_shared(bus);
            std::exit(0);
        }
        return shell;
    });
}
