// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <any>
#include <bot_core/images_t.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/camera.hpp"
#include "core/histogram.hpp"
#include "core/image.hpp"
#include "core/undistortion.hpp"
#include "messages/bus.hpp"
#include "messages/channels.hpp"
#include "messages/module_status.hpp"
#include "messages/sender_guard.hpp"
#include "messages/spent.hpp"

namespace planemap::messages {

/// What images took, milliseconds, an entry a frame that it was done for: by the clock, and in CPU time of
/// the thread that did it.
struct DecodeTimes {
    Histogram decode_ms, decode_cpu_ms;              ///< decoding and registration
    Histogram registration_ms, registration_cpu_ms;  ///< the second of these
};

/// One RGB-D frame off the bus. Images are decoded when first asked for, once, and kept; whoever shares the
/// frame shares them. All accessors throw MessageError for images that are corrupt or not of the camera's
/// size, every time they are asked.
class Frame {
  public:
    Frame(bot_core::images_t images, std::shared_ptr<const Undistortion> camera,
          std::shared_ptr<DecodeTimes> times);
    ~Frame();
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    std::int64_t utime() const { return images_.utime; }  ///< of the depth image, microseconds
    std::int64_t color_utime() const;                     ///< of the colour image; 0 without colour
    /// Of the images that the accessors give: pinholes, without distortion.
    const CameraInfo& camera() const { return camera_->pinhole(); }
    /// Of the images as they came.
    const CameraInfo& sensed_camera() const { return camera_->sensed(); }
    /// The sender's count of frames, if it sent one.
    std::optional<std::uint32_t> seq() const;

    /// Of the images as they came: what keeping the frame takes, apart from what was decoded.
    std::size_t image_bytes() const;

    /// Depth camera's pixels, raw units, corrected and undistorted as far as the camera says how.
    const DepthImage& depth() const;
    const DepthImage& depth_in_color() const;  ///< registered to the colour camera's pixels, raw units
    const GrayImage* gray() const;             ///< luma, undistorted; nullptr without colour
    /// A small picture of the colours, one pixel for `reduction` x `reduction` (1, 2, 4 or 8); not kept.
    /// Nothing without colour.
    std::optional<RgbImage> color(int reduction) const;

    /// Keeps with the frame what a module made of it ahead of its turn (see FrameDecoder::expect()), one of
    /// each type.
    template <typename Made>
    void keep(Made made) {
        pixels_.made.emplace_back(std::move(made));
    }
    /// What was kept; nullptr if nothing of this type was.
    template <typename Made>
    const Made* made() const {
        for (const std::any& made : pixels_.made)
            if (const auto* found = std::any_cast<Made>(&made)) return found;
        return nullptr;
    }

  private:
    friend class FrameDecoder;
    /// What was made of the images so far, and what it took.
    struct Pixels {
        std::optional<DepthImage> depth, depth_in_color;
        std::optional<GrayImage> gray;
        std::vector<std::any> made;
        Spent decoding, registering;
    };
    void take_over(Frame& prepared);

    bot_core::images_t images_;
    std::shared_ptr<const Undistortion> camera_;
    std::shared_ptr<DecodeTimes> times_;
    const bot_core::image_t* color_ = nullptr;  // into images_
    const bot_core::image_t* raw_depth_ = nullptr;
    bool zipped_ = false;
    mutable Pixels pixels_;
};

/// The images of a message. Throws MessageError for one that is none.
bot_core::images_t decode_images(std::span<const std::uint8_t> bytes);

/// Turns messages into frames, each decoded once in a process however many shells take it. Subscribes to the
/// camera's description itself.
///
/// Frames and descriptions may come from several senders at once, late, twice or with time going back: the
/// subscribers get those of one sender in order (see SenderGuard), and their statuses count the rest. A
/// description that differs from the one in use waits while that one lives: until it was not repeated for
/// SenderGuard::kSilence_us, another sender's frames are followed, or frames come that only the new one fits.
class FrameDecoder {
  public:
    using FrameHandler = std::function<void(std::shared_ptr<const Frame>)>;

