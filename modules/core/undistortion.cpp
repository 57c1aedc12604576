// SPDX-License-Identifier: BSD-3-Clause
#include "core/undistortion.hpp"

#include <algorithm>
#include <cmath>

#include "core/lens_distortion.hpp"

namespace planemap {

namespace {

CameraInfo without_distortion(CameraInfo camera) {
    camera.depth_distortion.reset();
    camera.color_distortion.reset();
    return camera;
}

std::size_t pixels_of(const PinholeCamera& camera) {
    return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
}

/// Calls with each pixel's index and where the lens drew it, row by row.
template <typename Take>
void for_each_pixel(const PinholeCamera& camera, const std::optional<LensDistortion>& lens,
                    const Take& take) {
    std::uint32_t index = 0;
    for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u)
            take(index++, sensed_pixel(camera, lens, {double(u), double(v)}));
}

}  // namespace

Undistortion::Undistortion(const CameraInfo& sensed)
    : sensed_(sensed), pinhole_(without_distortion(sensed)) {}

const std::vector<std::int32_t>& Undistortion::depth_map() const {
    std::call_once(depth_made_, [&] {
        const PinholeCamera& camera = sensed_.depth;
        depth_.resize(pixels_of(camera), -1);
        for_each_pixel(camera, sensed_.depth_distortion, [&](std::uint32_t i, const Eigen::Vector2d& from) {
            if (!camera.sees(from)) return;
            depth_[i] = static_cast<std::int32_t>(std::floor(from.y() + 0.5)) * camera.width +
                        static_cast<std::int32_t>(std::floor(from.x() + 0.5));
        });
    });
    return depth_;
}

const Undistortion::ColorMap& Undistortion::color_map() const {
    std::call_once(color_made_, [&] {
        const PinholeCamera& camera = sensed_.color;
        color_.mixes.resize(pixels_of(camera));
        for_each_pixel(camera, sensed_.color_distortion, [&](std::uint32_t i, const Eigen::Vector2d& from) {
            if (!camera.sees(from)) color_.unseen.push_back(i);
            if (!from.allFinite()) return;
            const double x = std::clamp(from.x(), 0.0, camera.width - 1.0),
                         y = std::clamp(from.y(), 0.0, camera.height - 1.0);
            const int left = std::min(static_cast<int>(x), camera.width - 2),
                      top = std::min(static_cast<int>(y), camera.height - 2);
            const auto share = [](double part) {
                return static_cast<std::uint8_t>(std::min(std::lround(256 * part), 255L));
            };
            color_.mixes[i] = {static_cast<std::uint32_t>(top * camera.width + left), share(x - left),
                               share(y - top)};
        });
    });
    return color_;
}

void Undistortion::undistort(DepthImage& depth) const {
    if (!sensed_.depth_distortion) return;
    const std::vector<std::int32_t>& map = depth_map();
    DepthImage out(depth.width, depth.height);
    const std::uint16_t* const from = depth.pixels.data();
    std::transform(map.begin(), map.end(), out.pixels.begin(),
                   [&](std::int32_t index) { return index < 0 ? std::uint16_t{0} : from[index]; });
    depth = std::move(out);
}

template <typename Pixel>
void Undistortion::mix(Image<Pixel>& image) const {
    if (!sensed_.color_distortion) return;
    constexpr std::size_t kChannels = sizeof(Pixel);
    Image<Pixel> out(image.width, image.height);
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(image.pixels.data());
    auto* to = reinterpret_cast<std::uint8_t*>(out.pixels.data());
    const std::size_t row = kChannels * static_cast<std::size_t>(image.width);
    for (const Mix& mix : color_map().mixes) {
        const std::uint8_t* from = bytes + kChannels * mix.index;
        const std::uint32_t right = mix.right, below = mix.below;
        for (std::size_t i = 0; i < kChannels; ++i, ++from) {
            const std::uint32_t above = (256 - right) * from[0] + right * from[kChannels];
            const std::uint32_t under = (256 - right) * from[row] + right * from[row + kChannels];
            *to++ = static_cast<std::uint8_t>(((256 - below) * above + below * under + (1U << 15)) >> 16);
        }
    }
    image = std::move(out);
}

void Undistortion::undistort(GrayImage& gray) const {
    mix(gray);
}

void Undistortion::undistort(RgbImage& color) const {
    mix(color);
}

void Undistortion::undistort_reduced(RgbImage& color, int reduction) const {
    if (!sensed_.color_distortion) return;
    const std::vector<Mix>& mixes = color_map().mixes;
    const RgbImage from = color;
    const auto full = static_cast<std::uint32_t>(sensed_.color.width);
    for (int v = 0; v < color.height; ++v) {
        for (int u = 0; u < color.width; ++u) {
            const auto pixel =
                static_cast<std::size_t>(v * reduction) * full + static_cast<std::size_t>(u * reduction);
            const Mix& mix = mixes[std::min(pixel, mixes.size() - 1)];
            color(u, v) = from(static_cast<int>(mix.index % full) / reduction,
                               static_cast<int>(mix.index / full) / reduction);
        }
    }
}

void Undistortion::hide_unseen(DepthImage& depth_in_color) const {
    if (!sensed_.color_distortion) return;
    for (const std::uint32_t pixel : color_map().unseen) depth_in_color.pixels[pixel] = 0;
}

}  // namespace planemap
