// SPDX-License-Identifier: BSD-3-Clause
#include "virtual_camera/feed.hpp"

#include <algorithm>
#include <cmath>

#include "messages/image_codec.hpp"
#include "sensor/undistorted_source.hpp"

namespace planemap::virtual_camera {

namespace {

/// Uniform in [0, 1), the same on every machine.
double uniform(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) * 0x1p-53;
}

DepthImage in_millimetres(DepthImage depth, double units_per_metre) {
    if (units_per_metre == 1000) return depth;
    for (std::uint16_t& raw : depth.pixels) {
        const double mm = is_valid_depth(raw) ? std::round(raw * 1000 / units_per_metre) : 0;
        raw = static_cast<std::uint16_t>(std::min(mm, 65534.0));
    }
    return depth;
}

RgbImage color_of(SensorFrame& frame, const PinholeCamera& camera) {
    if (frame.color_jpeg.empty()) return std::move(frame.color);
    return messages::decode_jpeg_colors(frame.color_jpeg, camera.width, camera.height);
}

}  // namespace

Feed::Feed(Order order)
    : order_(std::move(order)),
      source_(sensor::undistorted(sensor::open_source(order_.input))),
      camera_(source_->camera()),
      random_(order_.options.seed) {
    camera_.depth_units_per_metre = 1000;
}

/// The next frame that can be read; the input begins again at its end.
bool Feed::read(SensorFrame& frame) {
    for (;;) {
        const ReadResult result = source_->next(frame);
        if (result.status == ReadResult::Status::kFrame) return !(is_fresh_ = false);
        if (result.status != ReadResult::Status::kEnd) continue;
        if (order_.options.once || is_fresh_) return false;
        source_ = sensor::undistorted(sensor::open_source(order_.input));
        is_fresh_ = true;
    }
}

bool Feed::next(Tick& tick) {
    SensorFrame frame;
    if (!read(frame)) return false;
    const Options& options = order_.options;
    const auto since_us =
        static_cast<std::int64_t>(std::llround(1e6 * static_cast<double>(number_++) / options.rate_hz));
    const auto on_device = [&](std::int64_t us) {
        const auto reset_us = static_cast<std::int64_t>(options.clock_reset_s * 1e6);
        const std::int64_t began = options.clock_reset_s > 0 && us >= reset_us ? reset_us : 0;
        // A first stamp of 0 is what some programs take for none.
        return 1000 + std::llround(static_cast<double>(us - began) * (1 + 1e-6 * options.clock_ppm));
    };
    tick.due_us = since_us + std::llround(1000 * options.jitter_ms * uniform(random_));
    tick.depth_us = on_device(since_us);
    tick.color_us = on_device(since_us + std::llround(1000 * options.color_offset_ms));
    const bool has_depth = uniform(random_) >= options.drop,
               has_color = uniform(random_) >= options.color_drop;
    tick.depth = has_depth ? in_millimetres(std::move(frame.depth), source_->camera().depth_units_per_metre)
                           : DepthImage();
    tick.color = has_color ? color_of(frame, camera().color) : RgbImage();
    return true;
}

}  // namespace planemap::virtual_camera
