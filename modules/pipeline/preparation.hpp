// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bot_core/images_t.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "messages/frame_decoder.hpp"
#include "segmentation/segmentation_shell.hpp"

namespace planemap::pipeline {

/// Makes of frames, ahead of their turn and on any thread, what depends on nothing but the frame: its images,
/// decoded and registered, and its regions. All that goes from one frame to the next stays with the shells,
/// which handle one frame after the other and take over what is there: the same bytes as without.
class Preparation {
  public:
    /// `threads`, at least 1: of the whole process, the one that feeds the bus among them.
    Preparation(messages::FrameDecoder& decoder, const segmentation::SegmentationOptions& options,
                int threads);

    int threads() const { return static_cast<int>(finders_.size()); }

    /// `worker` is 0 to threads() - 1, each on one thread at a time. Nothing while no camera is described,
    /// and for images that are no frame, which whoever handles the message finds out. An image that is
    /// corrupt is left for it, too.
    std::shared_ptr<messages::Frame> prepare(bot_core::images_t images, int worker);

    /// The frame whose message is published next; nullptr: nothing was made of it. On the thread that feeds
    /// the bus, and while the bus is quiet.
    void expect(std::shared_ptr<messages::Frame> frame);

  private:
    std::shared_ptr<const Undistortion> camera();

    messages::FrameDecoder& decoder_;
    std::vector<segmentation::RegionFinder> finders_;  ///< one for each worker
    std::mutex mutex_;
    std::shared_ptr<const Undistortion> camera_;  ///< the decoder's, when expect() was called last
};

}  // namespace planemap::pipeline
