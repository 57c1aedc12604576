// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "camera/live_source.hpp"
#include "camera/options.hpp"

namespace planemap::camera {

/// The Kinect of the Xbox 360 ("v1") through libfreenect: 640 x 480 at 30 Hz. Depth is registered to colour
/// by libfreenect where it can; where it hands out raw depth only (its fakenect library, which plays
/// recordings), that is converted, and is not registered.
class FreenectCamera : public LiveCamera {
  public:
    /// `serial`: empty for the first there is. Throws std::runtime_error, one line, if there is none, it may
    /// not be opened, or nothing comes from it; std::invalid_argument for a description that is of another
    /// camera.
    FreenectCamera(const std::string& serial, const CameraRequest& request);
    ~FreenectCamera() override;
    FreenectCamera(const FreenectCamera&) = delete;
    FreenectCamera& operator=(const FreenectCamera&) = delete;

    const CameraInfo& info() const override { return info_; }
    std::string name() const override { return "Kinect v1"; }
    std::string serial() const override { return serial_; }
    std::vector<std::string> notes() const override { return notes_; }
    bool is_unplugged() const override { return unplugged_; }
    std::chrono::milliseconds silence() const override { return frames_.silence(); }
    std::optional<LiveFrame> next(std::chrono::milliseconds wait, Losses& lost) override;

  private:
    struct Device;
    using Bytes = std::vector<std::uint8_t>;

    void start(const CameraRequest& request);
    void check(const CameraRequest& request) const;
    void run();
    /// Microseconds of the device's 32-bit clock, which begins again every 72 s.
    std::int64_t stamp_us(std::uint32_t ticks);

    std::string serial_;
    CameraInfo info_;
    std::vector<std::string> notes_;
    bool is_raw_ = false;  ///< depth comes as 11 bits of disparity
    LiveFrames<Bytes> frames_;
    std::int64_t ticks_ = -1;  ///< of the last frame, without an end
    std::atomic<bool> unplugged_{false}, stop_{false};
    std::unique_ptr<Device> device_;
    std::thread thread_;
};

/// True if libfreenect finds a Kinect.
bool has_freenect_camera();

}  // namespace planemap::camera
