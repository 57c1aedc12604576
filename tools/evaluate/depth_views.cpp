// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/depth_views.hpp"

#include <algorithm>

namespace planemap::evaluation {

DepthView::DepthView(const DepthImage& depth, const CameraInfo& info, std::int64_t time_us, int columns)
    : utime(time_us), color_from_depth(info.color_from_depth), noise(info.noise) {
    const int stride = std::max(1, (depth.width + columns - 1) / columns), first = stride / 2;
    const auto count = [&](int size) { return (size - first + stride - 1) / stride; };
    metres = Image<float>(count(depth.width), count(depth.height));
    camera = info.depth;
    camera.width = metres.width;
    camera.height = metres.height;
    camera.fx /= stride;
    camera.fy /= stride;
    camera.cx = (camera.cx - first) / stride;
    camera.cy = (camera.cy - first) / stride;
    for (int v = 0; v < metres.height; ++v) {
        for (int u = 0; u < metres.width; ++u) {
            const std::uint16_t raw = depth(first + u * stride, first + v * stride);
            const double z = info.metres(raw);
            if (is_valid_depth(raw) && z >= info.depth_min_m && z <= info.depth_max_m)
                metres(u, v) = static_cast<float>(z);
        }
    }
}

void SpreadViews::add(const DepthImage& depth, const CameraInfo& info, std::int64_t time_us) {
    const std::int64_t number = frames_++;
    if (number % every_ != 0) return;
    if (views_.size() == kMost) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < views_.size(); i += 2) {
            if (kept != i) views_[kept] = std::move(views_[i]);
            ++kept;
        }
        views_.erase(views_.begin() + static_cast<std::ptrdiff_t>(kept), views_.end());
        every_ *= 2;
        if (number % every_ != 0) return;
    }
    views_.emplace_back(depth, info, time_us, kColumns);
}

}  // namespace planemap::evaluation
