// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/undistorted_source.hpp"

#include <utility>

#include "core/undistortion.hpp"
#include "messages/image_codec.hpp"

namespace planemap::sensor {

namespace {

class UndistortedSource : public FrameSource {
  public:
    explicit UndistortedSource(std::unique_ptr<FrameSource> source)
        : source_(std::move(source)), undistortion_(source_->camera()) {}

    const CameraInfo& camera() const override { return undistortion_.pinhole(); }
    std::optional<std::size_t> size() const override { return source_->size(); }
    bool is_live() const override { return source_->is_live(); }
    std::vector<std::string> notes() const override { return source_->notes(); }
    std::vector<std::string> complaints() const override { return source_->complaints(); }
    std::string end() override { return source_->end(); }
    std::optional<double> progress() const override { return source_->progress(); }
    const FrameSource& origin() const override { return source_->origin(); }

    ReadResult next(SensorFrame& frame) override {
        ReadResult result = source_->next(frame);
        if (result.status != ReadResult::Status::kFrame) return result;
        if (undistortion_.sensed().depth_distortion) {
            undistortion_.undistort(frame.depth);
            frame.depth_zipped.clear();
        }
        if (undistortion_.sensed().color_distortion) undistort_color(frame, result);
        return result;
    }

  private:
    void undistort_color(SensorFrame& frame, ReadResult& result) const {
        try {
            if (!frame.color_jpeg.empty()) {
                const PinholeCamera& camera = undistortion_.sensed().color;
                frame.color = messages::decode_jpeg_colors(frame.color_jpeg, camera.width, camera.height);
            }
            if (!frame.color.empty()) undistortion_.undistort(frame.color);
        } catch (const messages::MessageError& error) {
            frame.color = {};
            frame.color_utime = 0;
            result.color_left_out = true;
            result.reason = error.what();
            result.message = "a colour image: " + result.reason + "; the frame is used without colour";
        }
        frame.color_jpeg.clear();
    }

    std::unique_ptr<FrameSource> source_;
    Undistortion undistortion_;
};

}  // namespace

std::unique_ptr<FrameSource> undistorted(std::unique_ptr<FrameSource> source) {
    if (!source->camera().depth_distortion && !source->camera().color_distortion) return source;
    return std::make_unique<UndistortedSource>(std::move(source));
}

}  // namespace planemap::sensor
