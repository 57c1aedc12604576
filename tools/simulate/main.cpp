// SPDX-License-Identifier: BSD-3-Clause
// planemap-simulate: the simulator to an LCM log, with exact poses and planes beside it.
#include <cstdio>
#include <filesystem>

#include "messages/process.hpp"
#include "sensor/sensor_shell.hpp"
#include "sensor/simulator/simulated_source.hpp"
#include "simulate/recording.hpp"

namespace planemap {
namespace {

int simulate(const std::string& world, const std::filesystem::path& output,
             const SensorShellOptions& options) {
    catch_stop_signals();
    auto source = std::make_unique<sim::SimulatedSource>(sim::parse_simulator_name(world));
    const sim::SimulatedSource& simulated = *source;
    const std::filesystem::path folder = output.parent_path().empty() ? "." : output.parent_path();
    std::filesystem::create_directories(folder);
    Bus bus("memq://");
    SensorShell sensor(bus, std::move(source), options);
    const std::size_t total = sensor.source().size().value_or(0);
    const std::int64_t bytes = record(sensor, bus, 0, output, [&](std::int64_t frames) {
        if (frames % 100 == 0) {
            std::fprintf(stderr, "planemap-simulate: frame %lld of %zu\n", static_cast<long long>(frames),
                         total);
        }
    });
    write_trajectory(folder / "groundtruth.txt", simulated.ground_truth());
    sim::write_planes_truth(folder / "planes_truth.json", simulated.world());
    std::printf("%s: %lld frames, %.1f MB; exact poses in %s, planes in %s\n", output.c_str(),
                static_cast<long long>(sensor.frames()), static_cast<double>(bytes) / 1e6,
                (folder / "groundtruth.txt").c_str(), (folder / "planes_truth.json").c_str());
    return 0;
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    planemap::Flags flags("planemap-simulate",
                          "The simulator to an LCM log (OPENNI_FRAME with JPEG and zipped depth, "
                          "PLANEMAP_CAMERA_INFO), with the exact poses\n"
                          "(groundtruth.txt, TUM format) and planes (planes_truth.json) beside it.\n"
                          "Example: planemap-simulate --output office/office.lcmlog\n" +
                              planemap::sim::simulator_help());
    std::string world = "sim:office";
    std::filesystem::path output;
    planemap::SensorShellOptions options;
    flags.add_positional("world", world, "Simulator name, see above; default: sim:office", false);
    flags.add("o,output", output, "The log to write");
    flags.required();
    add_encoding_flags(flags, options);
    const int parsed = flags.parse(argc, argv);
    if (parsed >= 0) return parsed;
    options.speed = 0;  // as fast as it can be written
    planemap::start_logging("planemap-simulate", false);
    return planemap::run_main("planemap-simulate",
                              [&] { return planemap::simulate(world, output, options); });
}
