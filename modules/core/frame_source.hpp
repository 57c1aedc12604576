// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/acceleration.hpp"
#include "core/camera.hpp"
#include "core/image.hpp"

namespace planemap {

/// What a sensor delivers for one moment.
struct SensorFrame {
    std::int64_t utime = 0;                  ///< of the depth image, microseconds; the frame's time
    std::int64_t color_utime = 0;            ///< of the colour image, microseconds; 0 without colour
    DepthImage depth;                        ///< in the sensor's units, as sensed (not registered)
    std::vector<std::uint8_t> depth_zipped;  ///< the same as the zlib stream that was stored; or empty
    std::vector<std::uint8_t> color_jpeg;    ///< colour as the JPEG that was stored, undecoded; or empty
    RgbImage color;                          ///< colour pixels; empty if color_jpeg is set or without colour
    std::vector<Acceleration> accelerations{};  ///< read since the frame before, in order; empty without
};

/// What FrameSource::next() did.
struct ReadResult {
    enum class Status {
        kFrame,    ///< a frame; with a message if not all is well with it
        kBroken,   ///< a frame that cannot be used, to be counted and skipped; the message says why
        kNothing,  ///< a live camera has no frame yet, to be asked again; the message says what keeps it from
                   ///< having one (unplugged), or nothing
        kEnd,      ///< no more frames, and nothing more will come
    };
    Status status = Status::kEnd;
    std::string message;   ///< one line: file and reason; empty when all is well
    std::string reason{};  ///< the reason alone, alike for all files with the same fault; empty: the message
    bool color_left_out = false;  ///< of a frame: its colour could not be used and is not in it
    /// What a live camera lost since its last result, by its reason: plural, without figures.
    std::map<std::string, std::int64_t> lost{};
    std::string beside{};  ///< one line of what failed beside the frames, which go on: a recording; told once
    bool end_missing = false;  ///< of a frame: a file of it is cut short, but behind its last pixel
};

/// A finite or endless sequence of frames from one sensor.
class FrameSource {
  public:
    virtual ~FrameSource() = default;

    /// The sensor; valid, and the same for all frames.
    virtual const CameraInfo& camera() const = 0;
    /// Frames in total, broken ones included; nothing if it is not known.
    virtual std::optional<std::size_t> size() const = 0;
    /// Reads the next frame. On kFrame `frame` is whole: the depth has the camera's size. Otherwise it is
    /// empty.
    virtual ReadResult next(SensorFrame& frame) = 0;
    /// True if frames come at a camera's own pace, and for ever: whoever waits for one need not pace itself.
    virtual bool is_live() const { return false; }
    /// A line each of what the user should know about the source before its first frame.
    virtual std::vector<std::string> notes() const { return {}; }
    /// A line each of what the user should know at the end: what of the source was damaged or not read.
    virtual std::vector<std::string> complaints() const { return {}; }
    /// Nothing more is read: ends what is made beside the frames (a recording). One line of what failed of
    /// it, at any time; empty if nothing did.
    virtual std::string end() { return {}; }
    /// How far it is read, 0 to 1, where size() is not known; nothing if that is not known either.
    virtual std::optional<double> progress() const { return std::nullopt; }
    /// The source below all that was put around it.
    virtual const FrameSource& origin() const { return *this; }
};

/// A source put around another one: what it does not do otherwise is the other's.
class SourceAround : public FrameSource {
  public:
    const CameraInfo& camera() const override { return source_->camera(); }
    std::optional<std::size_t> size() const override { return source_->size(); }
    ReadResult next(SensorFrame& frame) override { return source_->next(frame); }
    bool is_live() const override { return source_->is_live(); }
    std::vector<std::string> notes() const override { return source_->notes(); }
    std::vector<std::string> complaints() const override { return source_->complaints(); }
    std::string end() override { return source_->end(); }
    std::optional<double> progress() const override { return source_->progress(); }
    const FrameSource& origin() const override { return source_->origin(); }

  protected:
    explicit SourceAround(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}
    FrameSource& source() { return *source_; }
    const FrameSource& source() const { return *source_; }

  private:
    std::unique_ptr<FrameSource> source_;
};

}  // namespace planemap
