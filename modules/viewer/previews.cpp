// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/previews.hpp"

#include <algorithm>
#include <cmath>

#include "core/id_color.hpp"

namespace planemap::viewer {

namespace {

/// 0 at the nearest reading to trust, 1 at the farthest; steps are even in inverse depth, as the sensor's
/// are.
double farness(const CameraInfo& camera, double z_m) {
    const double nearest = std::max(camera.depth_min_m, 0.1);
    const double inverse = (1 / nearest - 1 / std::max(z_m, 1e-3)) / (1 / nearest - 1 / camera.depth_max_m);
    return std::clamp(inverse, 0.0, 1.0);
}

/// Red, yellow, green, cyan, blue from 0 to 1.
Rgb warm_to_cold(double value) {
    const auto channel = [&](double centre) {
        return static_cast<std::uint8_t>(255 * std::clamp(1.5 - 4 * std::abs(value - centre), 0.0, 1.0));
    };
    return {channel(0.1), channel(0.5), channel(0.9)};
}

/// A picture with one pixel for reduction x reduction readings; color(u, v, raw) is asked where there is one.
template <typename Color>
RgbImage picture(const DepthImage& depth, int reduction, const Color& color) {
    RgbImage out((depth.width + reduction - 1) / reduction, (depth.height + reduction - 1) / reduction);
    for (int v = 0; v < out.height; ++v) {
        for (int u = 0; u < out.width; ++u) {
            const std::uint16_t raw = depth(u * reduction, v * reduction);
            if (is_valid_depth(raw)) out(u, v) = color(u * reduction, v * reduction, raw);
        }
    }
    return out;
}

bool lies_in(const PlanarRegion& region, const Eigen::Vector3d& p, double tolerance_m) {
    if (std::abs(region.plane.normal.dot(p) + region.plane.d) > tolerance_m) return false;
    const Eigen::Vector3d in_box = region.box.frame_from_box.inverse() * p;
    return contains(region.outline, in_box.head<2>());
}

}  // namespace

int reduction_to(int width, int height, int longest) {
    int reduction = 1;
    while (reduction < 8 && (std::max(width, height) + reduction - 1) / reduction > longest) reduction *= 2;
    return reduction;
}

RgbImage depth_preview(const DepthImage& depth, const CameraInfo& camera, int reduction) {
    return picture(depth, reduction, [&](int, int, std::uint16_t raw) {
        return warm_to_cold(farness(camera, camera.metres(raw)));
    });
}

RgbImage region_preview(const DepthImage& depth, const CameraInfo& camera,
                        std::span<const PlanarRegion> regions, int reduction) {
    constexpr double kSigmas = 4, kLeast_m = 0.01;  // the region's own bend and what its outline smooths
    return picture(depth, reduction, [&](int u, int v, std::uint16_t raw) -> Rgb {
        const double z = camera.metres(raw);
        const Eigen::Vector3d p = camera.color_from_depth * camera.depth.unproject(u, v, z);
        for (std::size_t i = 0; i < regions.size(); ++i)
            if (lies_in(regions[i], p, kLeast_m + kSigmas * camera.noise.sigma(z)))
                return id_color(static_cast<int>(i));
        const auto gray = static_cast<std::uint8_t>(110 - 80 * farness(camera, z));
        return {gray, gray, gray};
    });
}

}  // namespace planemap::viewer
