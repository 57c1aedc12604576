// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "camera/live_source.hpp"
#include "camera/oni_recording.hpp"
#include "camera/openni2_device.hpp"

namespace planemap::camera {

/// A camera through OpenNI2 (PrimeSense, Xtion, Astra and whatever else a driver of it knows) whose streams
/// run as the request says, as far as the device does it; with `record`, what they send is recorded, and put
/// in place at the end.
class OpenNi2Camera : public LiveCamera {
  public:
    /// `wanted`: URI or serial number, or empty for the first camera there is. Throws std::runtime_error, one
    /// line, if there is none, it may not be opened, or no depth comes from it; std::invalid_argument for a
    /// description that is of another camera.
    OpenNi2Camera(const std::string& wanted, const CameraRequest& request);
    ~OpenNi2Camera() override;
    OpenNi2Camera(const OpenNi2Camera&) = delete;
    OpenNi2Camera& operator=(const OpenNi2Camera&) = delete;

    const CameraInfo& info() const override { return info_; }
    std::string name() const override { return name_; }
    std::string serial() const override { return serial_; }
    std::vector<std::string> notes() const override { return notes_; }
    std::string ending() const override;
    void end_recording() override;
    std::string fault() const override;
    bool is_unplugged() const override { return unplugged_; }
    std::chrono::milliseconds silence() const override { return frames_.silence(); }
    std::optional<LiveFrame> next(std::chrono::milliseconds wait, Losses& lost) override;

  private:
    class StreamListener;
    class PlugListener;

    bool has_color() const { return color_.isValid(); }
    std::int64_t period_us() const;
    void find(const std::string& wanted);
    void open_depth(const CameraRequest& request);
    void open_color(const CameraRequest& request);
    void choose_mode(openni::VideoStream& stream, openni::SensorType type, const CameraOptions& options);
    void start();
    void wait_for_depth();
    void set_exposure(int exposure);
    void verify(const CameraRequest& request);
    void verify_registration(bool wanted);
    StreamListener* listener_of(const openni::VideoStream& stream) const;
    void note(const std::string& what);

    OpenNi2Library library_;  // ends after all that is of it
    std::string uri_, serial_, name_;
    std::vector<std::string> notes_;
    CameraInfo info_;
    bool is_registered_ = false;
    std::atomic<bool> unplugged_{false};
    LiveFrames<openni::VideoFrameRef> frames_;
    std::unique_ptr<PlugListener> plug_;
    std::unique_ptr<StreamListener> depth_listener_, color_listener_;  // one listener, one stream
    openni::Device device_;
    openni::VideoStream depth_, color_;
    std::unique_ptr<OniRecording> recording_;  ///< ends before what it records; null: none
};

/// The cameras that OpenNI2 finds, with their modes: lines for people. Empty without any.
std::string list_openni2_cameras();

}  // namespace planemap::camera
