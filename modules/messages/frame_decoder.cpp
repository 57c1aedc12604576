// SPDX-License-Identifier: BSD-3-Clause
#include "messages/frame_decoder.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "core/depth_correction.hpp"
#include "core/registration.hpp"
#include "core/stamp.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/image_codec.hpp"
#include "messages/image_pixels.hpp"

namespace planemap::messages {

namespace {

using bot_core::image_t;
using bot_core::images_t;

constexpr const char *kSeqKey = "seq", *kSenderKey = "sender";

template <typename T>
std::optional<T> metadata(const image_t& image, const char* key) {
    for (const auto& entry : image.metadata) {
        if (entry.key != key || entry.value.size() != sizeof(T)) continue;
        T value = 0;
        std::memcpy(&value, entry.value.data(), sizeof(T));
        return value;
    }
    return std::nullopt;
}

template <typename T>
void add_metadata(image_t& image, const char* key, T value) {
    bot_core::image_metadata_t entry;
    entry.key = key;
    entry.n = static_cast<std::int32_t>(sizeof(T));
    entry.value.resize(sizeof(T));
    std::memcpy(entry.value.data(), &value, sizeof(T));
    image.metadata.push_back(std::move(entry));
    image.nmetadata = static_cast<std::int32_t>(image.metadata.size());
}

bool fits(const image_t* image, const PinholeCamera& camera) {
    return image == nullptr || (image->width == camera.width && image->height == camera.height);
}

bool fits(const images_t& images, const Undistortion& camera) {
    return fits(find_depth(images), camera.sensed().depth) && fits(find_color(images), camera.sensed().color);
}

/// Whether the images are the same; what is told beside them (a number, a sender) may differ.
bool are_same(const images_t& a, const images_t& b) {
    const auto is_same = [](const image_t& one, const image_t& other) {
        return one.utime == other.utime && one.width == other.width && one.height == other.height &&
               one.row_stride == other.row_stride && one.pixelformat == other.pixelformat &&
               one.data == other.data;
    };
    return a.utime == b.utime && a.image_types == b.image_types &&
           std::equal(a.images.begin(), a.images.end(), b.images.begin(), b.images.end(), is_same);
}

}  // namespace

images_t decode_images(std::span<const std::uint8_t> bytes) {
    images_t images = decode<images_t>(bytes);
    checked_utime(images.utime, "frame.utime");
    for (const image_t& image : images.images) checked_utime(image.utime, "frame.images.utime");
    return images;
}

Frame::Frame(images_t images, std::shared_ptr<const Undistortion> camera, std::shared_ptr<DecodeTimes> times)
    : images_(std::move(images)), camera_(std::move(camera)), times_(std::move(times)) {
    color_ = find_color(images_);
    raw_depth_ = find_depth(images_);
    zipped_ = depth_is_zipped(images_);
    if (raw_depth_ == nullptr)
        throw MessageError("frame: no depth image (DEPTH_MM or DEPTH_MM_ZIPPED) in it");
    require_size(*raw_depth_, camera_->sensed().depth, "depth");
    if (color_ == nullptr) return;
    require_size(*color_, camera_->sensed().color, "colour");
    require_color_format(*color_);
}

Frame::~Frame() {
    const Spent &decoding = pixels_.decoding, &registering = pixels_.registering;
    const double ms = decoding.ms + registering.ms;
    if (ms > 0) {
        times_->decode_ms.add(ms);
        times_->decode_cpu_ms.add(decoding.cpu_ms + registering.cpu_ms);
    }
    if (registering.ms > 0) {
        times_->registration_ms.add(registering.ms);
        times_->registration_cpu_ms.add(registering.cpu_ms);
    }
}

void Frame::take_over(Frame& prepared) {
    if (camera_ == prepared.camera_ && are_same(images_, prepared.images_))
        pixels_ = std::exchange(prepared.pixels_, {});
}

std::int64_t Frame::color_utime() const {
    return color_ != nullptr ? color_->utime : 0;
}

std::size_t Frame::image_bytes() const {
    std::size_t bytes = 0;
    for (const image_t& image : images_.images) bytes += image.data.size();
    return bytes;
}

std::optional<std::uint32_t> Frame::seq() const {
    return metadata<std::uint32_t>(*raw_depth_, kSeqKey);
}

void set_seq(image_t& image, std::uint32_t seq) {
    add_metadata(image, kSeqKey, seq);
}

void set_sender(image_t& image, std::uint64_t sender) {
    add_metadata(image, kSenderKey, sender);
}

const DepthImage& Frame::depth() const {
    std::optional<DepthImage>& depth = pixels_.depth;
    if (!depth) {
        const SpentTimer timer(pixels_.decoding);
        depth = depth_pixels(*raw_depth_, zipped_);
        correct_depth(*depth, camera_->sensed());
        camera_->undistort(*depth);
    }
    return *depth;
}

const DepthImage& Frame::depth_in_color() const {
    const DepthImage& sensed = depth();
    if (camera().registered && camera().depth == camera().color) return sensed;
    std::optional<DepthImage>& registered = pixels_.depth_in_color;
    if (!registered) {
        const SpentTimer timer(pixels_.registering);
        registered = register_depth(sensed, camera());
        camera_->hide_unseen(*registered);
    }
    return *registered;
}

const GrayImage* Frame::gray() const {
    if (color_ == nullptr) return nullptr;
    std::optional<GrayImage>& gray = pixels_.gray;
    if (!gray) {
        const SpentTimer timer(pixels_.decoding);
        gray = luma_pixels(*color_);
        camera_->undistort(*gray);
    }
    return &*gray;
}

std::optional<RgbImage> Frame::color(int reduction) const {
    if (color_ == nullptr) return std::nullopt;
    RgbImage color = color_->pixelformat == image_t::PIXEL_FORMAT_MJPEG
                         ? decode_jpeg_colors(color_->data, color_->width, color_->height, reduction)
                         : color_pixels(*color_, reduction);
    camera_->undistort_reduced(color, reduction);
    return color;
}

namespace {

using Verdict = SenderGuard::Verdict;

/// What becomes of a frame that is not taken, in words for ModuleStatus::lost().
const char* loss(Verdict verdict) {
    switch (verdict) {
        case Verdict::kTake:
            return nullptr;
        case Verdict::kRepeated:
        case Verdict::kLate:
            return "frames that came late or twice";
        case Verdict::kWentBack:
            return "frames whose stamp went back";
        case Verdict::kJumped:
            return "frames at a jump in time";
        case Verdict::kForeign:
            return "frames of another sender";
    }
    return nullptr;
}

void count(ModuleStatus& status, const MessageError& error) {
    status.decode_error();
    status.set_text(error.what());
}

}  // namespace

std::vector<const char*> FrameDecoder::refusals() {
    std::vector<const char*> all;
    for (const Verdict verdict : {Verdict::kLate, Verdict::kWentBack, Verdict::kJumped, Verdict::kForeign})
        all.push_back(loss(verdict));
    return all;
}

FrameDecoder::FrameDecoder(Bus& bus, std::optional<CameraInfo> camera)
    : bus_(bus), camera_is_given_(camera.has_value()) {
    if (camera) camera_ = std::make_shared<const Undistortion>(*camera);
    bus.subscribe(channels::kCameraInfo, [this](const RawMessage& message) { on_camera(message); });
}

void FrameDecoder::subscribe(ModuleStatus& status, int capacity, FrameHandler handler, bool main_stream) {
    if (subscribers_.empty())
        bus_.subscribe(
            channels::kFrame, [this](const RawMessage& m) { on_frame(m); }, capacity);
    subscribers_.push_back({&status, std::move(handler), main_stream});
}

void FrameDecoder::on_camera(const RawMessage& message) {
    CameraInfo described;
    try {
        described = from_message(planemap::messages::decode<camera_info_t>(message.bytes));
        camera_refused_.clear();
    } catch (const MessageError& error) {
        camera_refused_ = error.what();
        throw;
    }
    if (camera_ && camera_->sensed() == described) {
        described_utime_ = newest_utime_;
        if (other_camera_ && !two_cameras_said_) {
            spdlog::warn("two cameras are described on {}; the first is used while it lives",
                         channels::kCameraInfo);
            two_cameras_said_ = true;
        }
        other_camera_.reset();
        return;
    }
    auto other = std::make_shared<const Undistortion>(described);
    if (!camera_ || camera_is_given_ || !newest_utime_) {
        camera_ = std::move(other);
        described_utime_ = newest_utime_;
        camera_is_given_ = false;
    } else {
        other_camera_ = std::move(other);
    }
}

/// Takes up the other description where the one in use has ended.
void FrameDecoder::choose_camera(const images_t& images) {
    if (!described_utime_) described_utime_ = images.utime;
    const bool silent =
        images.utime < *described_utime_ || images.utime - *described_utime_ >= SenderGuard::kSilence_us;
    const bool only_other_fits = other_camera_ && !fits(images, *camera_) && fits(images, *other_camera_);
    if (!other_camera_ || !(silent || only_other_fits)) return;
    camera_ = std::move(other_camera_);
    described_utime_ = images.utime;
    two_cameras_said_ = false;
}

Verdict FrameDecoder::judge(const images_t& images, std::uint32_t checksum) {
    const image_t* depth = find_depth(images);
    const image_t* color = find_color(images);
    SenderGuard::Message message;
    message.sender = metadata<std::uint64_t>(*depth, kSenderKey);
    message.seq = metadata<std::uint32_t>(*depth, kSeqKey);
    message.utime = images.utime;
    message.checksum = checksum;
    // Of frames that lack colour the form is not known: a camera may lose its colour for a while.
    if (color != nullptr) {
        message.kind = static_cast<std::uint32_t>(color->pixelformat) ^ (depth_is_zipped(images) ? 0U : 1U);
    }
    const int switches = guard_.switches();
    const Verdict verdict = guard_.judge(message);
    if (!guard_.news().empty()) spdlog::warn("{}", guard_.news());
    if (guard_.switches() == switches) return verdict;
    if (other_camera_) described_utime_ = images.utime - SenderGuard::kSilence_us;
    if (!guard_.news().empty()) {  // without: the same sender after a pause
        for (const Subscriber& subscriber : subscribers_)
            subscriber.status->remark("sensor", "the sensor started again, or another took its place, at " +
                                                    seconds_text(images.utime));
    }
    return verdict;
}

std::shared_ptr<const Frame> FrameDecoder::decode(const RawMessage& message) const {
    if (!camera_) return nullptr;
    return std::make_shared<const Frame>(decode_images(message.bytes), camera_, times_);
}

std::shared_ptr<Frame> FrameDecoder::prepare(images_t images,
                                             std::shared_ptr<const Undistortion> camera) const {
    return std::make_shared<Frame>(std::move(images), std::move(camera), times_);
}

std::shared_ptr<const Frame> FrameDecoder::frame_of(images_t images,
                                                    std::shared_ptr<const Undistortion> camera) {
    auto frame = prepare(std::move(images), std::move(camera));
    if (expected_) frame->take_over(*std::exchange(expected_, nullptr));
    return frame;
}

/// The frame, if it is the next one of the sender that is followed; else why not.
std::pair<std::shared_ptr<const Frame>, Verdict> FrameDecoder::take(const RawMessage& message) {
    images_t images = decode_images(message.bytes);
    const image_t* depth = find_depth(images);
    const std::uint32_t checksum = checksum_of(message.bytes);
    const bool is_other = other_camera_ && !fits(images, *camera_) && fits(images, *other_camera_);
    if (depth != nullptr && !is_other && !fits(images, *camera_) &&
        metadata<std::uint64_t>(*depth, kSenderKey) && judge(images, checksum) == Verdict::kForeign) {
        return {nullptr, Verdict::kForeign};
    }
    std::shared_ptr<const Frame> frame = frame_of(std::move(images), is_other ? other_camera_ : camera_);
    const Verdict verdict = judge(frame->images_, checksum);
    if (verdict == Verdict::kTake) {
        choose_camera(frame->images_);
        newest_utime_ = frame->utime();
        if (frame->camera_ != camera_) frame = std::make_shared<const Frame>(frame->images_, camera_, times_);
    }
    return {std::move(frame), verdict};
}

/// Of the subscribers of one process, the first says it; all count it.
void FrameDecoder::lose(const Subscriber& subscriber, const char* what) {
    if (&subscriber == &subscribers_.front()) {
        subscriber.status->lost(what);
    } else {
        subscriber.status->count_loss(what);
    }
}

void FrameDecoder::on_frame(const RawMessage& message) {
    for (const Subscriber& subscriber : subscribers_) subscriber.status->came();
    if (!camera_) {
        for (const Subscriber& subscriber : subscribers_) {
            ModuleStatus& status = *subscriber.status;
            if (subscriber.main_stream) {
                status.received();
                status.dropped();
            }
            lose(subscriber, "frames before their camera was described");
            status.set_text(camera_refused_.empty()
                                ? std::string("no ") + channels::kCameraInfo +
                                      " says what the camera is: give --camera camera.json, or let "
                                      "planemap-sensor send the frames"
                                : std::string(channels::kCameraInfo) + " cannot be used: " + camera_refused_);
        }
        return;
    }
    try {
        const auto [frame, verdict] = take(message);
        if (verdict == Verdict::kTake && is_stale(message)) return lose_stale(*frame);
        for (const Subscriber& subscriber : subscribers_) {
            ModuleStatus& status = *subscriber.status;
            if (subscriber.main_stream && verdict != Verdict::kForeign) status.received(frame->seq());
            if (verdict == Verdict::kTake) continue;
            if (subscriber.main_stream) status.dropped();
            lose(subscriber, loss(verdict));
        }
        if (verdict == Verdict::kTake) deliver(frame);
    } catch (const MessageError& error) {
        for (const Subscriber& subscriber : subscribers_) count(*subscriber.status, error);
        throw;
    }
}

/// Whether the frame has waited for its turn for so long that the next one is worth more.
bool FrameDecoder::is_stale(const RawMessage& message) const {
    const bool has_main = std::any_of(subscribers_.begin(), subscribers_.end(),
                                      [](const Subscriber& subscriber) { return subscriber.main_stream; });
    return has_main && bus_.is_network() && now_us() - message.recv_utime > kStale_us;
}

void FrameDecoder::lose_stale(const Frame& frame) {
    for (const Subscriber& subscriber : subscribers_) {
        if (subscriber.main_stream) subscriber.status->received(frame.seq());
        subscriber.status->dropped();
        lose(subscriber, kStale);
    }
}

/// One subscriber's trouble with a frame is not the next one's.
void FrameDecoder::deliver(const std::shared_ptr<const Frame>& frame) {
    for (const Subscriber& subscriber : subscribers_) {
        try {
            subscriber.handler(frame);
        } catch (const MessageError& error) {
            count(*subscriber.status, error);
            bus_.report(channels::kFrame, error.what());
        }
    }
}

}  // namespace planemap::messages
