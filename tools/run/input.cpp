// SPDX-License-Identifier: BSD-3-Clause
#include "run/input.hpp"

#include <spdlog/spdlog.h>

#include <bot_core/images_t.hpp>
#include <chrono>
#include <filesystem>
#include <planemap/camera_info_t.hpp>
#include <stdexcept>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/log.hpp"
#include "sensor/sensor_shell.hpp"
#include "sensor/simulator/simulated_source.hpp"

namespace planemap {

namespace {

/// A folder or the simulator, through the same shell as the sensor process; pixels stay raw, nobody decodes
/// them twice.
class SensorInput : public Input {
  public:
    SensorInput(const std::string& name, Bus& bus, const FrameRange& frames)
        : folder_(name), shell_(bus, open_source(name, {.frames = frames}), in_process()) {
        read_truth();
    }

    std::int64_t frames() const override { return shell_.frames() + shell_.broken(); }
    std::optional<double> progress() const override {
        const auto size = shell_.source().size();
        if (!size || *size == 0) return std::nullopt;
        return static_cast<double>(frames()) / static_cast<double>(*size);
    }
    std::string complaints() const override {
        std::string text;
        if (shell_.broken() > 0) text += std::to_string(shell_.broken()) + " frames could not be read";
        if (shell_.colorless() > 0) {
            text += (text.empty() ? "" : ", ") + std::to_string(shell_.colorless()) + " without their colour";
        }
        if (shell_.ends_missing() > 0) {
            text += (text.empty() ? "" : ", ") + std::to_string(shell_.ends_missing()) +
                    " from files that are cut short behind their last pixel";
        }
        return text;
    }

    std::optional<Trajectory> truth() const override {
        if (const auto* simulated = dynamic_cast<const sim::SimulatedSource*>(&shell_.source()))
            return simulated->ground_truth();
        return truth_;
    }
    std::vector<Result> truth_results() const override {
        const auto* simulated = dynamic_cast<const sim::SimulatedSource*>(&shell_.source());
        if (simulated == nullptr) return {};
        return {
            {"groundtruth.txt", [=](const auto& file) { write_trajectory(file, simulated->ground_truth()); }},
            {"planes_truth.json",
             [=](const auto& file) { sim::write_planes_truth(file, simulated->world()); }}};
    }

  private:
    bool publish_next() override { return shell_.poll() >= 0; }
    static SensorShellOptions in_process() {
        SensorShellOptions options;
        options.speed = 0;
        options.color = options.depth = "raw";
        return options;
    }
    /// At the start: a bad file is said before the run, and does not take its results away.
    void read_truth() {
        const std::filesystem::path file = folder_ / "groundtruth.txt";
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(file, ignored)) return;
        try {
            truth_ = read_trajectory(file);
        } catch (const std::runtime_error& error) {
            spdlog::warn("{}; nothing is compared to it", error.what());
        }
    }

    std::filesystem::path folder_;
    SensorShell shell_;
    std::optional<Trajectory> truth_;  ///< of a folder
};

std::uint64_t fingerprint(const LogEvent& event) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 8 && event.bytes.size() >= 8; ++i) value = value << 8 | event.bytes[i];
    return value;
}

/// True for a camera description that can be used: one that is corrupt may be followed by a good one.
bool describes(const LogEvent& event) {
    try {
        from_message(decode<camera_info_t>(event.bytes));
        return true;
    } catch (const MessageError&) {
        return false;
    }
}

/// An LCM log: images_t from the first channel that has them, the camera from the first camera_info_t.
class LogInput : public Input {
  public:
    LogInput(const std::string& name, Bus& bus, bool has_camera, const FrameRange& range)
        : name_(name), bus_(bus), log_(name), range_(range) {
        LogReader ahead(name);
        LogEvent event;
        bool described = false;
        while (!(described && !channel_.empty()) && ahead.next(event)) {
            const std::uint64_t type = fingerprint(event);
            if (channel_.empty() && type == static_cast<std::uint64_t>(bot_core::images_t::getHash()))
                channel_ = event.channel;
            if (!described && type == static_cast<std::uint64_t>(camera_info_t::getHash()) &&
                describes(event)) {
                described = true;
                if (!has_camera) bus_.publish_bytes(channels::kCameraInfo, event.bytes);
            }
        }
        if (channel_.empty())
            throw std::runtime_error(name + ": no camera frames (bot_core.images_t) in this log");
        if (!described && !has_camera) {
            throw std::runtime_error(
                name + ": no camera_info_t in this log says what its camera is; give --camera camera.json");
        }
        follow_camera_ = !has_camera;
        if (range_.from > 0) check_range();
    }

    std::int64_t frames() const override { return frames_; }
    std::optional<double> progress() const override {
        return static_cast<double>(log_.bytes_read()) /
               static_cast<double>(std::max<std::uint64_t>(log_.bytes_total(), 1));
    }
    std::string complaints() const override {
        std::string text;
        if (log_.truncated()) text = name_ + " is cut short: its last event is not whole";
        if (log_.bytes_skipped() > 0) {
            text += (text.empty() ? "" : "; ") + std::to_string(log_.bytes_skipped()) + " bytes of " + name_ +
                    " are no whole LCM events";
        }
        return text;
    }

  private:
    bool publish_next() override {
        LogEvent event;
        while (log_.next(event)) {
            if (event.channel == channel_) {
                const std::size_t number = next_++;
                if (number < range_.from) continue;
                if (range_.to && number >= *range_.to) return false;
                bus_.publish_bytes(channels::kFrame, event.bytes);
                ++frames_;
                return true;
            }
            if (follow_camera_ && event.channel == channels::kCameraInfo) {
                bus_.publish_bytes(channels::kCameraInfo, event.bytes);
            }
        }
        return false;
    }

    /// An error now rather than at the end of the log.
    void check_range() const {
        LogReader ahead(name_);
        std::size_t count = 0;
        for (LogEvent event; count <= range_.from && ahead.next(event);) count += event.channel == channel_;
        frames_within(range_, count);
    }

    std::string name_;
    Bus& bus_;
    LogReader log_;
    FrameRange range_;
    std::size_t next_ = 0;  ///< number of the next frame in the log
    std::string channel_;
    std::int64_t frames_ = 0;
    bool follow_camera_ = true;
};

}  // namespace

bool Input::feed() {
    const auto start = std::chrono::steady_clock::now();
    const bool more = publish_next();
    if (more) {
        read_ms_.add(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    return more;
}

std::unique_ptr<Input> open_input(const std::string& name, Bus& bus, const std::optional<CameraInfo>& camera,
                                  const FrameRange& frames) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(name, ignored))
        return std::make_unique<LogInput>(name, bus, camera.has_value(), frames);
    return std::make_unique<SensorInput>(name, bus, frames);
}

}  // namespace planemap
