// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "messages/frame_decoder.hpp"
#include "messages/process.hpp"
#include "segmentation/segmentation.hpp"

namespace planemap::segmentation {

/// OPENNI_FRAME to PLANEMAP_REGIONS: the depth image's planar regions in the camera frame (the colour
/// camera's).
class SegmentationShell : public messages::Shell {
  public:
    SegmentationShell(messages::Bus& bus, std::shared_ptr<messages::FrameDecoder> decoder,
                      const SegmentationOptions& options);

    messages::ModuleStatus& status() override { return status_; }

  private:
    void on_frame(const messages::Frame& frame);

    messages::Bus& bus_;
    std::shared_ptr<messages::FrameDecoder> decoder_;
    std::unique_ptr<Segmenter> segmenter_;
    Segmentation segmentation_;
    messages::ModuleStatus status_{"segmentation"};
    std::int32_t seq_ = 0;
};

}  // namespace planemap::segmentation
