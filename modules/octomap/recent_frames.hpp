// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "messages/frame_decoder.hpp"

namespace planemap::octomap {

/// The last frames, which keyframes and looks are of. In one process a keyframe comes right after its frame;
/// between processes the odometry may have a dozen frames before it, and at a fifth of the camera's rate
/// those are two seconds of frames.
class RecentFrames {
  public:
    /// Keeps at most so many, and of more than sixteen no more than 64 MiB of images.
    explicit RecentFrames(std::size_t most) : most_(most) {}
    static constexpr std::size_t kInHandler = 16, kInBackground = 128;

    void add(const std::shared_ptr<const messages::Frame>& frame);
    /// The frame of a time, if it came and is not gone; else null.
    std::shared_ptr<const messages::Frame> at(std::int64_t utime) const;

  private:
    struct Recent {
        std::shared_ptr<const messages::Frame> frame;
        std::size_t bytes;
    };
    std::size_t most_;
    std::deque<Recent> frames_;
    std::size_t bytes_ = 0;
};

}  // namespace planemap::octomap
