// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "sensor/image_list.hpp"
#include "sensor/source.hpp"

namespace planemap::sensor {

/// A folder in the layout of the TUM RGB-D benchmark: depth.txt, rgb.txt (optional), associations.txt
/// (optional; its pairs are then the frames), accelerometer.txt (optional), camera.json (see
/// camera_of_folder()), and the images they name: depth as 16-bit greyscale PNG, colour as JPEG (passed on
/// undecoded) or 8-bit PNG. A frame whose depth cannot be read is kBroken; one whose colour cannot is
/// delivered without it, with a message. A PNG whose pixels are all there is used even if the end of the file
/// is missing, and that is told.
class Dataset : public FrameSource {
  public:
    /// Throws std::runtime_error naming file and reason when there is no folder, no list or no depth in it.
    explicit Dataset(const std::filesystem::path& folder, const SourceOptions& options = {});

    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return frames_.size(); }
    ReadResult next(SensorFrame& frame) override;
    std::vector<std::string> notes() const override { return notes_; }

    /// What will be read.
    const std::vector<ListedFrame>& frames() const { return frames_; }

  private:
    void read_accelerometer();
    bool read_depth(const ListedImage& image, SensorFrame& frame) const;
    bool read_color(const ListedImage& image, SensorFrame& frame) const;

    std::filesystem::path folder_;
    std::vector<std::string> notes_;
    CameraInfo camera_;
    std::vector<ListedFrame> frames_;
    std::size_t next_ = 0;
    std::vector<Acceleration> accelerations_;  ///< in order of time
    std::size_t next_acceleration_ = 0;
};

}  // namespace planemap::sensor
