// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/clock_synchroniser.hpp"
#include "camera/live_frames.hpp"
#include "core/frame_source.hpp"

namespace planemap::camera {

/// A depth image and the colour image that was taken with it.
struct LiveFrame {
    std::int64_t depth_us = 0, color_us = 0;  ///< the device's stamps
    std::int64_t arrival_us = 0;              ///< of the depth image, wall clock
    DepthImage depth;
    RgbImage color;  ///< empty without a partner
};

/// One opening of a camera, from the start of its streams until it is unplugged or closed.
class LiveCamera {
  public:
    virtual ~LiveCamera() = default;
    virtual const CameraInfo& info() const = 0;
    /// For people: what it is, and its serial number.
    virtual std::string name() const = 0;
    virtual std::string serial() const = 0;  ///< empty if it has none
    /// What was asked for and could not be had, and what was assumed; a line each.
    virtual std::vector<std::string> notes() const = 0;
    /// What ends with this opening (a recording); empty for nothing.
    virtual std::string ending() const { return {}; }
    /// Ends what is made beside the frames (a recording), before the camera itself ends.
    virtual void end_recording() {}
    /// What failed beside the frames, which go on: a line. Empty: nothing.
    virtual std::string fault() const { return {}; }
    virtual bool is_unplugged() const = 0;
    virtual std::chrono::milliseconds silence() const = 0;  ///< how long no depth has come
    /// The next frame; nothing if none comes within `wait`. Adds what was lost.
    virtual std::optional<LiveFrame> next(std::chrono::milliseconds wait, Losses& lost) = 0;
};

/// A live camera as a source: its frames in the host's time (ClockSynchroniser). One that is unplugged or
/// falls silent for 2 s is opened again, at first after a second, then less and less often, to every 15 s.
class LiveSource : public FrameSource {
  public:
    /// Opens the camera, the first time with an empty serial number, later with the one that it had. Throws
    /// std::runtime_error, one line, if there is none or it does not work.
    using Open = std::function<std::unique_ptr<LiveCamera>(const std::string& serial)>;

    /// Throws what `open` throws.
    explicit LiveSource(Open open);

    const CameraInfo& camera() const override { return info_; }
    std::optional<std::size_t> size() const override { return std::nullopt; }
    /// Waits for at most a tenth of a second.
    ReadResult next(SensorFrame& frame) override;
    bool is_live() const override { return true; }
    std::vector<std::string> notes() const override { return notes_; }
    std::string end() override;

  private:
    using Clock = std::chrono::steady_clock;

    void close(const std::string& why);
    void open_again();
    std::string new_fault();

    Open open_;
    std::unique_ptr<LiveCamera> opened_;
    CameraInfo info_;
    std::string name_, serial_;
    std::vector<std::string> notes_;
    ClockSynchroniser clock_;
    std::string trouble_;  ///< why there is no camera now
    std::string fault_;    ///< of what was made beside the frames, the first
    Clock::time_point retry_at_{};
    std::chrono::milliseconds patience_{0};
};

}  // namespace planemap::camera
