// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bot_core/images_t.hpp>
#include <filesystem>

#include "core/frame_source.hpp"
#include "sensor/log_frames.hpp"
#include "sensor/source.hpp"

namespace planemap::sensor {

/// The frames of an LCM log (see LogFrames). A frame that cannot be decoded or is not of the camera's size is
/// kBroken; one whose colour cannot be used is delivered without it.
class LogSource : public FrameSource {
  public:
    /// Throws as LogFrames.
    explicit LogSource(const std::filesystem::path& file, const SourceOptions& options = {});

    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return std::nullopt; }
    ReadResult next(SensorFrame& frame) override;
    std::vector<std::string> complaints() const override;
    std::optional<double> progress() const override { return log_.progress(); }

  private:
    ReadResult read(const messages::LogEvent& event, SensorFrame& frame);
    ReadResult broken(const messages::LogEvent& event, const std::string& reason) const;
    void read_color(const bot_core::image_t& image, SensorFrame& frame) const;
    void hear_camera(const messages::LogEvent& event);
    void hear_acceleration(const messages::LogEvent& event);

    std::filesystem::path file_;
    LogFrames log_;
    CameraInfo camera_;
    std::int64_t other_cameras_ = 0;           ///< descriptions of another camera than the first
    std::vector<Acceleration> accelerations_;  ///< since the last frame
    std::int64_t broken_accelerations_ = 0;
};

}  // namespace planemap::sensor
