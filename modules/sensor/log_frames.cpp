// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/log_frames.hpp"

#include <algorithm>
#include <bot_core/images_t.hpp>
#include <kinect/frame_msg_t.hpp>
#include <planemap/camera_info_t.hpp>
#include <stdexcept>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/image_pixels.hpp"
#include "messages/kinect_frame.hpp"

namespace planemap::sensor {

namespace {

using messages::is_a;
using messages::LogEvent;

bool is_frame(const LogEvent& event) {
    return is_a<bot_core::images_t>(event.bytes) || is_a<kinect::frame_msg_t>(event.bytes);
}

bool has_depth(const LogEvent& event) {
    try {
        if (is_a<kinect::frame_msg_t>(event.bytes))
            return messages::has_depth(messages::decode<kinect::frame_msg_t>(event.bytes));
        return is_a<bot_core::images_t>(event.bytes) &&
               messages::find_depth(messages::decode<bot_core::images_t>(event.bytes)) != nullptr;
    } catch (const messages::MessageError&) {
        return false;
    }
}

}  // namespace

std::string way_out_of(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    std::error_code ignored;
    // A file of a recording in a folder is not the recording.
    if (std::filesystem::exists(folder / "depth.txt", ignored)) return "give its folder, " + folder.string();
    if (file.extension() == ".bag")
        return "`planemap-convert " + file.string() + " --output NAME.lcmlog` makes one of a ROS 1 bag";
    return {};
}

LogFrames::LogFrames(const std::filesystem::path& file, const LogFramesOptions& options)
    : options_(options), log_(file) {
    look_ahead(file);
    if (options_.frames.from > 0) check_range(file);
}

void LogFrames::look_ahead(const std::filesystem::path& file) {
    messages::LogReader ahead(file);
    messages::LogContents contents;
    bool found = false;  // a frame with depth on the channel
    for (LogEvent event; !(found && (camera_ || options_.camera_is_given)) && ahead.next(event);) {
        contents.add(event);
        channel_is_there_ = channel_is_there_ || event.channel == options_.channel;
        if (!found && (options_.channel.empty() || event.channel == options_.channel) && has_depth(event)) {
            found = true;
            options_.channel = event.channel;
        }
        if (!camera_ && !options_.camera_is_given && is_a<camera_info_t>(event.bytes)) look_at_camera(event);
    }
    if (contents.count() == 0) {
        const std::string way_out = way_out_of(file);
        throw std::runtime_error(file.string() + ": is no LCM log" + (way_out.empty() ? "" : "; " + way_out));
    }
    if (!found) fail_without_frames(file.string(), contents);
    if (!options_.camera_is_given) require_camera(file.string());
}

void LogFrames::look_at_camera(const LogEvent& event) {
    try {
        camera_ = messages::from_message(messages::decode<camera_info_t>(event.bytes));
        camera_bytes_ = event.bytes;
    } catch (const messages::MessageError& error) {
        if (++unusable_cameras_ == 1) camera_fault_ = error.what();
    }
}

void LogFrames::fail_without_frames(const std::string& name, const messages::LogContents& contents) const {
    const std::string what = "(bot_core.images_t with DEPTH_MM or DEPTH_MM_ZIPPED, or kinect.frame_msg_t)";
    if (options_.channel.empty()) {
        throw std::runtime_error(name + ": no camera frames with depth " + what + " in this log; in it are " +
                                 contents.text());
    }
    throw std::runtime_error(
        name + ": " +
        (channel_is_there_ ? "no camera frames with depth " + what + " on channel " : "no channel ") +
        messages::printable(options_.channel) + " in this log; in it are " + contents.text());
}

void LogFrames::require_camera(const std::string& name) const {
    if (camera_) return;
    throw std::runtime_error(name +
                             (unusable_cameras_ > 0
                                  ? ": none of the " + std::to_string(unusable_cameras_) +
                                        " camera_info_t in this log can be used (" + camera_fault_ + ")"
                                  : ": no camera_info_t in this log says what its camera is") +
                             "; give --camera camera.json");
}

/// An error now rather than at the end of the log.
void LogFrames::check_range(const std::filesystem::path& file) const {
    messages::LogReader ahead(file);
    std::size_t count = 0;
    for (LogEvent event; count <= options_.frames.from && ahead.next(event);)
        count += event.channel == options_.channel;
    frames_within(options_.frames, count);
}

LogFrames::Found LogFrames::next(LogEvent& event) {
    while (log_.next(event)) {
        if (event.channel == options_.channel) {
            const std::size_t number = next_++;
            if (number < options_.frames.from) continue;
            if (options_.frames.to && number >= *options_.frames.to) return Found::kEnd;
            return convert(event) ? Found::kFrame : Found::kBroken;
        }
        if (is_frame(event)) unread_.add(event);
        if (!options_.camera_is_given && event.channel == messages::channels::kCameraInfo)
            return Found::kCamera;
        if (event.channel == messages::channels::kAcceleration) return Found::kAcceleration;
        if (!options_.motion_channel.empty() && event.channel == options_.motion_channel)
            return Found::kMotion;
    }
    return Found::kEnd;
}

/// A kinect.frame_msg_t to the images_t that it is worth; anything else stays.
bool LogFrames::convert(LogEvent& event) {
    if (!is_a<kinect::frame_msg_t>(event.bytes)) return true;
    try {
        const auto images = messages::to_images(messages::decode<kinect::frame_msg_t>(event.bytes));
        event.bytes.resize(static_cast<std::size_t>(images.getEncodedSize()));
        images.encode(event.bytes.data(), 0, images.getEncodedSize());
        return true;
    } catch (const messages::MessageError& error) {
        fault_ = error.what();
        return false;
    }
}

double LogFrames::progress() const {
    return static_cast<double>(log_.bytes_read()) /
           static_cast<double>(std::max<std::uint64_t>(log_.bytes_total(), 1));
}

std::vector<std::string> LogFrames::complaints() const {
    std::vector<std::string> lines = log_.complaints();
    if (unread_.count() > 0)
        lines.push_back("frames of other channels than " + messages::printable(options_.channel) +
                        " are not read: " + unread_.text());
    return lines;
}

}  // namespace planemap::sensor
