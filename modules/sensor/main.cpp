// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/sensor_shell.hpp"

int main(int argc, char** argv) {
    planemap::Process process("sensor",
                              "Publishes RGB-D frames: a TUM-layout folder or the simulator (sim:office).");
    std::string input;
    planemap::SensorShellOptions options;
    planemap::SourceOptions source;
    process.flags().add_positional("input", input, "TUM-layout folder, or sim:office[?frames=N&seed=N...]");
    add_pacing_flags(process.flags(), options);
    add_encoding_flags(process.flags(), options);
    return process.run(argc, argv, [&](planemap::Bus& bus) {
        return std::make_unique<planemap::SensorShell>(bus, planemap::open_source(input, source), options);
    });
}
