// SPDX-License-Identifier: BSD-3-Clause
#include "run/input.hpp"

#include <algorithm>
#include <bot_core/images_t.hpp>
#include <filesystem>
#include <planemap/camera_info_t.hpp>
#include <stdexcept>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/log.hpp"
#include "run/log_contents.hpp"
#include "sensor/sensor_shell.hpp"
#include "sensor/simulator/simulated_source.hpp"

namespace planemap {

namespace {

/// A folder or the simulator, through the same shell as the sensor process; pixels stay raw, nobody decodes
/// them twice.
class SensorInput : public Input {
  public:
    SensorInput(const std::string& name, Bus& bus)
        : folder_(name), shell_(bus, open_source(name), in_process()) {}

    bool feed() override { return shell_.poll() >= 0; }
    std::int64_t frames() const override { return shell_.frames() + shell_.broken(); }
    std::optional<double> progress() const override {
        const auto size = shell_.source().size();
        if (!size || *size == 0) return std::nullopt;
        return static_cast<double>(frames()) / static_cast<double>(*size);
    }
    std::vector<std::string> complaints() const override {
        std::vector<std::string> lines;
        if (shell_.broken() > 0)
            lines.push_back(std::to_string(shell_.broken()) + " frames could not be read");
        if (shell_.colorless() > 0)
            lines.push_back(std::to_string(shell_.colorless()) + " frames without their colour");
        return lines;
    }

    std::optional<Trajectory> truth() const override {
        if (const auto* simulated = dynamic_cast<const sim::SimulatedSource*>(&shell_.source()))
            return simulated->ground_truth();
        const std::filesystem::path file = folder_ / "groundtruth.txt";
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
        return read_trajectory(file);
    }
    void write_truth(const std::filesystem::path& folder) const override {
        if (const auto* simulated = dynamic_cast<const sim::SimulatedSource*>(&shell_.source())) {
            write_trajectory(folder / "groundtruth.txt", simulated->ground_truth());
            sim::write_planes_truth(folder / "planes_truth.json", simulated->world());
        }
    }

  private:
    static SensorShellOptions in_process() {
        SensorShellOptions options;
        options.speed = 0;
        options.color = options.depth = "raw";
        return options;
    }
    std::filesystem::path folder_;
    SensorShell shell_;
};

template <typename T>
bool is_a(const LogEvent& event) {
    return fingerprint(event) == static_cast<std::uint64_t>(T::getHash());
}

/// Why a message of the type cannot be used; empty if it can.
template <typename T>
std::string why_unusable(const LogEvent& event) {
    try {
        from_message(decode<T>(event.bytes));
        return {};
    } catch (const MessageError& error) {
        return error.what();
    }
}

bool has_depth(const LogEvent& event) {
    try {
        const auto types = decode<bot_core::images_t>(event.bytes).image_types;
        return std::any_of(types.begin(), types.end(), [](std::int16_t type) {
            return type == bot_core::images_t::DEPTH_MM || type == bot_core::images_t::DEPTH_MM_ZIPPED;
        });
    } catch (const std::exception&) {
        return false;
    }
}

/// An LCM log: images_t from the first channel on which they have depth, the camera from the first
/// camera_info_t that can be used.
class LogInput : public Input {
  public:
    LogInput(const std::string& name, Bus& bus, bool has_camera)
        : bus_(bus), log_(name), follow_camera_(!has_camera) {
        LogReader ahead(name);
        LogContents contents;
        bool described = false;
        std::int64_t unusable = 0;
        std::string reason;
        for (LogEvent event; !((described || has_camera) && !channel_.empty()) && ahead.next(event);) {
            contents.add(event);
            if (channel_.empty() && is_a<bot_core::images_t>(event) && has_depth(event))
                channel_ = event.channel;
            if (described || !is_a<camera_info_t>(event)) continue;
            const std::string why = why_unusable<camera_info_t>(event);
            if (why.empty()) {
                described = true;
                if (!has_camera) bus_.publish_bytes(channels::kCameraInfo, event.bytes);
            } else if (++unusable == 1) {
                reason = why;
            }
        }
        if (channel_.empty()) {
            throw std::runtime_error(name +
                                     ": no camera frames with depth (bot_core.images_t with DEPTH_MM or "
                                     "DEPTH_MM_ZIPPED) in this log; in it are " +
                                     contents.text());
        }
        if (described || has_camera) return;
        throw std::runtime_error(name +
                                 (unusable > 0 ? ": none of the " + std::to_string(unusable) +
                                                     " camera_info_t in this log can be used (" + reason + ")"
                                               : ": no camera_info_t in this log says what its camera is") +
                                 "; give --camera camera.json");
    }

    bool feed() override {
        try {
            for (LogEvent event; log_.next(event);) {
                if (event.channel == channel_) {
                    bus_.publish_bytes(channels::kFrame, event.bytes);
                    ++frames_;
                    return true;
                }
                if (follow_camera_ && event.channel == channels::kCameraInfo)
                    bus_.publish_bytes(channels::kCameraInfo, event.bytes);
                if (is_a<bot_core::images_t>(event)) unread_.add(event);
            }
        } catch (const std::runtime_error& error) {  // a disk that fails: what there is so far is kept
            failure_ = error.what();
        }
        return false;
    }
    std::int64_t frames() const override { return frames_; }
    std::optional<double> progress() const override {
        return static_cast<double>(log_.bytes_read()) /
               static_cast<double>(std::max<std::uint64_t>(log_.bytes_total(), 1));
    }
    std::vector<std::string> complaints() const override {
        std::vector<std::string> lines = log_.complaints();
        if (unread_.count() > 0)
            lines.push_back("frames of other channels than " + channel_ + " are not read: " + unread_.text());
        return lines;
    }
    std::string failure() const override { return failure_; }

  private:
    Bus& bus_;
    LogReader log_;
    LogContents unread_;  ///< images_t of other channels
    std::string channel_, failure_;
    std::int64_t frames_ = 0;
    bool follow_camera_;
};

}  // namespace

std::unique_ptr<Input> open_input(const std::string& name, Bus& bus,
                                  const std::optional<CameraInfo>& camera) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(name, ignored))
        return std::make_unique<LogInput>(name, bus, camera.has_value());
    if (std::filesystem::exists(name, ignored) && !std::filesystem::is_directory(name, ignored))
        throw std::runtime_error(name + ": is neither a folder nor a regular file");
    return std::make_unique<SensorInput>(name, bus);
}

}  // namespace planemap
