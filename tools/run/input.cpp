// SPDX-License-Identifier: BSD-3-Clause
#include "run/input.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <filesystem>
#include <stdexcept>

#include "messages/channels.hpp"
#include "messages/module_status.hpp"
#include "sensor/log_frames.hpp"
#include "sensor/sensor_shell.hpp"
#include "simulator/planes_truth.hpp"

namespace planemap {

namespace {

/// A camera, a folder or the simulator, through the same shell as the sensor process; pixels stay raw, nobody
/// decodes them twice.
class SensorInput : public Input {
  public:
    SensorInput(const std::string& name, messages::Bus& bus, const sensor::SourceOptions& options)
        : folder_(name), shell_(bus, sensor::open_source(name, options), in_process()) {
        read_truth();
    }

    std::int64_t frames() const override { return shell_.frames() + shell_.broken(); }
    std::optional<double> progress() const override {
        const auto size = shell_.source().size();
        if (!size || *size == 0) return shell_.source().progress();
        return static_cast<double>(frames()) / static_cast<double>(*size);
    }
    std::vector<std::string> complaints() const override {
        std::vector<std::string> lines = shell_.source().complaints();
        if (shell_.broken() > 0)
            lines.push_back(std::to_string(shell_.broken()) + " frames could not be read");
        if (shell_.colorless() > 0)
            lines.push_back(std::to_string(shell_.colorless()) + " frames without their colour");
        if (shell_.ends_missing() > 0)
            lines.push_back(std::to_string(shell_.ends_missing()) +
                            " frames from files that are cut short behind their last pixel");
        for (const auto& [what, count] : shell_.camera_losses())
            lines.push_back("of the camera: " + std::to_string(count) + " " + what);
        return lines;
    }

    std::optional<Trajectory> truth() const override {
        return simulated() != nullptr ? simulated()->ground_truth() : truth_;
    }
    std::vector<Result> truth_results() const override {
        const simulator::SimulatedSource* simulated = this->simulated();
        if (simulated == nullptr) return {};
        return {
            {"groundtruth.txt", [=](const auto& file) { write_trajectory(file, simulated->ground_truth()); }},
            {"planes_truth.json",
             [=](const auto& file) { simulator::write_planes_truth(file, *simulated); }}};
    }

    bool is_simulated() const override { return simulated() != nullptr; }

  private:
    bool publish_next() override { return shell_.poll() >= 0; }
    const simulator::SimulatedSource* simulated() const {
        return dynamic_cast<const simulator::SimulatedSource*>(&shell_.source().origin());
    }
    static sensor::SensorShellOptions in_process() {
        sensor::SensorShellOptions options;
        options.speed = 0;
        options.color = options.depth = "raw";
        return options;
    }
    /// At the start: a bad file is said before the run, and does not take its results away.
    void read_truth() {
        const std::filesystem::path file = folder_ / "groundtruth.txt";
        std::error_code ignored;
        if (!std::filesystem::exists(file, ignored)) return;
        try {
            std::vector<std::string> notes;
            truth_ = read_trajectory(file, &notes);
            for (const std::string& note : notes) spdlog::warn("{}", note);
        } catch (const std::runtime_error& error) {
            spdlog::warn("{}; nothing is compared to it", error.what());
        }
    }

    std::filesystem::path folder_;
    sensor::SensorShell shell_;
    std::optional<Trajectory> truth_;  ///< of a folder
};

/// An LCM log: its frames go on the bus as they came, with the stamps, numbers and senders that they had.
class LogInput : public Input {
  public:
    LogInput(const std::string& name, messages::Bus& bus, const sensor::SourceOptions& options)
        : bus_(bus),
          log_(name, {.channel = options.channel,
                      .camera_is_given = options.camera.has_value(),
                      .motion_channel = options.motion_channel,
                      .frames = options.frames}) {
        if (log_.camera()) bus_.publish_bytes(messages::channels::kCameraInfo, log_.camera_bytes());
    }

    std::int64_t frames() const override { return frames_; }
    std::optional<double> progress() const override { return log_.progress(); }
    std::vector<std::string> complaints() const override {
        std::vector<std::string> lines = log_.complaints();
        if (broken_ > 0)
            lines.push_back(std::to_string(broken_) + " frames could not be read; the first: " + fault_);
        return lines;
    }
    std::string failure() const override { return failure_; }

  private:
    bool publish_next() override {
        using Found = sensor::LogFrames::Found;
        try {
            for (messages::LogEvent event;;) {
                const Found found = log_.next(event);
                if (found == Found::kEnd) return false;
                if (found == Found::kCamera) {
                    bus_.publish_bytes(messages::channels::kCameraInfo, event.bytes);
                    continue;
                }
                if (found == Found::kAcceleration) {
                    bus_.publish_bytes(messages::channels::kAcceleration, event.bytes);
                    continue;
                }
                if (found == Found::kMotion) {
                    bus_.publish_bytes(event.channel, event.bytes);
                    continue;
                }
                ++frames_;
                if (found == Found::kFrame) bus_.publish_bytes(messages::channels::kFrame, event.bytes);
                if (found == Found::kBroken && ++broken_ == 1) fault_ = log_.fault();
                return true;
            }
        } catch (const std::runtime_error& error) {  // a disk that fails: what there is so far is kept
            failure_ = error.what();
        }
        return false;
    }

    messages::Bus& bus_;
    sensor::LogFrames log_;
    std::string failure_, fault_;
    std::int64_t frames_ = 0, broken_ = 0;
};

}  // namespace

bool Input::feed() {
    const auto start = std::chrono::steady_clock::now();
    const double cpu_start_ms = messages::thread_cpu_ms();
    const bool more = publish_next();
    is_at_end_ = !more;
    if (more) {
        read_ms_.add(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        read_cpu_ms_.add(messages::thread_cpu_ms() - cpu_start_ms);
    }
    return more;
}

void feed_all(Input& input, std::int64_t max_frames,
              const std::function<void(std::int64_t frames)>& after_each) {
    while ((max_frames == 0 || input.frames() < max_frames) && input.feed()) after_each(input.frames());
}

std::unique_ptr<Input> open_input(const std::string& name, messages::Bus& bus,
                                  const sensor::SourceOptions& options) {
    if (sensor::kind_of_input(name) == sensor::InputKind::kLog)
        return std::make_unique<LogInput>(name, bus, options);
    return std::make_unique<SensorInput>(name, bus, options);
}

}  // namespace planemap
