// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bot_core/images_t.hpp>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/camera.hpp"
#include "core/histogram.hpp"
#include "core/image.hpp"
#include "messages/bus.hpp"

namespace planemap {

/// One RGB-D frame off the bus. Images are decoded when first asked for, once, and kept; whoever shares the
/// frame shares them. All accessors throw MessageError for images that are corrupt or not of the camera's
/// size, every time they are asked.
class Frame {
  public:
    Frame(bot_core::images_t images, std::shared_ptr<const CameraInfo> camera,
          std::shared_ptr<Histogram> decode_ms);
    ~Frame();
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    std::int64_t utime() const { return images_.utime; }  ///< of the depth image, microseconds
    std::int64_t color_utime() const;                     ///< of the colour image; 0 without colour
    const CameraInfo& camera() const { return *camera_; }
    bool has_color() const { return color_ != nullptr; }
    /// The sender's count of frames, if it sent one.
    std::optional<std::uint32_t> seq() const;

    const DepthImage& depth() const;           ///< depth camera's pixels, raw units
    const DepthImage& depth_in_color() const;  ///< registered to the colour camera's pixels, raw units
    const GrayImage* gray() const;             ///< luma; nullptr without colour

  private:
    bot_core::images_t images_;
    std::shared_ptr<const CameraInfo> camera_;
    std::shared_ptr<Histogram> decode_ms_;
    const bot_core::image_t* color_ = nullptr;  // into images_
    const bot_core::image_t* raw_depth_ = nullptr;
    bool zipped_ = false;
    mutable double spent_ms_ = 0;
    mutable std::optional<DepthImage> depth_, depth_in_color_;
    mutable std::optional<GrayImage> gray_;
};

/// Turns messages into frames, each decoded once in a process however many shells ask: the last few frames
/// are kept. Subscribes to the camera's description itself.
class FrameDecoder {
  public:
    /// A camera given here is used until the bus describes another one.
    explicit FrameDecoder(Bus& bus, std::optional<CameraInfo> camera = std::nullopt);

    /// nullptr when the camera is not described yet. Throws MessageError for a message that is no usable
    /// frame.
    std::shared_ptr<const Frame> decode(const RawMessage& message);

    const CameraInfo* camera() const { return camera_.get(); }
    /// Milliseconds that images took to decode and register, one entry a frame that was decoded.
    const Histogram& decode_ms() const { return *decode_ms_; }
    /// Forgets the frames kept, so that decode_ms() counts them too.
    void clear() { cache_.fill({}); }

  private:
    struct Cached {
        std::size_t bytes = 0;
        std::uint32_t checksum = 0;
        std::shared_ptr<const Frame> frame;
    };
    std::shared_ptr<const CameraInfo> camera_;
    std::shared_ptr<Histogram> decode_ms_ = std::make_shared<Histogram>();
    std::array<Cached, 8> cache_;
    std::size_t next_ = 0;
};

/// Adds the "seq" metadata that Frame::seq() reads.
void set_seq(bot_core::image_t& image, std::uint32_t seq);

}  // namespace planemap
