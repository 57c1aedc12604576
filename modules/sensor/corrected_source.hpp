// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/frame_source.hpp"

namespace planemap::sensor {

/// A source whose readings are corrected by its camera's depth_correction. Its camera() has none left to do,
/// so that nobody after it corrects them again.
class CorrectedSource : public SourceAround {
  public:
    /// `sensed` is the source's camera, with a correction.
    CorrectedSource(std::unique_ptr<FrameSource> source, const CameraInfo& sensed);

    const CameraInfo& camera() const override { return camera_; }
    ReadResult next(SensorFrame& frame) override;

  private:
    CameraInfo sensed_, camera_;  ///< with and without the correction
};

}  // namespace planemap::sensor
