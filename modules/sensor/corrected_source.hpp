// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <utility>

#include "core/frame_source.hpp"

namespace planemap::sensor {

/// A source whose readings are corrected by its camera's depth_correction. Its camera() has none left to do,
/// so that nobody after it corrects them again.
class CorrectedSource : public FrameSource {
  public:
    /// `sensed` is the source's camera, with a correction.
    CorrectedSource(std::unique_ptr<FrameSource> source, const CameraInfo& sensed);

    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return source_->size(); }
    ReadResult next(SensorFrame& frame) override;
    bool is_live() const override { return source_->is_live(); }
    std::vector<std::string> notes() const override { return source_->notes(); }
    std::vector<std::string> complaints() const override { return source_->complaints(); }
    std::string end() override { return source_->end(); }
    std::optional<double> progress() const override { return source_->progress(); }
    const FrameSource& origin() const override { return source_->origin(); }

  private:
    std::unique_ptr<FrameSource> source_;
    CameraInfo sensed_, camera_;  ///< with and without the correction
};

}  // namespace planemap::sensor
