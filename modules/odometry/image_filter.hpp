// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/image.hpp"
#include "odometry/news.hpp"
#include "odometry/odometry.hpp"

namespace planemap::odometry {

/// Leaves out of frames what says nothing new, and knows whether new colour is worth waiting for.
class ImageFilter {
  public:
    /// What a frame says that those before did not. Precondition: check(frame) does not throw.
    News see(const OdometryFrame& frame) { return watch_.see(frame); }
    /// The frame without the images that are not new: no colour, depth without a reading and no regions. A
    /// view of the frame and of this, until the next call. Each frame that is used comes here once, in order.
    OdometryFrame only_new(const OdometryFrame& frame, const News& news);
    /// Whether the last frames were without new colour, and not for so long that none will come.
    bool waits_for_color() const { return old_colors_ > 0 && old_colors_ <= kPatience; }

  private:
    static constexpr int kPatience = 15;  ///< frames

    NewsWatch watch_;
    DepthImage no_depth_;  ///< without a reading, of the last frame's size
    int old_colors_ = 0;   ///< frames in a row whose colour was not new
};

}  // namespace planemap::odometry
