// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/log_source.hpp"

#include <planemap/camera_info_t.hpp>
#include <string>
#include <utility>

#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/image_pixels.hpp"
#include "sensor/jpeg.hpp"

namespace planemap::sensor {

LogSource::LogSource(const std::filesystem::path& file, const SourceOptions& options)
    : file_(file),
      log_(file, {.channel = options.channel,
                  .camera_is_given = options.camera.has_value(),
                  .frames = options.frames}),
      camera_(options.camera ? *options.camera : *log_.camera()) {}

ReadResult LogSource::next(SensorFrame& frame) {
    frame = {};
    for (messages::LogEvent event;;) {
        switch (log_.next(event)) {
            case LogFrames::Found::kEnd:
                return {};
            case LogFrames::Found::kCamera:
                hear_camera(event);
                continue;
            case LogFrames::Found::kAcceleration:
                hear_acceleration(event);
                continue;
            case LogFrames::Found::kMotion:  // not asked for
                continue;
            case LogFrames::Found::kBroken:
                return broken(event, log_.fault());
            case LogFrames::Found::kFrame:
                break;
        }
        try {
            return read(event, frame);
        } catch (const messages::MessageError& error) {
            frame = {};
            return broken(event, error.what());
        }
    }
}

ReadResult LogSource::broken(const messages::LogEvent& event, const std::string& reason) const {
    return {ReadResult::Status::kBroken,
            file_.string() + ": event " + std::to_string(event.number) + ": " + reason +
                "; the frame is left out",
            reason};
}

ReadResult LogSource::read(const messages::LogEvent& event, SensorFrame& frame) {
    auto images = messages::decode<bot_core::images_t>(event.bytes);
    const bot_core::image_t* depth = messages::find_depth(images);
    if (depth == nullptr) throw messages::MessageError("no depth image (DEPTH_MM or DEPTH_MM_ZIPPED) in it");
    messages::require_size(*depth, camera_.depth, "depth");
    const bool zipped = messages::depth_is_zipped(images);
    frame.utime = messages::checked_utime(images.utime, "frame.utime");
    frame.depth = messages::depth_pixels(*depth, zipped);
    if (zipped) frame.depth_zipped = depth->data;
    frame.accelerations = std::exchange(accelerations_, {});
    ReadResult result;
    result.status = ReadResult::Status::kFrame;
    const bot_core::image_t* color = messages::find_color(images);
    if (color == nullptr) return result;
    try {
        read_color(*color, frame);
    } catch (const std::runtime_error& error) {
        result.reason = error.what();
        result.message = file_.string() + ": event " + std::to_string(event.number) + ": " + result.reason +
                         "; the frame is used without colour";
        result.color_left_out = true;
    }
    return result;
}

void LogSource::read_color(const bot_core::image_t& image, SensorFrame& frame) const {
    messages::require_size(image, camera_.color, "colour");
    const std::int64_t utime = messages::checked_utime(image.utime, "frame.images.utime");
    if (image.pixelformat == bot_core::image_t::PIXEL_FORMAT_MJPEG) {
        check_jpeg({reinterpret_cast<const char*>(image.data.data()), image.data.size()}, image.width,
                   image.height);
        frame.color_jpeg = image.data;
    } else {
        frame.color = messages::color_pixels(image);
    }
    frame.color_utime = utime;
}

void LogSource::hear_camera(const messages::LogEvent& event) {
    try {
        if (!(messages::from_message(messages::decode<camera_info_t>(event.bytes)) == camera_))
            ++other_cameras_;
    } catch (const messages::MessageError&) {
        ++other_cameras_;
    }
}

/// One that is none says nothing.
void LogSource::hear_acceleration(const messages::LogEvent& event) {
    constexpr std::size_t kMost = 10000;  // without a frame between
    try {
        if (accelerations_.size() < kMost)
            accelerations_.push_back(messages::from_message(messages::decode<acceleration_t>(event.bytes)));
    } catch (const messages::MessageError&) {
        ++broken_accelerations_;
    }
}

std::vector<std::string> LogSource::complaints() const {
    std::vector<std::string> lines = log_.complaints();
    if (other_cameras_ > 0)
        lines.push_back(file_.string() + ": " + std::to_string(other_cameras_) +
                        " of its camera_info_t are unusable or of another camera than the first, which is "
                        "used for all frames");
    if (broken_accelerations_ > 0)
        lines.push_back(file_.string() + ": " + std::to_string(broken_accelerations_) +
                        " of its readings of an accelerometer are unusable");
    return lines;
}

}  // namespace planemap::sensor
