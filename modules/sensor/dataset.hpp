// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "sensor/source.hpp"

namespace planemap {

/// One line of rgb.txt or depth.txt.
struct ListedImage {
    std::int64_t utime = 0;      ///< microseconds
    std::filesystem::path file;  ///< relative to the folder
};

/// A depth image and the colour image that belongs to it.
struct ListedFrame {
    ListedImage depth;
    std::optional<ListedImage> color;
};

/// Reads a list of `timestamp filename` lines (seconds; # comments and blank lines skipped), sorted by time.
/// Throws std::runtime_error naming file, line and reason.
std::vector<ListedImage> read_image_list(const std::filesystem::path& file);

/// Reads a list of `timestamp file timestamp file` lines, depth and colour in either order (told apart by
/// "depth" in the file's name), in order of depth time. Throws as read_image_list().
std::vector<ListedFrame> read_associations(const std::filesystem::path& file);

/// Pairs images as the TUM benchmark's associate.py does: of all pairs within max_gap_us the nearest first,
/// each image once. Every depth image is in the result, in order of time.
std::vector<ListedFrame> associate(const std::vector<ListedImage>& depth,
                                   const std::vector<ListedImage>& color, std::int64_t max_gap_us);

/// A folder in the layout of the TUM RGB-D benchmark: depth.txt, rgb.txt (optional), associations.txt
/// (optional; its pairs are then the frames), camera.json (see camera_of_folder()), and the images they name:
/// depth as 16-bit greyscale PNG, colour as JPEG (passed on undecoded) or 8-bit PNG.
/// A frame whose depth cannot be read is kBroken; one whose colour cannot is delivered without it, with a
/// message.
class Dataset : public FrameSource {
  public:
    /// Throws std::runtime_error naming file and reason when there is no folder, no list or no depth in it.
    explicit Dataset(const std::filesystem::path& folder, const SourceOptions& options = {});

    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return frames_.size(); }
    ReadResult next(SensorFrame& frame) override;

    /// What will be read.
    const std::vector<ListedFrame>& frames() const { return frames_; }

  private:
    void read_color(const ListedImage& image, SensorFrame& frame) const;

    std::filesystem::path folder_;
    CameraInfo camera_;
    std::vector<ListedFrame> frames_;
    std::size_t next_ = 0;
};

}  // namespace planemap
