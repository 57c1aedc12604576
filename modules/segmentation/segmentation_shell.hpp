// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "messages/convert.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/process.hpp"
#include "segmentation/segmentation.hpp"

namespace planemap::segmentation {

/// What was found in a frame: its depth image's planar regions in the camera frame (the colour camera's), and
/// what finding them took.
struct FoundRegions {
    messages::FrameRegions regions;
    messages::Spent spent;
};

/// Finds them; the same whatever frames came before. Not for use from two threads at once.
class RegionFinder {
  public:
    explicit RegionFinder(const SegmentationOptions& options) : segmenter_(make_segmenter(options)) {}

    /// Throws MessageError when the depth image is corrupt.
    FoundRegions find(const messages::Frame& frame);

  private:
    std::unique_ptr<Segmenter> segmenter_;
    Segmentation segmentation_;
};

/// OPENNI_FRAME to PLANEMAP_REGIONS: what RegionFinder finds, or what was kept with the frame as FoundRegions
/// because somebody did so ahead.
class SegmentationShell : public messages::Shell {
  public:
    SegmentationShell(messages::Bus& bus, std::shared_ptr<messages::FrameDecoder> decoder,
                      const SegmentationOptions& options);

    messages::ModuleStatus& status() override { return status_; }

  private:
    void on_frame(const messages::Frame& frame);

    messages::Bus& bus_;
    std::shared_ptr<messages::FrameDecoder> decoder_;
    RegionFinder finder_;
    messages::ModuleStatus status_{"segmentation"};
    std::int32_t seq_ = 0;
};

}  // namespace planemap::segmentation
