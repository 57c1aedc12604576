// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/depth_views.hpp"

#include <algorithm>
#include <cmath>

#include "core/cloud_point.hpp"

namespace planemap::evaluation {

DepthView::DepthView(const DepthImage& depth, const CameraInfo& info, std::int64_t time_us, int columns,
                     const std::optional<RgbImage>& picture)
    : utime(time_us), color_from_depth(info.color_from_depth), noise(info.noise), readings(0) {
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
            if (!is_valid_depth(raw) || z < info.depth_min_m || z > info.depth_max_m) continue;
            metres(u, v) = static_cast<float>(z);
            ++readings;
        }
    }
    colors = Image<Rgb>(metres.width, metres.height, CloudPoint::kNoColor);
    if (picture) take_colors(*picture, info.color);
}

void DepthView::take_colors(const RgbImage& picture, const PinholeCamera& color_camera) {
    const double across = static_cast<double>(picture.width) / color_camera.width,
                 down = static_cast<double>(picture.height) / color_camera.height;
    for (int v = 0; v < metres.height; ++v) {
        for (int u = 0; u < metres.width; ++u) {
            const double z = static_cast<double>(metres(u, v));
            if (z == 0) continue;
            const Eigen::Vector3d p_color = color_from_depth * camera.unproject(u, v, z);
            if (p_color.z() <= 0) continue;
            const Eigen::Vector2d pixel = color_camera.project(p_color);
            if (!color_camera.sees(pixel)) continue;
            const int x = static_cast<int>(std::floor((pixel.x() + 0.5) * across)),
                      y = static_cast<int>(std::floor((pixel.y() + 0.5) * down));
            if (picture.contains(x, y)) colors(u, v) = picture(x, y);
        }
    }
}

void SpreadViews::add(const DepthImage& depth, const CameraInfo& info, std::int64_t time_us,
                      const Picture& picture) {
    if (!views_.wants_next()) return;
    int reduction = 8;  // no smaller than the view
    while (reduction > 1 && info.color.width < reduction * kColumns) reduction /= 2;
    views_.add(DepthView(depth, info, time_us, kColumns, picture ? picture(reduction) : std::nullopt));
}

}  // namespace planemap::evaluation
