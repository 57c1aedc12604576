// SPDX-License-Identifier: BSD-3-Clause
#include "convert/shrunk_color.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sensor/changed_color.hpp"

namespace planemap::convert {

namespace {

constexpr double kLeastRatio = 0.3;

int factor_of(const CameraInfo& camera) {
    const double ratio = std::min(camera.depth.fx / camera.color.fx, camera.depth.fy / camera.color.fy);
    if (!(ratio > 0) || ratio >= kLeastRatio) return 1;
    return static_cast<int>(std::min(std::ceil(kLeastRatio / ratio), 64.0));
}

/// Pixel centres are at integers: the first one of `factor` pixels moves to their middle.
PinholeCamera shrunk(const PinholeCamera& camera, int factor) {
    const double f = factor;
    return {camera.width / factor, camera.height / factor,      camera.fx / f,
            camera.fy / f,         (camera.cx + 0.5) / f - 0.5, (camera.cy + 0.5) / f - 0.5};
}

RgbImage shrunk(const RgbImage& image, int factor) {
    RgbImage out(image.width / factor, image.height / factor);
    const int count = factor * factor;
    for (int v = 0; v < out.height; ++v) {
        for (int u = 0; u < out.width; ++u) {
            int r = count / 2, g = count / 2, b = count / 2;
            for (int y = 0; y < factor; ++y) {
                const Rgb* from = &image(u * factor, v * factor + y);
                for (int x = 0; x < factor; ++x, ++from) r += from->r, g += from->g, b += from->b;
            }
            out(u, v) = {static_cast<std::uint8_t>(r / count), static_cast<std::uint8_t>(g / count),
                         static_cast<std::uint8_t>(b / count)};
        }
    }
    return out;
}

class ShrunkColor : public SourceAround {
  public:
    ShrunkColor(std::unique_ptr<FrameSource> full, int factor)
        : SourceAround(std::move(full)), factor_(factor), camera_(source().camera()) {
        camera_.color = shrunk(camera_.color, factor);
        camera_.validate();
    }

    const CameraInfo& camera() const override { return camera_; }
    std::vector<std::string> notes() const override {
        std::vector<std::string> notes = source().notes();
        notes.push_back("colour is made " + std::to_string(factor_) + " times smaller, to " +
                        std::to_string(camera_.color.width) + "x" + std::to_string(camera_.color.height) +
                        ": its pixels are too fine for this depth");
        return notes;
    }
    ReadResult next(SensorFrame& frame) override {
        ReadResult result = source().next(frame);
        if (result.status != ReadResult::Status::kFrame) return result;
        sensor::change_color(frame, result, source().camera().color,
                             [&](RgbImage& color) { color = shrunk(color, factor_); });
        return result;
    }

  private:
    int factor_;
    CameraInfo camera_;
};

}  // namespace

std::unique_ptr<FrameSource> with_color_small_enough(std::unique_ptr<FrameSource> source) {
    const int factor = factor_of(source->camera());
    if (factor > 1) return std::make_unique<ShrunkColor>(std::move(source), factor);
    source->camera().validate();
    return source;
}

}  // namespace planemap::convert