    /// A camera given here is used until the bus describes another one.
    explicit FrameDecoder(Bus& bus, std::optional<CameraInfo> camera = std::nullopt);

    /// Calls the handler for each frame, in the order of subscription. `status` counts what comes and what is
    /// not used, and a MessageError that the handler throws; as received only where frames are the module's
    /// main stream. At most `capacity` messages wait, the first subscriber's; then the newest is dropped, but
    /// on memq:// none is.
    void subscribe(ModuleStatus& status, int capacity, FrameHandler handler, bool main_stream = true);

    /// One message, whoever sent it; nullptr when the camera is not described yet. Throws MessageError for a
    /// message that is no usable frame.
    std::shared_ptr<const Frame> decode(const RawMessage& message) const;

    /// The camera that frames are decoded with now; nullptr when it is not described yet.
    std::shared_ptr<const Undistortion> camera_in_use() const { return camera_; }
    /// A frame for expect(), of these images and a camera_in_use(). Any thread may call it, and ask the frame
    /// for its images and keep() what it made of it. Throws MessageError for images that are no usable frame.
    std::shared_ptr<Frame> prepare(bot_core::images_t images,
                                   std::shared_ptr<const Undistortion> camera) const;
    /// If the next message holds the same images, byte by byte, and is of the same camera, its frame takes
    /// over what was made of this one; else, or with nullptr, it begins with nothing. So nothing but the time
    /// that it takes depends on what is expected.
    void expect(std::shared_ptr<Frame> frame) { expected_ = std::move(frame); }

    /// On a network, a frame that waited longer than this for its turn is dropped: in every process that
    /// lives on frames, before anything is done with it. What it counts as lost is kStale.
    static constexpr std::int64_t kStale_us = 500000;
    static constexpr const char* kStale = "stale frames, which had waited for over half a second";

    /// What ModuleStatus::lost() of a subscriber calls frames that are not taken, each way once.
    static std::vector<const char*> refusals();

    /// Of the images as they come; nullptr when it is not described yet.
    const CameraInfo* camera() const { return camera_ ? &camera_->sensed() : nullptr; }
    /// Of the frames that are gone by now.
    const DecodeTimes& times() const { return *times_; }
    const Histogram& decode_ms() const { return times_->decode_ms; }

  private:
    struct Subscriber {
        ModuleStatus* status;
        FrameHandler handler;
        bool main_stream;
    };
    void on_camera(const RawMessage& message);
    void on_frame(const RawMessage& message);
    SenderGuard::Verdict judge(const bot_core::images_t& images, std::uint32_t checksum);
    void choose_camera(const bot_core::images_t& images);
    std::shared_ptr<const Frame> frame_of(bot_core::images_t images,
                                          std::shared_ptr<const Undistortion> camera);
    std::pair<std::shared_ptr<const Frame>, SenderGuard::Verdict> take(const RawMessage& message);
    bool is_stale(const RawMessage& message) const;
    void lose_stale(const Frame& frame);
    void lose(const Subscriber& subscriber, const char* what);
    void deliver(const std::shared_ptr<const Frame>& frame);

    Bus& bus_;
    std::shared_ptr<const Undistortion> camera_, other_camera_;  ///< in use; another one that was described
    std::shared_ptr<Frame> expected_;                            ///< prepared ahead of its message
    bool camera_is_given_ = false, two_cameras_said_ = false;
    std::string camera_refused_;  ///< why the last description could not be used; empty if it could
    std::optional<std::int64_t> newest_utime_,
        described_utime_;  ///< of frames; when camera_ was described last
    SenderGuard guard_{channels::kFrame};
    std::vector<Subscriber> subscribers_;
    std::shared_ptr<DecodeTimes> times_ = std::make_shared<DecodeTimes>();
};

/// Adds the "seq" metadata that Frame::seq() reads.
void set_seq(bot_core::image_t& image, std::uint32_t seq);
/// Adds the "sender" metadata: an id that a sender draws at its start, so that receivers can tell it from
/// another one (see SenderGuard).
void set_sender(bot_core::image_t& image, std::uint64_t sender);

}  // namespace planemap::messages
