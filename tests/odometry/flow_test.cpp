// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/flow.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/video/tracking.hpp>
#include <random>

#include "odometry/features.hpp"

namespace planemap::odometry {
namespace {

constexpr int kWidth = 160, kHeight = 120;

/// Blobs of random brightness, moved right by `shift` pixels, with noise.
GrayImage blobs(double shift, double contrast, double noise, std::uint64_t seed) {
    GrayImage image(kWidth, kHeight);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> n(0, noise);
    for (int v = 0; v < kHeight; ++v) {
        for (int u = 0; u < kWidth; ++u) {
            const double x = u - shift;
            const double value =
                128 + contrast * (std::sin(0.31 * x + 0.11 * v) + std::sin(0.23 * v - 0.17 * x) +
                                  std::sin(0.5 * x) * std::sin(0.45 * v));
            image(u, v) = static_cast<std::uint8_t>(std::clamp(value + n(random), 0.0, 255.0));
        }
    }
    return image;
}

/// Flow of points all over the image, and where it leads them.
struct GridFlow {
    std::vector<cv::Point2f> before, after;
    FlowResult result;
};
GridFlow flow_of_grid(const GrayImage& from, const GrayImage& to) {
    const FlowPyramid a = with_derivatives(make_flow_pyramid(from, 3, 11), 11),
                      b = make_flow_pyramid(to, 3, 11);
    GridFlow flow;
    for (int v = 20; v < kHeight - 20; v += 10)
        for (int u = 20; u < kWidth - 20; u += 10)
            flow.before.emplace_back(static_cast<float>(u), static_cast<float>(v));
    flow.after = flow.before;
    flow.result = track_flow(a, b, flow.before, flow.after, 11, 3, 10);
    return flow;
}

/// Share of points found, and of all points those found within a pixel of the true shift of 2.
std::pair<double, double> track(const GrayImage& from, const GrayImage& to) {
    const auto [before, after, result] = flow_of_grid(from, to);
    const std::vector<char>& found = result.found;
    double all = 0, right = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
        all += found[i];
        right +=
            found[i] && std::abs(after[i].x - before[i].x - 2) < 1 && std::abs(after[i].y - before[i].y) < 1;
    }
    return {all / static_cast<double>(found.size()), right / static_cast<double>(found.size())};
}

TEST(FlowTest, FindsWhatMoved) {
    const auto [found, right] = track(blobs(0, 30, 1, 1), blobs(2, 30, 1, 2));
    EXPECT_GT(right, 0.95);
    EXPECT_LT(found - right, 0.03);
}

TEST(FlowTest, FindsItInNoise) {
    const auto [found, right] = track(blobs(0, 30, 4, 1), blobs(2, 25, 4, 2));
    EXPECT_GT(right, 0.9);
}

TEST(FlowTest, FindsNothingInTheDark) {
    const auto [found, right] = track(blobs(0, 0, 4, 1), blobs(0, 0, 4, 2));
    EXPECT_LT(found, 0.2);
}

TEST(FlowTest, NoiseLooksAlikeByChanceAndNothingElseDoes) {
    const auto is_by_chance = [](const GrayImage& from, const GrayImage& to) {
        return flow_of_grid(from, to).result.is_by_chance();
    };
    EXPECT_FALSE(is_by_chance(blobs(0, 30, 1, 1), blobs(2, 30, 1, 2)));
    EXPECT_FALSE(is_by_chance(blobs(0, 30, 8, 1), blobs(2, 15, 8, 2)));  // dimmer, and noisy
    EXPECT_TRUE(is_by_chance(blobs(0, 0, 4, 1), blobs(0, 0, 4, 2)));
    EXPECT_TRUE(FlowResult{}.is_by_chance());
}

TEST(FlowTest, LevelsAreTheSameWithDerivatives) {
    const GrayImage image = blobs(0, 30, 1, 1);
    const FlowPyramid without = make_flow_pyramid(image, 3, 11), with = with_derivatives(without, 11);
    ASSERT_EQ(with.levels(), 3);
    ASSERT_EQ(without.levels(), 3);
    for (int i = 0; i < 3; ++i) {
        ASSERT_EQ(with.level(i).size(), without.level(i).size());
        EXPECT_EQ(with.level(i).cols, kWidth >> i);
        EXPECT_EQ(with.level(i).at<unsigned char>(10, 10), without.level(i).at<unsigned char>(10, 10));
    }
}

TEST(FlowTest, DerivativesAreThoseThatFlowMakesItself) {
    const GrayImage image = blobs(0, 30, 4, 1);
    const FlowPyramid pyramid = with_derivatives(make_flow_pyramid(image, 3, 11), 11);
    std::vector<cv::Mat> expected;
    cv::buildOpticalFlowPyramid(as_mat(image), expected, {11, 11}, 2, true);
    ASSERT_EQ(pyramid.images.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_EQ(pyramid.images[i].type(), expected[i].type());
        ASSERT_EQ(pyramid.images[i].size(), expected[i].size());
        EXPECT_EQ(cv::norm(pyramid.images[i], expected[i], cv::NORM_INF), 0) << i;
    }
}

}  // namespace
}  // namespace planemap::odometry
