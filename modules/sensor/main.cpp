// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>

#include "sensor/sensor_shell.hpp"
#include "simulator/simulated_source.hpp"

int main(int argc, char** argv) {
    planemap::messages::Process process("sensor",
                                        "Publishes RGB-D frames: a TUM-layout folder or the simulator.\n" +
                                            planemap::simulator::simulator_help());
    std::string input;
    planemap::sensor::SensorShellOptions options;
    options.live = true;
    planemap::sensor::SourceOptions source;
    process.flags().add_positional("input", input,
                                   "TUM-layout folder, or sim:WORLD[?KEY=VALUE&...], see above");
    bool check = false;
    process.flags().add("check", check, "Only say whether input, flags and URL are good; nothing is sent");
    process.flags().add(pacing_of(options));
    process.flags().add(encoding_of(options));
    return process.run(argc, argv, [&](planemap::messages::Bus& bus) {
        auto shell = std::make_unique<planemap::sensor::SensorShell>(
            bus, planemap::sensor::open_source(input, source), options);
        if (check) {
            planemap::messages::require_shared(bus);
            std::exit(0);
        }
        return shell;
    });
}
