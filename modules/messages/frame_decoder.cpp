// SPDX-License-Identifier: BSD-3-Clause
#include "messages/frame_decoder.hpp"

#include <libdeflate.h>

#include <chrono>
#include <cstring>
#include <string>

#include "core/registration.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/image_codec.hpp"

namespace planemap {

namespace {

using bot_core::image_t;
using bot_core::images_t;

constexpr const char* kSeqKey = "seq";

class Timer {
  public:
    explicit Timer(double& total_ms) : total_ms_(total_ms) {}
    ~Timer() {
        total_ms_ +=
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    double& total_ms_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string size_text(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

void require_size(const image_t& image, const PinholeCamera& camera, const char* which) {
    if (image.width == camera.width && image.height == camera.height) return;
    throw MessageError(std::string(which) + " image is " + size_text(image.width, image.height) +
                       ", the camera info says " + size_text(camera.width, camera.height));
}

/// Throws unless `data` holds height rows of row_bytes at the image's stride.
std::size_t checked_stride(const image_t& image, std::size_t row_bytes, const char* which) {
    const auto stride = static_cast<std::size_t>(std::max(image.row_stride, 0));
    const std::size_t used = stride == 0 ? row_bytes : stride;
    const auto height = static_cast<std::size_t>(image.height);
    if (used < row_bytes || image.data.size() < used * (height - 1) + row_bytes) {
        throw MessageError(std::string(which) + " image: " + std::to_string(image.data.size()) +
                           " bytes do not hold " + size_text(image.width, image.height) +
                           " at a row stride of " + std::to_string(image.row_stride));
    }
    return used;
}

DepthImage raw_depth(const image_t& image) {
    if (image.pixelformat != image_t::PIXEL_FORMAT_LE_GRAY16) {
        throw MessageError("depth image: pixel format " + std::to_string(image.pixelformat) +
                           " is not LE_GRAY16");
    }
    const std::size_t row_bytes = 2 * static_cast<std::size_t>(image.width);
    const std::size_t stride = checked_stride(image, row_bytes, "depth");
    DepthImage depth(image.width, image.height);
    for (int v = 0; v < image.height; ++v) {
        std::memcpy(depth.row(v), image.data.data() + static_cast<std::size_t>(v) * stride, row_bytes);
    }
    return depth;
}

GrayImage raw_luma(const image_t& image) {
    const bool gray = image.pixelformat == image_t::PIXEL_FORMAT_GRAY;
    const bool bgr = image.pixelformat == image_t::PIXEL_FORMAT_BGR;
    const std::size_t channels = gray ? 1 : 3;
    const std::size_t row_bytes = channels * static_cast<std::size_t>(image.width);
    const std::size_t stride = checked_stride(image, row_bytes, "colour");
    GrayImage out(image.width, image.height);
    RgbImage row(image.width, 1);
    for (int v = 0; v < image.height; ++v) {
        const std::uint8_t* from = image.data.data() + static_cast<std::size_t>(v) * stride;
        if (gray) {
            std::memcpy(out.row(v), from, row_bytes);
            continue;
        }
        std::memcpy(&row.pixels.data()->r, from, row_bytes);
        if (bgr) {
            for (Rgb& p : row.pixels) std::swap(p.r, p.b);
        }
        std::memcpy(out.row(v), luma(row).pixels.data(), static_cast<std::size_t>(image.width));
    }
    return out;
}

}  // namespace

Frame::Frame(images_t images, std::shared_ptr<const CameraInfo> camera, std::shared_ptr<Histogram> decode_ms)
    : images_(std::move(images)), camera_(std::move(camera)), decode_ms_(std::move(decode_ms)) {
    for (std::size_t i = 0; i < images_.images.size(); ++i) {
        const std::int16_t type = images_.image_types[i];
        const image_t& image = images_.images[i];
        if (type == images_t::LEFT && color_ == nullptr) color_ = &image;
        if ((type == images_t::DEPTH_MM || type == images_t::DEPTH_MM_ZIPPED) && raw_depth_ == nullptr) {
            raw_depth_ = &image;
            zipped_ = type == images_t::DEPTH_MM_ZIPPED;
        }
    }
    if (raw_depth_ == nullptr)
        throw MessageError("frame: no depth image (DEPTH_MM or DEPTH_MM_ZIPPED) in it");
    require_size(*raw_depth_, camera_->depth, "depth");
    if (color_ == nullptr) return;
    require_size(*color_, camera_->color, "colour");
    const std::int32_t format = color_->pixelformat;
    if (format != image_t::PIXEL_FORMAT_GRAY && format != image_t::PIXEL_FORMAT_RGB &&
        format != image_t::PIXEL_FORMAT_BGR && format != image_t::PIXEL_FORMAT_MJPEG) {
        throw MessageError("colour image: pixel format " + std::to_string(format) +
                           " is not GRAY, RGB, BGR or MJPEG");
    }
}

Frame::~Frame() {
    if (spent_ms_ > 0) decode_ms_->add(spent_ms_);
}

std::int64_t Frame::color_utime() const {
    return color_ != nullptr ? color_->utime : 0;
}

std::optional<std::uint32_t> Frame::seq() const {
    for (const auto& entry : raw_depth_->metadata) {
        if (entry.key != kSeqKey || entry.value.size() != 4) continue;
        std::uint32_t seq = 0;
        std::memcpy(&seq, entry.value.data(), 4);
        return seq;
    }
    return std::nullopt;
}

void set_seq(image_t& image, std::uint32_t seq) {
    bot_core::image_metadata_t entry;
    entry.key = kSeqKey;
    entry.n = 4;
    entry.value.resize(4);
    std::memcpy(entry.value.data(), &seq, 4);
    image.metadata.push_back(std::move(entry));
    image.nmetadata = static_cast<std::int32_t>(image.metadata.size());
}

const DepthImage& Frame::depth() const {
    if (!depth_) {
        const Timer timer(spent_ms_);
        depth_ = zipped_ ? decode_zipped_depth(raw_depth_->data, raw_depth_->width, raw_depth_->height)
                         : raw_depth(*raw_depth_);
    }
    return *depth_;
}

const DepthImage& Frame::depth_in_color() const {
    const DepthImage& sensed = depth();
    if (camera_->registered && camera_->depth == camera_->color) return sensed;
    if (!depth_in_color_) {
        const Timer timer(spent_ms_);
        depth_in_color_ = register_depth(sensed, *camera_);
    }
    return *depth_in_color_;
}

const GrayImage* Frame::gray() const {
    if (color_ == nullptr) return nullptr;
    if (!gray_) {
        const Timer timer(spent_ms_);
        gray_ = color_->pixelformat == image_t::PIXEL_FORMAT_MJPEG
                    ? decode_jpeg_luma(color_->data, color_->width, color_->height)
                    : raw_luma(*color_);
    }
    return &*gray_;
}

FrameDecoder::FrameDecoder(Bus& bus, std::optional<CameraInfo> camera) {
    if (camera) camera_ = std::make_shared<CameraInfo>(*camera);
    bus.subscribe(channels::kCameraInfo, [this](const RawMessage& message) {
        CameraInfo described = from_message(planemap::decode<camera_info_t>(message.bytes));
        if (camera_ && *camera_ == described) return;
        camera_ = std::make_shared<CameraInfo>(std::move(described));
        clear();
    });
}

std::shared_ptr<const Frame> FrameDecoder::decode(const RawMessage& message) {
    if (!camera_) return nullptr;
    const std::uint32_t checksum = libdeflate_crc32(0, message.bytes.data(), message.bytes.size());
    for (const Cached& cached : cache_) {
        if (cached.frame && cached.bytes == message.bytes.size() && cached.checksum == checksum)
            return cached.frame;
    }
    auto frame =
        std::make_shared<const Frame>(planemap::decode<images_t>(message.bytes), camera_, decode_ms_);
    cache_[next_] = {message.bytes.size(), checksum, frame};
    next_ = (next_ + 1) % cache_.size();
    return frame;
}

}  // namespace planemap
