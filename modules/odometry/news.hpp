// SPDX-License-Identifier: BSD-3-Clause
// Which images of a frame say something new.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "core/image.hpp"
#include "odometry/odometry.hpp"

namespace planemap::odometry {

/// Watches frames for images that are not of their moment. A stream that hangs gives its last buffer again,
/// or its last ones in turn, under a new stamp or the old one; a camera's own noise makes two images of a
/// still scene differ.
class NewsWatch {
  public:
    /// What a frame says that those before did not. Precondition: check(frame) does not throw.
    News see(const OdometryFrame& frame);

  private:
    bool is_late(const OdometryFrame& frame) const;

    std::deque<GrayImage> grays_;        ///< the last ones that were new, kBuffers at most
    std::deque<DepthImage> depths_;      ///< the same of depth
    std::int64_t color_utime_ = 0;       ///< of the newest of grays_; 0: not known
    std::optional<std::int64_t> utime_;  ///< of the last frame
    std::deque<std::int64_t> steps_us_;  ///< between the last frames
};

/// Whether two images are the same buffer, but for one pixel in two hundred. Of images that show nothing (a
/// covered camera, darkness) it cannot be told.
bool is_repeated(const GrayImage& image, const GrayImage& last);
/// The same of depth; pixels without a reading in both are not asked. Two images without any say nothing of
/// it.
bool is_repeated(const DepthImage& image, const DepthImage& last);

}  // namespace planemap::odometry
