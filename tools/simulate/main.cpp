// SPDX-License-Identifier: BSD-3-Clause
// planemap-simulate: the simulator to an LCM log, with exact poses and planes beside it.
#include <spdlog/spdlog.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/body_motion.hpp"
#include "core/files.hpp"
#include "core/standard_output.hpp"
#include "messages/convert.hpp"
#include "messages/process.hpp"
#include "results/result_folder.hpp"
#include "sensor/sensor_shell.hpp"
#include "simulate/recording.hpp"
#include "simulator/planes_truth.hpp"

namespace planemap {
namespace {

constexpr const char* kTruth = "groundtruth.txt";
constexpr const char* kPlanes = "planes_truth.json";

/// Name of the log that planes_truth.json says it is of; empty if it does not say.
std::string log_of_truth(const std::filesystem::path& planes) {
    try {
        return nlohmann::json::parse(read_file(planes)).value("log", "");
    } catch (const std::exception&) {
        return {};
    }
}

/// The truth's names are those of recordings, too, and of other logs' truth: what an earlier simulation of
/// the same log left may be replaced, nothing else.
void refuse_foreign_truth(const std::filesystem::path& folder, const std::string& log) {
    std::error_code ignored;
    const std::filesystem::path truth = folder / kTruth, planes = folder / kPlanes;
    if (!std::filesystem::exists(planes, ignored)) {
        if (!std::filesystem::exists(truth, ignored)) return;
        throw std::runtime_error(truth.string() + ": is there, and not of the simulator (there is no " +
                                 kPlanes + "): give --output in another folder");
    }
    const std::string owner = log_of_truth(planes);
    // Earlier versions did not name the log.
    if (owner == log || (owner.empty() && std::filesystem::exists(folder / log, ignored))) return;
    throw std::runtime_error(truth.string() + ": is the truth of " +
                             (owner.empty() ? "something else than " + log : owner) +
                             ": give --output in another folder, a log in each");
}

/// The name of the log in its folder.
std::string log_name(const std::filesystem::path& output) {
    std::error_code ignored;
    if (output.filename() == kTruth || output.filename() == kPlanes) {
        throw std::runtime_error(output.string() +
                                 ": is the name of the truth that is written beside the log; "
                                 "give the log another one, e.g. office.lcmlog");
    }
    if (!output.filename().empty() && !std::filesystem::is_directory(output, ignored))
        return output.filename().string();
    throw std::runtime_error(output.string() + ": is a folder; --output is the log to write, e.g. " +
                             (output / "office.lcmlog").string());
}

struct SimulateOptions {
    sensor::SensorShellOptions sensor;
    std::string motion_channel;  ///< on which the robot says how it moved; empty: it does not
};

bot_core::pose_t pose_message(const StampedPose& stamped) {
    BodyMotion motion;
    motion.local_from_body = stamped.world_from_camera;  // of another frame than its name says
    return messages::to_message(motion, stamped.utime);
}

struct Simulated {
    std::int64_t frames = 0, bytes = 0;
    std::size_t total = 0;
};

/// Makes log and truth in the folder's workspace, the truth first: it is there at once.
Simulated make_results(const simulator::SimulatorOptions& world, const SimulateOptions& options,
                       const std::string& log, ResultFolder& results) {
    auto source = std::make_unique<simulator::SimulatedSource>(world);
    const Trajectory motion = options.motion_channel.empty() ? Trajectory() : source->body_motion();
    Simulated simulated;
    simulated.total = source->size().value_or(0);
    results.make({kTruth, [&](const auto& file) { write_trajectory(file, source->ground_truth()); }});
    results.make({kPlanes, [&](const auto& file) { simulator::write_planes_truth(file, *source, log); }});
    messages::Bus bus("memq://");
    sensor::SensorShell sensor(bus, std::move(source), options.sensor);
    std::size_t told = 0;
    const auto show = [&](std::int64_t frames) {
        for (; told < motion.size() && motion[told].utime <= sensor.last_utime(); ++told)
            bus.publish(options.motion_channel, pose_message(motion[told]));
        if (frames % 100 != 0) return;
        std::fprintf(stderr, "planemap-simulate: frame %lld of %zu\n", static_cast<long long>(frames),
                     simulated.total);
    };
    results.make({log, [&](const auto& file) { simulated.bytes = record(sensor, bus, 0, file, show); }});
    simulated.frames = sensor.frames();
    if (simulated.frames == 0) throw std::runtime_error(log + ": stopped before the first frame");
    return simulated;
}

int simulate(const std::string& name, const std::filesystem::path& output, const SimulateOptions& options) {
    messages::catch_stop_signals();
    simulator::SimulatorOptions world =
        simulator::parse_simulator_name(name);  // a wrong name is seen before anything is touched
    if (!options.motion_channel.empty()) world.mounted = true;
    const std::string log = log_name(output);
    const std::filesystem::path folder = output.parent_path().empty() ? "." : output.parent_path();
    refuse_foreign_truth(folder, log);
    // What a run that did not end left can be made again, and is large.
    ResultFolder results(folder, {log, kTruth, kPlanes}, "." + log + ".part",
                         ResultFolder::Leftovers::kRemove);
    Simulated simulated;
    try {
        simulated = make_results(world, options, log, results);
        refuse_foreign_truth(results.path(), log);  // another log's may have come meanwhile
        results.replace();
    } catch (...) {
        results.discard();
        throw;
    }
    for (const std::string& note : results.take_notes()) spdlog::warn("{}", note);
    if (messages::stop_requested())
        spdlog::warn("stopped after {} of {} frames", simulated.frames, simulated.total);
    char text[64];
    std::snprintf(text, sizeof(text), "%lld frames, %.1f MB", static_cast<long long>(simulated.frames),
                  static_cast<double>(simulated.bytes) / 1e6);
    print((results.path() / log).string() + ": " + text + "; exact poses in " +
          (results.path() / kTruth).string() + ", planes in " + (results.path() / kPlanes).string() + "\n");
    return 0;
}

}  // namespace
}  // namespace planemap

int main(int argc, char** argv) {
    planemap::messages::Flags flags(
        "planemap-simulate",
        "The simulator to an LCM log (OPENNI_FRAME with JPEG and zipped depth, "
        "PLANEMAP_CAMERA_INFO), with the exact poses\n"
        "(groundtruth.txt, TUM format) and planes, with the times in which they are there "
        "(planes_truth.json), beside it.\n"
        "Example: planemap-simulate --output office/office.lcmlog\n" +
            planemap::simulator::simulator_help());
    std::string world = "sim:office";
    std::filesystem::path output;
    planemap::SimulateOptions options;
    flags.add_positional("world", world, "Simulator name, see above; default: sim:office", false);
    flags.add("o,output", output, "The log to write");
    flags.required();
    flags.add("motion-channel", options.motion_channel,
              "Channel on which the robot's wheels say how it moved (bot_core.pose_t, 50 Hz, off by "
              "motion_noise), for --motion-channel of planemap-run; makes the camera `mounted`");
    flags.add(encoding_of(options.sensor));
    return planemap::messages::run_program(flags, argc, argv, [&] {
        planemap::messages::start_logging(flags.program(), false);
        options.sensor.speed = 0;  // as fast as it can be written
        return planemap::simulate(world, output, options);
    });
}
