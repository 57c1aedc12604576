// SPDX-License-Identifier: BSD-3-Clause
#include "run/input.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <bot_core/images_t.hpp>
#include <chrono>
#include <filesystem>
#include <planemap/camera_info_t.hpp>
#include <stdexcept>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/log.hpp"
#include "run/log_contents.hpp"
#include "sensor/sensor_shell.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap {

namespace {

/// A folder or the simulator, through the same shell as the sensor process; pixels stay raw, nobody decodes
/// them twice.
class SensorInput : public Input {
  public:
    SensorInput(const std::string& name, messages::Bus& bus, const FrameRange& frames)
        : folder_(name), shell_(bus, sensor::open_source(name, {.frames = frames}), in_process()) {
        read_truth();
    }

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
        if (shell_.ends_missing() > 0)
            lines.push_back(std::to_string(shell_.ends_missing()) +
                            " frames from files that are cut short behind their last pixel");
        return lines;
    }

    std::optional<Trajectory> truth() const override {
        if (const auto* simulated = dynamic_cast<const simulator::SimulatedSource*>(&shell_.source()))
            return simulated->ground_truth();
        return truth_;
    }
    std::vector<Result> truth_results() const override {
        const auto* simulated = dynamic_cast<const simulator::SimulatedSource*>(&shell_.source());
        if (simulated == nullptr) return {};
        return {
            {"groundtruth.txt", [=](const auto& file) { write_trajectory(file, simulated->ground_truth()); }},
            {"planes_truth.json",
             [=](const auto& file) { simulator::write_planes_truth(file, simulated->world()); }}};
    }

  private:
    bool publish_next() override { return shell_.poll() >= 0; }
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

/// Why a message of the type cannot be used; empty if it can.
template <typename T>
std::string why_unusable(const messages::LogEvent& event) {
    try {
        messages::from_message(messages::decode<T>(event.bytes));
        return {};
    } catch (const messages::MessageError& error) {
        return error.what();
    }
}

bool has_depth(const messages::LogEvent& event) {
    try {
        const auto types = messages::decode<bot_core::images_t>(event.bytes).image_types;
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
    LogInput(const std::string& name, messages::Bus& bus, bool has_camera, const FrameRange& range)
        : name_(name), bus_(bus), log_(name), range_(range), follow_camera_(!has_camera) {
        messages::LogReader ahead(name);
        LogContents contents;
        bool described = false;
        std::int64_t unusable = 0;
        std::string reason;
        for (messages::LogEvent event;
             !((described || has_camera) && !channel_.empty()) && ahead.next(event);) {
            contents.add(event);
            if (channel_.empty() && messages::is_a<bot_core::images_t>(event.bytes) && has_depth(event))
                channel_ = event.channel;
            if (described || !messages::is_a<camera_info_t>(event.bytes)) continue;
            const std::string why = why_unusable<camera_info_t>(event);
            if (why.empty()) {
                described = true;
                if (!has_camera) bus_.publish_bytes(messages::channels::kCameraInfo, event.bytes);
            } else if (++unusable == 1) {
                reason = why;
            }
        }
        if (contents.count() == 0) throw std::runtime_error(name + ": is no LCM log" + hint(name));
        if (channel_.empty()) {
            throw std::runtime_error(name +
                                     ": no camera frames with depth (bot_core.images_t with DEPTH_MM or "
                                     "DEPTH_MM_ZIPPED) in this log; in it are " +
                                     contents.text());
        }
        if (!described && !has_camera) {
            throw std::runtime_error(name +
                                     (unusable > 0
                                          ? ": none of the " + std::to_string(unusable) +
                                                " camera_info_t in this log can be used (" + reason + ")"
                                          : ": no camera_info_t in this log says what its camera is") +
                                     "; give --camera camera.json");
        }
        if (range_.from > 0) check_range();
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
    bool publish_next() override {
        try {
            for (messages::LogEvent event; log_.next(event);) {
                if (event.channel == channel_) {
                    const std::size_t number = next_++;
                    if (number < range_.from) continue;
                    if (range_.to && number >= *range_.to) return false;
                    bus_.publish_bytes(messages::channels::kFrame, event.bytes);
                    ++frames_;
                    return true;
                }
                if (follow_camera_ && event.channel == messages::channels::kCameraInfo)
                    bus_.publish_bytes(messages::channels::kCameraInfo, event.bytes);
                if (messages::is_a<bot_core::images_t>(event.bytes)) unread_.add(event);
            }
        } catch (const std::runtime_error& error) {  // a disk that fails: what there is so far is kept
            failure_ = error.what();
        }
        return false;
    }

    /// A file of a recording in a folder is not the recording.
    static std::string hint(const std::filesystem::path& file) {
        const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
        std::error_code ignored;
        return std::filesystem::exists(folder / "depth.txt", ignored)
                   ? "; give its folder, " + folder.string()
                   : "";
    }

    /// An error now rather than at the end of the log.
    void check_range() const {
        messages::LogReader ahead(name_);
        std::size_t count = 0;
        for (messages::LogEvent event; count <= range_.from && ahead.next(event);)
            count += event.channel == channel_;
        frames_within(range_, count);
    }

    std::string name_;
    messages::Bus& bus_;
    messages::LogReader log_;
    FrameRange range_;
    std::size_t next_ = 0;  ///< number of the next frame in the log
    LogContents unread_;    ///< images_t of other channels
    std::string channel_, failure_;
    std::int64_t frames_ = 0;
    bool follow_camera_;
};

}  // namespace

bool Input::feed() {
    const auto start = std::chrono::steady_clock::now();
    const bool more = publish_next();
    is_at_end_ = !more;
    if (more) {
        read_ms_.add(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    return more;
}

void feed_all(Input& input, std::int64_t max_frames,
              const std::function<void(std::int64_t frames)>& after_each) {
    while ((max_frames == 0 || input.frames() < max_frames) && input.feed()) after_each(input.frames());
}

std::unique_ptr<Input> open_input(const std::string& name, messages::Bus& bus,
                                  const std::optional<CameraInfo>& camera, const FrameRange& frames) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(name, ignored))
        return std::make_unique<LogInput>(name, bus, camera.has_value(), frames);
    if (std::filesystem::exists(name, ignored) && !std::filesystem::is_directory(name, ignored))
        throw std::runtime_error(name + ": is neither a folder nor a regular file");
    return std::make_unique<SensorInput>(name, bus, frames);
}

}  // namespace planemap
