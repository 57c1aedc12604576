// SPDX-License-Identifier: BSD-3-Clause
#include "core/lens_distortion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "temporary_folder.hpp"

namespace planemap {
namespace {

using Eigen::Vector2d;
using Model = LensDistortion::Model;
using testing::HasSubstr;

const PinholeCamera kCamera{640, 480, 517.3, 516.5, 318.6, 255.3};

/// Lenses that there are: TUM's freiburg1, a barrel, one with k4 to k6, as Azure Kinects have them, and two
/// fisheyes.
std::vector<LensDistortion> lenses() {
    return {{Model::kBrown, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}},
            {Model::kBrown, {-0.28, 0.07, 0.001, -0.002}},
            {Model::kBrown, {0.6, -2.6, 0.0005, -0.0003, 1.5, 0.47, -2.4, 1.45}},
            {Model::kFisheye, {0, 0, 0, 0}},
            {Model::kFisheye, {-0.02, 0.01, -0.003, 0.0005}}};
}

/// What OpenCV makes of one place.
Vector2d by_opencv(const LensDistortion& lens, const Vector2d& p) {
    const std::vector<cv::Point3d> points{{p.x(), p.y(), 1}};
    const cv::Mat identity = cv::Mat::eye(3, 3, CV_64F), none = cv::Mat::zeros(3, 1, CV_64F);
    std::vector<cv::Point2d> out;
    if (lens.model == Model::kBrown) {
        cv::projectPoints(points, none, none, identity, lens.coefficients, out);
    } else {
        cv::fisheye::projectPoints(points, out, none, none, identity, lens.coefficients);
    }
    return {out[0].x, out[0].y};
}

TEST(LensDistortion, IsOpenCVs) {
    for (const LensDistortion& lens : lenses()) {
        for (double x = -0.6; x <= 0.6; x += 0.1)
            for (double y = -0.45; y <= 0.45; y += 0.15)
                EXPECT_LT((distorted(lens, {x, y}) - by_opencv(lens, {x, y})).norm(), 1e-12)
                    << name_of(lens.model) << " " << x << " " << y;
    }
}

TEST(LensDistortion, IsUndone) {
    for (const LensDistortion& lens : lenses()) {
        for (double x = -0.6; x <= 0.6; x += 0.06) {
            for (double y = -0.45; y <= 0.45; y += 0.05) {
                const auto back = undistorted(lens, distorted(lens, {x, y}));
                ASSERT_TRUE(back) << x << " " << y;
                EXPECT_LT((*back - Vector2d(x, y)).norm(), 1e-9);
            }
        }
    }
}

TEST(LensDistortion, AFisheyeShowsNothingBeyondARightAngle) {
    const LensDistortion lens{Model::kFisheye, {0, 0, 0, 0}};
    const auto near = undistorted(lens, {1.5, 0});
    ASSERT_TRUE(near);
    EXPECT_NEAR(near->x(), std::tan(1.5), 1e-6);
    EXPECT_FALSE(undistorted(lens, {1.6, 0}));
    EXPECT_FALSE(undistorted(lens, {std::numeric_limits<double>::infinity(), 0}));
}

TEST(LensDistortion, APixelWithoutALensStays) {
    EXPECT_EQ(sensed_pixel(kCamera, std::nullopt, {3, 4}), Vector2d(3, 4));
    const Vector2d centre(kCamera.cx, kCamera.cy);
    for (const LensDistortion& lens : lenses())
        EXPECT_LT((sensed_pixel(kCamera, lens, centre) - centre).norm(), 1e-9);
}

/// What is wrong with it; empty if nothing is.
std::string fault(const LensDistortion& lens, const PinholeCamera& camera = kCamera) {
    FieldErrors errors("camera info");
    check_distortion(lens, camera, "color.distortion", errors);
    return test::error_of([&] { errors.throw_if_any(); });
}

TEST(LensDistortion, WhatNoImageCanBeUndoneByIsRefused) {
    for (const LensDistortion& lens : lenses()) EXPECT_EQ(fault(lens), "");
    EXPECT_THAT(fault({Model::kBrown, {0.1, 0, 0}}),
                HasSubstr("color.distortion is brown [0.1, 0, 0], must be 4, 5 or 8 coefficients"));
    EXPECT_THAT(fault({Model::kBrown, {}}), HasSubstr("is brown [], must be"));
    EXPECT_THAT(fault({Model::kBrown, std::vector<double>(1000)}), HasSubstr(", ...], must be"));
    EXPECT_THAT(fault({Model::kFisheye, {0, 0, 0, 0, 0}}), HasSubstr("must be 4 coefficients"));
    EXPECT_THAT(fault({Model::kBrown, {std::numeric_limits<double>::quiet_NaN(), 0, 0, 0}}),
                HasSubstr("must be finite"));
    EXPECT_THAT(fault({Model::kBrown, {0, 0, 0, 0}}, {640, 1, 500, 500, 320, 0}), HasSubstr("2 x 2"));
    // Polynomials that turn back within the image, tangential parts that fold it, a denominator without sign.
    for (const LensDistortion& lens : std::vector<LensDistortion>{{Model::kBrown, {-0.9, 0, 0, 0}},
                                                                  {Model::kBrown, {0, -2, 0, 0}},
                                                                  {Model::kBrown, {0, 0, 2, 0}},
                                                                  {Model::kBrown, {0, 0, 0, 0, 0, -3, 0, 0}},
                                                                  {Model::kBrown, {1e6, -1e6, 1e6, 1e6}},
                                                                  {Model::kFisheye, {-1, 0, 0, 0}}})
        EXPECT_THAT(fault(lens), HasSubstr("must be monotonic over the whole image: at pixel ("));
    EXPECT_EQ(fault({Model::kBrown, {-0.9, 0, 0, 0}}, {640, 480, 2000, 2000, 320, 240}), "")
        << "a small field of view sees no turn";
}

}  // namespace
}  // namespace planemap
