// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "camera/options.hpp"
#include "core/frame_source.hpp"

namespace planemap::camera {

/// An OpenNI recording (.oni), each of its frames once and at the reader's speed, in the times of the
/// recording: the same file gives the same frames. Of the request the description, `repeat` and the
/// registration count: the file does not say whether depth was registered.
class OniSource : public FrameSource {
  public:
    /// Throws std::runtime_error that names file and reason, std::invalid_argument for a description that is
    /// of another camera.
    OniSource(std::filesystem::path file, CameraRequest request);
    ~OniSource() override;

    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override;
    ReadResult next(SensorFrame& frame) override;
    std::vector<std::string> notes() const override { return notes_; }

  private:
    class Player;

    std::filesystem::path file_;
    CameraRequest request_;
    std::unique_ptr<Player> player_;
    CameraInfo camera_;
    std::vector<std::string> notes_;
    std::int64_t later_us_ = 0;  ///< what a repetition's stamps are later by
    std::int64_t last_us_ = 0;
    std::int64_t reported_unpaired_ = 0;
};

}  // namespace planemap::camera
