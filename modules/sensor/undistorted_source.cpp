// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/undistorted_source.hpp"

#include <utility>

#include "core/undistortion.hpp"
#include "sensor/changed_color.hpp"

namespace planemap::sensor {

namespace {

class UndistortedSource : public SourceAround {
  public:
    explicit UndistortedSource(std::unique_ptr<FrameSource> distorted)
        : SourceAround(std::move(distorted)), undistortion_(source().camera()) {}

    const CameraInfo& camera() const override { return undistortion_.pinhole(); }

    ReadResult next(SensorFrame& frame) override {
        ReadResult result = source().next(frame);
        if (result.status != ReadResult::Status::kFrame) return result;
        if (undistortion_.sensed().depth_distortion) {
            undistortion_.undistort(frame.depth);
            frame.depth_zipped.clear();
        }
        if (undistortion_.sensed().color_distortion) {
            change_color(frame, result, undistortion_.sensed().color,
                         [&](RgbImage& color) { undistortion_.undistort(color); });
        }
        return result;
    }

  private:
    Undistortion undistortion_;
};

}  // namespace

std::unique_ptr<FrameSource> undistorted(std::unique_ptr<FrameSource> source) {
    if (!source->camera().depth_distortion && !source->camera().color_distortion) return source;
    return std::make_unique<UndistortedSource>(std::move(source));
}

}  // namespace planemap::sensor
