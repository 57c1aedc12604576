// SPDX-License-Identifier: BSD-3-Clause
#include "segment/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

namespace planemap {

namespace {

/// Well-separated colours: hues a golden section apart, in three strengths.
Rgb color_of(std::uint16_t label) {
    const double hue = std::fmod(0.618034 * label, 1) * 6;
    const double low = 0.15 + 0.2 * (label % 3);
    const auto channel = [&](double offset) {
        const double distance = std::abs(std::fmod(hue + offset, 6) - 3);
        const double strength = std::clamp(distance - 1, 0.0, 1.0);
        return static_cast<std::uint8_t>(255 * (low + (1 - low) * strength));
    };
    return {channel(0), channel(4), channel(2)};
}

/// How much a surface faces the camera, 0 to 1, from the readings two pixels around; 0 without a reading,
/// 0.25 where they tell nothing.
double shade(const DepthImage& depth, const CameraInfo& camera, int u, int v) {
    if (!is_valid_depth(depth(u, v))) return 0;
    constexpr int kStep = 2;
    const auto point = [&](int x, int y) -> Eigen::Vector3d {
        return camera.depth.unproject(x, y, camera.metres(depth(x, y)));
    };
    const auto readable = [&](int x, int y) { return depth.contains(x, y) && is_valid_depth(depth(x, y)); };
    if (!readable(u - kStep, v) || !readable(u + kStep, v) || !readable(u, v - kStep) ||
        !readable(u, v + kStep))
        return 0.25;
    const Eigen::Vector3d across = point(u + kStep, v) - point(u - kStep, v);
    const Eigen::Vector3d down = point(u, v + kStep) - point(u, v - kStep);
    const double cosine = std::abs(across.cross(down).normalized().dot(point(u, v).normalized()));
    return std::isfinite(cosine) ? 0.25 + 0.75 * cosine : 0.25;
}

void draw_outline(const PinholeCamera& camera, const PlanarRegion& region, cv::Mat& canvas) {
    for (const Ring& ring : region.outline.rings) {
        std::vector<cv::Point> polygon;
        for (const Eigen::Vector2d& vertex : ring) {
            const Eigen::Vector3d p = region.box.frame_from_box * Eigen::Vector3d(vertex.x(), vertex.y(), 0);
            if (!(p.z() > 0)) continue;
            const Eigen::Vector2d pixel = camera.project(p);
            polygon.emplace_back(static_cast<int>(std::lround(std::clamp(pixel.x(), -1e4, 1e4))),
                                 static_cast<int>(std::lround(std::clamp(pixel.y(), -1e4, 1e4))));
        }
        if (polygon.size() > 1) cv::polylines(canvas, polygon, true, cv::Scalar(255, 255, 255), 1);
    }
}

constexpr double kLeastForNumber = 100;  // pixels: on less a number cannot be read

/// For each region the pixel of it that is nearest to the mean of its pixels; (-1, -1) for a small one.
std::vector<cv::Point> number_places(const Image<std::uint16_t>& labels, std::size_t regions) {
    struct Mean {
        double u = 0, v = 0, n = 0, least = 1e300;
    };
    std::vector<Mean> means(regions + 1);
    std::vector<cv::Point> places(regions + 1, cv::Point(-1, -1));
    const auto for_each_pixel = [&](const auto& action) {
        for (int v = 0; v < labels.height; ++v) {
            for (int u = 0; u < labels.width; ++u) {
                if (labels(u, v) > 0 && labels(u, v) <= regions) action(u, v, labels(u, v));
            }
        }
    };
    for_each_pixel([&](int u, int v, std::uint16_t label) {
        means[label].u += u, means[label].v += v, means[label].n += 1;
    });
    for_each_pixel([&](int u, int v, std::uint16_t label) {
        Mean& mean = means[label];
        const double distance = std::hypot(u - mean.u / mean.n, v - mean.v / mean.n);
        if (distance >= mean.least || mean.n < kLeastForNumber) return;
        mean.least = distance;
        places[label] = {u, v};
    });
    return places;
}

void draw_number(int number, const cv::Point& place, cv::Mat& canvas) {
    if (place.x < 0) return;
    const std::string text = std::to_string(number);
    constexpr double kScale = 0.4;
    int below = 0;
    const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kScale, 1, &below);
    const cv::Point at(place.x - size.width / 2, place.y + size.height / 2);
    cv::putText(canvas, text, at, cv::FONT_HERSHEY_SIMPLEX, kScale, cv::Scalar(0, 0, 0), 3);
    cv::putText(canvas, text, at, cv::FONT_HERSHEY_SIMPLEX, kScale, cv::Scalar(255, 255, 255), 1);
}

}  // namespace

RgbImage draw_overlay(const DepthImage& depth, const CameraInfo& camera,
                      const segmentation::Segmentation& segmentation) {
    RgbImage picture(depth.width, depth.height);
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            const double light = shade(depth, camera, u, v);
            const std::uint16_t label = segmentation.labels(u, v);
            const Rgb color = label == 0 ? Rgb{110, 110, 110} : color_of(label);
            const auto lit = [&](std::uint8_t channel) { return static_cast<std::uint8_t>(light * channel); };
            picture(u, v) = {lit(color.r), lit(color.g), lit(color.b)};
        }
    }
    static_assert(sizeof(Rgb) == 3);
    cv::Mat canvas(picture.height, picture.width, CV_8UC3, picture.pixels.data());
    for (const PlanarRegion& region : segmentation.regions) draw_outline(camera.depth, region, canvas);
    const auto places = number_places(segmentation.labels, segmentation.regions.size());
    for (std::size_t i = 1; i < places.size(); ++i) draw_number(static_cast<int>(i), places[i], canvas);
    return picture;
}

}  // namespace planemap
