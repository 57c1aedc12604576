// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/sensor_shell.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/validation.hpp"
#include "messages/channels.hpp"
#include "messages/frame_decoder.hpp"

namespace planemap {

namespace {
constexpr std::int64_t kCameraPeriodUs = 1000000;

std::uint64_t random_sender() {
    std::random_device random;
    return std::uint64_t{random()} << 32 | random();
}
}  // namespace

void SensorShellOptions::validate() const {
    FieldErrors errors("sensor");
    errors.require(std::isfinite(rate_hz) && rate_hz >= 0 && rate_hz <= 1000, "rate", rate_hz, "0 to 1000");
    errors.require(std::isfinite(speed) && speed >= 0 && speed <= 1000, "speed", speed, "0 to 1000");
    errors.require(color == "jpeg" || color == "raw", "color", color, "jpeg or raw");
    errors.require(depth == "zipped" || depth == "raw", "depth", depth, "zipped or raw");
    errors.require(jpeg_quality >= 1 && jpeg_quality <= 100, "jpeg-quality", jpeg_quality, "1 to 100");
    errors.throw_if_any();
}

SensorShell::SensorShell(Bus& bus, std::unique_ptr<FrameSource> source, SensorShellOptions options)
    : bus_(bus), source_(std::move(source)), options_(options) {
    options_.validate();
    if (!bus_.in_process()) sender_ = random_sender();
}

bool SensorShell::read() {
    while (true) {
        const ReadResult result = source_->next(frame_);
        if (result.status == ReadResult::Status::kEnd) return false;
        status_.received();
        if (result.status == ReadResult::Status::kFrame) {
            if (!result.message.empty()) {
                ++colorless_;
                spdlog::warn("colour left out: {}", result.message);
            }
            return true;
        }
        ++broken_;
        status_.dropped();
        status_.set_text(result.message);
        spdlog::warn("frame skipped: {}", result.message);
    }
}

int SensorShell::poll() {
    if (!pending_) {
        if (!read()) return -1;
        pending_ = true;
        if (start_wall_us_ == 0) {
            start_wall_us_ = now_us();
            start_utime_ = frame_.utime;
        }
    }
    std::int64_t due_us = start_wall_us_;
    if (options_.rate_hz > 0) {
        due_us += std::llround(static_cast<double>(frames_) / options_.rate_hz * 1e6);
    } else if (options_.speed > 0) {
        due_us += std::llround(static_cast<double>(frame_.utime - start_utime_) / options_.speed);
    }
    const std::int64_t early_us = due_us - now_us();
    if (early_us > 500) return static_cast<int>(std::clamp<std::int64_t>(early_us / 1000, 1, 100));
    publish(frame_);
    pending_ = false;
    return 0;
}

void SensorShell::publish_camera(std::int64_t utime) {
    bus_.publish(channels::kCameraInfo, to_message(source_->camera(), utime, camera_seq_++));
    last_camera_utime_ = utime;
}

void SensorShell::publish(const SensorFrame& frame) {
    const ModuleStatus::Work work(status_);
    if (camera_seq_ == 0 || std::abs(frame.utime - last_camera_utime_) >= kCameraPeriodUs)
        publish_camera(frame.utime);
    bot_core::images_t images;
    images.utime = frame.utime;
    const CameraInfo& camera = source_->camera();
    if (!frame.color_jpeg.empty()) {
        images.image_types.push_back(bot_core::images_t::LEFT);
        images.images.push_back(
            jpeg_image_message(frame.color_jpeg, camera.color.width, camera.color.height, frame.color_utime));
    } else if (!frame.color.empty()) {
        images.image_types.push_back(bot_core::images_t::LEFT);
        images.images.push_back(color_image_message(
            frame.color, frame.color_utime,
            options_.color == "jpeg" ? ColorEncoding::kJpeg : ColorEncoding::kRaw, options_.jpeg_quality));
    }
    const bool zipped = options_.depth == "zipped";
    images.image_types.push_back(zipped ? std::int16_t{bot_core::images_t::DEPTH_MM_ZIPPED}
                                        : std::int16_t{bot_core::images_t::DEPTH_MM});
    images.images.push_back(
        depth_image_message(frame.depth, frame.utime, zipped ? DepthEncoding::kZipped : DepthEncoding::kRaw));
    set_seq(images.images.back(), static_cast<std::uint32_t>(frames_));
    if (sender_) set_sender(images.images.back(), *sender_);
    images.n_images = static_cast<std::int32_t>(images.images.size());
    bus_.publish(channels::kFrame, images);
    last_utime_ = frame.utime;
    ++frames_;
    status_.published();
}

void add_pacing_flags(Flags& flags, SensorShellOptions& options) {
    flags.add("rate", options.rate_hz, "Frames a second, whatever the timestamps say; 0: as recorded");
    flags.add("speed", options.speed, "Times the recorded speed; 0: as fast as possible");
}

void add_encoding_flags(Flags& flags, SensorShellOptions& options) {
    flags.add_choice("color", options.color, {"jpeg", "raw"},
                     "How colour pixels are sent; a stored JPEG goes as it is");
    flags.add_choice("depth", options.depth, {"zipped", "raw"}, "How depth is sent");
    flags.add("jpeg-quality", options.jpeg_quality, "1 to 100");
}

}  // namespace planemap
