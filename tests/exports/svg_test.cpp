// SPDX-License-Identifier: BSD-3-Clause
#include "exports/svg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/random_values.hpp"

namespace planemap::exports {
namespace {

using ::testing::HasSubstr;

TEST(RoundLength, IsTheLargestRoundOneThatIsNotOver) {
    test::Random random(3);
    for (int i = 0; i < 200; ++i) {
        const double most = std::pow(10, random.uniform(-3, 4)), length = round_length(most);
        const double digit = length / std::pow(10, std::floor(std::log10(length * 1.0001)));
        EXPECT_LE(length, most * (1 + 1e-12));
        EXPECT_GT(2.5 * length, most * (1 - 1e-12)) << "the next larger one is 2 or 2.5 times as long";
        EXPECT_TRUE(std::abs(digit - 1) < 1e-9 || std::abs(digit - 2) < 1e-9 || std::abs(digit - 5) < 1e-9)
            << length;
    }
}

TEST(Fit, FillsTheAreaWithYUpThePage) {
    const Area area{{100, 50}, {500, 250}};
    const Fit fit({{-1, 3}, {1, 4}, {0, 3.5}}, area);
    EXPECT_DOUBLE_EQ(fit.scale(), 200);
    EXPECT_TRUE(fit({-1, 3}).isApprox(Eigen::Vector2d(100, 250)));
    EXPECT_TRUE(fit({1, 4}).isApprox(Eigen::Vector2d(500, 50)));
}

TEST(Fit, OfNoPointsAndOfOneIsFinite) {
    const Area area{{0, 0}, {10, 10}};
    EXPECT_TRUE(Fit({}, area)({0, 0}).allFinite());
    EXPECT_TRUE(Fit({{7, 7}}, area)({7, 7}).isApprox(Eigen::Vector2d(5, 5)));
}

TEST(DrawingArea, LeavesRoomForTheLegend) {
    const Area beside = drawing_area(true), across = drawing_area(false);
    EXPECT_LT(beside.high.x(), across.high.x());
    EXPECT_EQ(beside.low, across.low);
    EXPECT_LE(across.high.x(), kPageWidth_px);
    EXPECT_LE(across.high.y(), kPageHeight_px);
}

TEST(Css, IsDarkerWithAShadeAndStaysAColour) {
    EXPECT_EQ(css({10, 200, 255}), "rgb(10,200,255)");
    EXPECT_EQ(css({10, 200, 255}, 0.5), "rgb(5,100,128)");
    EXPECT_EQ(css({10, 200, 255}, 9), "rgb(90,255,255)");
}

TEST(TrajectoryLine, OfNoPosesIsNothing) {
    const auto project = [](const Eigen::Vector3d& p) { return Eigen::Vector2d(p.head<2>()); };
    EXPECT_EQ(trajectory_line({}, project), "");
    EXPECT_THAT(trajectory_line({{0, Pose::Identity()}}, project), HasSubstr("M0.0,0.0"));
}

TEST(CountOf, HasAPlural) {
    EXPECT_EQ(count_of(0, "plane"), "0 planes");
    EXPECT_EQ(count_of(1, "plane"), "1 plane");
}

}  // namespace
}  // namespace planemap::exports
