// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/recent_frames.hpp"

#include <algorithm>

namespace planemap::octomap {

namespace {

constexpr std::size_t kMostBytes = 64 << 20;  // of frames beyond the sixteen

}  // namespace

void RecentFrames::add(const std::shared_ptr<const messages::Frame>& frame) {
    frames_.push_back({frame, frame->image_bytes()});
    bytes_ += frames_.back().bytes;
    while (frames_.size() > most_ || (frames_.size() > kInHandler && bytes_ > kMostBytes)) {
        bytes_ -= frames_.front().bytes;
        frames_.pop_front();
    }
}

std::shared_ptr<const messages::Frame> RecentFrames::at(std::int64_t utime) const {
    const auto found = std::find_if(frames_.begin(), frames_.end(),
                                    [&](const Recent& recent) { return recent.frame->utime() == utime; });
    return found == frames_.end() ? nullptr : found->frame;
}

}  // namespace planemap::octomap
