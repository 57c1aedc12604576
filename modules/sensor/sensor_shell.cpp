// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/sensor_shell.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <planemap/module_status_t.hpp>
#include <stdexcept>

#include "core/validation.hpp"
#include "messages/channels.hpp"
#include "messages/decode.hpp"
#include "messages/frame_decoder.hpp"

namespace planemap::sensor {

namespace {
constexpr std::int64_t kCameraPeriodUs = 1000000;
constexpr std::int64_t kLongestPauseUs = 60000000;  ///< that is waited for
}  // namespace

void SensorShellOptions::validate() const {
    FieldErrors errors("sensor");
    SensorShellOptions copy = *this;
    pacing_of(copy).check(errors);
    encoding_of(copy).check(errors);
    errors.throw_if_any();
}

SensorShell::SensorShell(messages::Bus& bus, std::unique_ptr<FrameSource> source, SensorShellOptions options)
    : bus_(bus),
      source_(std::move(source)),
      options_(std::move(options)),
      position_(options_.position),
      played_until_(position_.read()),
      last_camera_wall_us_(messages::now_us()) {
    options_.validate();
    for (const std::string& note : source_->notes()) spdlog::warn("{}", note);
    if (options_.live) ahead_ = std::make_unique<ReadAhead>(source_);
    if (bus_.session() != 0) sender_ = static_cast<std::uint64_t>(bus_.session());
    if (!options_.live || !bus_.is_network()) return;
    for (const char* module : {"SEGMENTATION", "ODOMETRY", "OCTOMAP"})
        bus_.subscribe(std::string(messages::channels::kStatusPrefix) + module,
                       [this](const messages::RawMessage& m) { on_status(m); });
}

/// The first fault of each kind is told at once; the status and the bus's complaints count them all.
void SensorShell::complain(const std::string& what, const ReadResult& result) {
    status_.count_loss(what);
    bus_.complaints().add(result.message, what + (result.reason.empty() ? result.message : result.reason));
}

/// Said when it begins and when it is over; meanwhile the status shows it.
void SensorShell::show_trouble(const ReadResult& result) {
    const std::string trouble =
        result.status == ReadResult::Status::kNothing ? result.message : std::string();
    if (trouble.empty() && result.status != ReadResult::Status::kFrame) return;
    if (trouble == trouble_) return;
    if (trouble.empty())
        spdlog::warn("frames come again");
    else
        spdlog::warn("{}", trouble);
    trouble_ = trouble;
    status_.set_failing(trouble);
}

void SensorShell::count(const ReadResult& result) {
    for (const auto& [what, count] : result.lost) {
        status_.lost(what, count);
        camera_losses_[what] += count;
    }
    if (!result.beside.empty()) status_.remark("beside", result.beside);
    show_trouble(result);
    if (result.status == ReadResult::Status::kNothing) return;
    status_.received();
    if (result.status == ReadResult::Status::kBroken) {
        ++broken_;
        status_.dropped();
        status_.set_text(result.message);
        if (first_fault_.empty()) first_fault_ = result.message;
        complain("frames that cannot be read", result);
        return;
    }
    if (result.color_left_out) {
        ++colorless_;
        complain("colour images that cannot be read", result);
    }
    if (result.end_missing) {
        ++ends_missing_;
        complain("ends of images whose pixels are all there", result);
    }
}

/// What the source says next; false if it says nothing yet.
bool SensorShell::next(ReadResult& result) {
    if (!ahead_) {
        result = source_->next(frame_);
        return true;
    }
    constexpr std::chrono::milliseconds kWait{20};
    std::optional<ReadAhead::Item> item = ahead_->take(kWait);
    if (!item) return false;
    result = std::move(item->result);
    frame_ = std::move(item->frame);
    return true;
}

SensorShell::Read SensorShell::read() {
    if (ended_) return Read::kEnd;
    ReadResult result;
    if (!next(result)) return Read::kNothing;
    ended_ = result.status == ReadResult::Status::kEnd;
    if (ended_) return Read::kEnd;
    const bool is_frame = result.status == ReadResult::Status::kFrame;
    if (is_frame && played_until_ && frame_.utime <= *played_until_) return Read::kNothing;
    played_until_.reset();
    count(result);
    return result.status == ReadResult::Status::kFrame ? Read::kFrame : Read::kNothing;
}

int SensorShell::poll() {
    const std::int64_t now = messages::now_us();
    if (!bus_.connected()) {  // a recording waits for those who listen
        if (disconnected_us_ == 0) disconnected_us_ = now;
        return 100;
    }
    if (disconnected_us_ != 0 && start_wall_us_ != 0) start_wall_us_ += now - disconnected_us_;
    disconnected_us_ = 0;
    if (options_.live && camera_is_due(last_utime_)) publish_camera(last_utime_);
    if (!pending_) {
        const Read got = read();
        if (got != Read::kFrame) return got == Read::kEnd ? -1 : 0;
        pending_ = true;
        if (start_wall_us_ == 0 || jumps()) {
            start_wall_us_ = messages::now_us();
            start_utime_ = frame_.utime;
            start_frame_ = frames_;
        }
    }
    std::int64_t due_us = start_wall_us_;
    if (source_->is_live()) {
        due_us = 0;  // it has waited for its frame already
    } else if (options_.rate_hz > 0) {
        due_us += std::llround(static_cast<double>(frames_ - start_frame_) / options_.rate_hz * 1e6);
    } else if (options_.speed > 0) {
        due_us += std::llround(static_cast<double>(frame_.utime - start_utime_) / options_.speed);
    }
    const std::int64_t early_us = due_us - messages::now_us();
    if (early_us > 500) return static_cast<int>(std::clamp<std::int64_t>(early_us / 1000, 1, 100));
    played_utime_ = frame_.utime;
    if (options_.restamp) restamp(options_.rate_hz > 0 || options_.speed > 0 ? due_us : messages::now_us());
    publish(frame_);
    pending_ = false;
    if (!position_.keep(played_utime_, messages::now_us()))
        status_.lost("notes of how far the input was played");
    return 0;
}

/// A recording whose clock was set, or that was stopped for a while, goes on at once. By the stamps that it
/// has, whatever frames are published with.
bool SensorShell::jumps() const {
    return frames_ > 0 && (frame_.utime < played_utime_ || frame_.utime - played_utime_ > kLongestPauseUs);
}

/// As if the frame had been taken at this time.
void SensorShell::restamp(std::int64_t utime) {
    if (frame_.color_utime != 0) frame_.color_utime += utime - frame_.utime;
    for (Acceleration& reading : frame_.accelerations) reading.utime += utime - frame_.utime;
    frame_.utime = utime;
}

/// Who was started just now needs the camera to use a frame: it is told at once.
void SensorShell::on_status(const messages::RawMessage& message) {
    if (messages::decode<module_status_t>(message.bytes).seq == 0) last_camera_wall_us_ = 0;
}

/// What failed of what the source made beside its frames; empty: nothing.
std::string SensorShell::end_source() {
    if (ahead_ && !ahead_->stop()) return {};
    return source_->end();
}

void SensorShell::finish() {
    if (ended_) position_.remove();
    if (const std::string fault = end_source(); !fault.empty()) throw std::runtime_error(fault);
    if (!ended_) return;
    for (const std::string& complaint : source_->complaints()) spdlog::warn("{}", complaint);
    if (frames_ > 0) return;
    status_.publish_if_due(bus_, messages::now_us(), true);
    throw std::runtime_error("none of the " + std::to_string(broken_) +
                             " frames could be read; the first: " + first_fault_);
}

/// True a second after the camera was told last: live by the wall clock, else by the stamps of the frames.
bool SensorShell::camera_is_due(std::int64_t utime) const {
    if (options_.live) return messages::now_us() - last_camera_wall_us_ >= kCameraPeriodUs;
    return std::abs(utime - last_camera_utime_) >= kCameraPeriodUs;
}

void SensorShell::publish_camera(std::int64_t utime) {
    bus_.publish(messages::channels::kCameraInfo,
                 messages::to_message(source_->camera(), utime, camera_seq_++, bus_.session()));
    last_camera_utime_ = utime;
    last_camera_wall_us_ = messages::now_us();
}

bot_core::images_t images_of(const SensorFrame& frame, const CameraInfo& camera,
                             const SensorShellOptions& options) {
    bot_core::images_t images;
    images.utime = frame.utime;
    if (!frame.color_jpeg.empty()) {
        images.image_types.push_back(bot_core::images_t::LEFT);
        images.images.push_back(messages::jpeg_image_message(frame.color_jpeg, camera.color.width,
                                                             camera.color.height, frame.color_utime));
    } else if (!frame.color.empty()) {
        images.image_types.push_back(bot_core::images_t::LEFT);
        images.images.push_back(messages::color_image_message(
            frame.color, frame.color_utime,
            options.color == "jpeg" ? messages::ColorEncoding::kJpeg : messages::ColorEncoding::kRaw,
            options.jpeg_quality));
    }
    const bool zipped = options.depth == "zipped";
    images.image_types.push_back(zipped ? std::int16_t{bot_core::images_t::DEPTH_MM_ZIPPED}
                                        : std::int16_t{bot_core::images_t::DEPTH_MM});
    images.images.push_back(zipped && !frame.depth_zipped.empty()
                                ? messages::zipped_depth_message(frame.depth_zipped, frame.depth.width,
                                                                 frame.depth.height, frame.utime)
                                : messages::depth_image_message(frame.depth, frame.utime,
                                                                zipped ? messages::DepthEncoding::kZipped
                                                                       : messages::DepthEncoding::kRaw));
    images.n_images = static_cast<std::int32_t>(images.images.size());
    return images;
}

void SensorShell::publish(const SensorFrame& frame) {
    const messages::ModuleStatus::Work work(status_);
    if (camera_seq_ == 0 || camera_is_due(frame.utime)) publish_camera(frame.utime);
    for (const Acceleration& reading : frame.accelerations)
        bus_.publish(messages::channels::kAcceleration, messages::to_message(reading));
    bot_core::images_t images = images_of(frame, source_->camera(), options_);
    messages::set_seq(images.images.back(), static_cast<std::uint32_t>(frames_));
    if (sender_) messages::set_sender(images.images.back(), *sender_);
    bus_.publish(messages::channels::kFrame, images);
    last_utime_ = frame.utime;
    ++frames_;
    status_.published();
}

OptionList pacing_of(SensorShellOptions& options) {
    OptionList list("Pacing");
    list.add("rate", options.rate_hz, {0, 1000, "Hz"}, kRateHelp);
    list.add("speed", options.speed, {0, 1000}, kSpeedHelp);
    list.add("restamp", options.restamp,
             "Stamp frames with the time at which they are due instead of their own: a recording as if it "
             "were live");
    return list;
}

OptionList encoding_of(SensorShellOptions& options) {
    OptionList list("Encoding");
    list.add("color", options.color, {"jpeg", "raw"},
             "How colour pixels are sent; a stored JPEG goes as it is");
    list.add("depth", options.depth, {"zipped", "raw"}, "How depth is sent");
    list.add("jpeg_quality", options.jpeg_quality, {1, 100}, "Of colour pixels that are sent as JPEG");
    return list;
}

}  // namespace planemap::sensor
