// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>

#include "graph/bent_depth.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/module_status.hpp"
#include "segmentation/segmentation.hpp"

namespace planemap {

/// What the surfaces of single depth images say of the sensor: that they are flat, wherever they are.
class FlatnessWatch {
  public:
    /// Hears the frames of a decoder, which calls it as long as it lives.
    explicit FlatnessWatch(messages::FrameDecoder& decoder);

    const graph::Flatness& flatness() const { return flatness_; }
    /// Adds the regions of one image: readings by their label (0: none), raw units of the camera.
    void add(const DepthImage& depth, const Image<std::uint16_t>& labels, const CameraInfo& camera);

  private:
    void hear(const messages::Frame& frame);

    messages::ModuleStatus status_{"flatness"};
    std::unique_ptr<segmentation::Segmenter> segmenter_;
    segmentation::Segmentation segmentation_;
    std::int64_t next_utime_ = 0;
    graph::Flatness flatness_;
};

}  // namespace planemap
