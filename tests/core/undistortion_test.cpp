// SPDX-License-Identifier: BSD-3-Clause
#include "core/undistortion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/calib3d.hpp>
#include <random>

#include "core/lens_distortion.hpp"

namespace planemap {
namespace {

using Model = LensDistortion::Model;

CameraInfo seen_through(const std::optional<LensDistortion>& lens) {
    CameraInfo camera;
    camera.depth = camera.color = {160, 120, 130, 128, 78.3, 61.2};
    camera.depth_distortion = camera.color_distortion = lens;
    camera.validate();
    return camera;
}
const LensDistortion kBarrel{Model::kBrown, {-0.28, 0.07, 0.001, -0.002}};
const LensDistortion kPincushion{Model::kBrown, {0.25, 0, 0, 0}};
const LensDistortion kFisheye{Model::kFisheye, {-0.02, 0.01, -0.003, 0.0005}};

/// What the lens makes of a picture that is known everywhere: picture(ideal pixel).
template <typename T, typename Picture>
Image<T> drawn(const PinholeCamera& camera, const LensDistortion& lens, const Picture& picture) {
    Image<T> image(camera.width, camera.height);
    for (int v = 0; v < image.height; ++v) {
        for (int u = 0; u < image.width; ++u) {
            const auto p = undistorted(lens, {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy});
            image(u, v) = static_cast<T>(
                std::lround(picture(camera.fx * p->x() + camera.cx, camera.fy * p->y() + camera.cy)));
        }
    }
    return image;
}

TEST(Undistortion, WithoutALensNothingChanges) {
    const Undistortion none(seen_through(std::nullopt));
    DepthImage depth(160, 120, 700);
    GrayImage gray(160, 120, 9);
    depth(3, 4) = 0;
    const auto depth_before = depth.pixels, hidden = depth.pixels;
    none.undistort(depth);
    none.hide_unseen(depth);
    none.undistort(gray);
    EXPECT_EQ(depth.pixels, depth_before);
    EXPECT_EQ(gray.pixels, std::vector<std::uint8_t>(160 * 120, 9));
    EXPECT_EQ(none.pinhole(), none.sensed());
}

TEST(Undistortion, ThePinholeHasTheSameIntrinsics) {
    const Undistortion undistortion(seen_through(kBarrel));
    EXPECT_FALSE(undistortion.pinhole().depth_distortion);
    EXPECT_FALSE(undistortion.pinhole().color_distortion);
    EXPECT_EQ(undistortion.pinhole().depth, undistortion.sensed().depth);
    EXPECT_EQ(undistortion.sensed(), seen_through(kBarrel));
}

/// A slanting plane, whose inverse depth is linear over a pinhole's pixels and not over a lens's.
double inverse_depth(double u, double v) {
    return 0.4 + 0.0008 * (u - 80) - 0.0006 * (v - 60);
}

TEST(Undistortion, PlanesArePlanesAgain) {
    for (const LensDistortion& lens : {kBarrel, kPincushion, kFisheye}) {
        const CameraInfo camera = seen_through(lens);
        const auto depth_at = [](double u, double v) { return 1000 / inverse_depth(u, v); };
        DepthImage depth = drawn<std::uint16_t>(camera.depth, lens, depth_at);
        double worst_before = 0, worst = 0;
        const auto look = [&](double& largest) {
            int readings = 0;
            for (int v = 0; v < 120; ++v) {
                for (int u = 0; u < 160; ++u) {
                    if (depth(u, v) == 0) continue;
                    largest = std::max(largest, std::abs(1000.0 / depth(u, v) - inverse_depth(u, v)));
                    ++readings;
                }
            }
            return readings;
        };
        look(worst_before);
        Undistortion(camera).undistort(depth);
        EXPECT_GT(look(worst), 0.8 * 160 * 120);
        // Readings of the nearest pixel: half a pixel of both slopes, more where the lens draws smaller.
        EXPECT_LT(worst, 0.0012);
        EXPECT_GT(worst_before, 4 * worst);
    }
}

TEST(Undistortion, DepthIsNeverMixed) {
    const CameraInfo camera = seen_through(kBarrel);
    std::mt19937 random(3);
    DepthImage depth(160, 120);
    for (auto& raw : depth.pixels) raw = random() % 2 == 0 ? 1000 : random() % 3 == 0 ? 65535 : 4000;
    DepthImage out = depth;
    Undistortion(camera).undistort(out);
    for (const auto raw : out.pixels)
        EXPECT_TRUE(raw == 0 || raw == 1000 || raw == 4000 || raw == 65535) << raw;
    DepthImage hole(160, 120, 1000);
    hole(90, 70) = 0;
    Undistortion(camera).undistort(hole);
    EXPECT_LE(std::count(hole.pixels.begin(), hole.pixels.end(), 0), 4) << "a hole stays one";
    EXPECT_GE(std::count(hole.pixels.begin(), hole.pixels.end(), 0), 1);
}

TEST(Undistortion, MapsAreOpenCVs) {
    for (const LensDistortion& lens : {kBarrel, kPincushion, kFisheye}) {
        const CameraInfo camera = seen_through(lens);
        const PinholeCamera& c = camera.depth;
        const cv::Mat k = (cv::Mat_<double>(3, 3) << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
        cv::Mat x, y;
        if (lens.model == Model::kBrown) {
            cv::initUndistortRectifyMap(k, lens.coefficients, cv::Mat(), k, {c.width, c.height}, CV_32FC1, x,
                                        y);
        } else {
            cv::fisheye::initUndistortRectifyMap(k, lens.coefficients, cv::Mat::eye(3, 3, CV_64F), k,
                                                 {c.width, c.height}, CV_32FC1, x, y);
        }
        DepthImage columns(c.width, c.height);  // a depth image that says where it was read
        for (int v = 0; v < c.height; ++v)
            for (int u = 0; u < c.width; ++u) columns(u, v) = static_cast<std::uint16_t>(200 * v + u + 1);
        Undistortion(camera).undistort(columns);
        for (int v = 0; v < c.height; ++v) {
            for (int u = 0; u < c.width; ++u) {
                const float column = x.at<float>(v, u), row = y.at<float>(v, u);
                if (columns(u, v) == 0) {
                    EXPECT_FALSE(column > -0.49 && row > -0.49 && column < 159.49 && row < 119.49);
                    continue;
                }
                const int at = columns(u, v) - 1, from_row = at / 200;
                EXPECT_LT(std::abs(column - float(at % 200)), 0.501);
                EXPECT_LT(std::abs(row - float(from_row)), 0.501);
            }
        }
    }
}

TEST(Undistortion, ColourIsBilinear) {
    for (const LensDistortion& lens : {kBarrel, kPincushion, kFisheye}) {
        const CameraInfo camera = seen_through(lens);
        const auto light = [](double u, double v) {
            return 128 + 60 * std::sin(0.05 * u) + 50 * std::cos(0.06 * v);
        };
        GrayImage gray = drawn<std::uint8_t>(camera.color, lens, light);
        RgbImage color(gray.width, gray.height);
        for (std::size_t i = 0; i < gray.pixels.size(); ++i)
            color.pixels[i] = {gray.pixels[i], static_cast<std::uint8_t>(255 - gray.pixels[i]), 7};
        const Undistortion undistortion(camera);
        undistortion.undistort(gray);
        undistortion.undistort(color);
        DepthImage seen(160, 120, 1);
        undistortion.hide_unseen(seen);
        for (int v = 0; v < 120; ++v) {
            for (int u = 0; u < 160; ++u) {
                if (seen(u, v) == 0) continue;
                EXPECT_NEAR(gray(u, v), light(u, v), 2.5) << u << " " << v;
                EXPECT_EQ(color(u, v).r, gray(u, v));
                EXPECT_NEAR(color(u, v).g, 255 - gray(u, v), 1);
                EXPECT_EQ(color(u, v).b, 7);
            }
        }
    }
}

TEST(Undistortion, WhatTheLensDoesNotShowHasNoDepth) {
    const Undistortion undistortion(seen_through(kPincushion));
    DepthImage depth(160, 120, 1000), in_color(160, 120, 1000);
    undistortion.undistort(depth);
    undistortion.hide_unseen(in_color);
    EXPECT_EQ(depth.pixels, in_color.pixels) << "registered: the same lens";
    EXPECT_EQ(depth(0, 0), 0);
    EXPECT_EQ(depth(159, 119), 0);
    EXPECT_EQ(depth(80, 60), 1000);
    const Undistortion barrel(seen_through(kBarrel));
    DepthImage all(160, 120, 1000);
    barrel.undistort(all);
    EXPECT_EQ(std::count(all.pixels.begin(), all.pixels.end(), 1000), 160 * 120) << "it shows more";
}

TEST(Undistortion, ASmallPictureIsThatOfTheWhole) {
    const CameraInfo camera = seen_through(kBarrel);
    const Undistortion undistortion(camera);
    for (const int reduction : {1, 2, 8}) {
        RgbImage whole(160, 120), small((160 + reduction - 1) / reduction, (120 + reduction - 1) / reduction);
        for (int v = 0; v < 120; ++v)
            for (int u = 0; u < 160; ++u)
                whole(u, v) = {static_cast<std::uint8_t>(u), static_cast<std::uint8_t>(v), 0};
        for (int v = 0; v < small.height; ++v)
            for (int u = 0; u < small.width; ++u) small(u, v) = whole(u * reduction, v * reduction);
        undistortion.undistort(whole);
        undistortion.undistort_reduced(small, reduction);
        for (int v = 0; v < small.height; ++v) {
            for (int u = 0; u < small.width; ++u) {
                EXPECT_NEAR(small(u, v).r, whole(u * reduction, v * reduction).r, reduction);
                EXPECT_NEAR(small(u, v).g, whole(u * reduction, v * reduction).g, reduction);
            }
        }
    }
}

}  // namespace
}  // namespace planemap
