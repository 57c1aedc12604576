// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cell_grid.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "segmentation/scene.hpp"

namespace planemap {
namespace {

DepthImage noisy_depth(int width, int height, double invalid_share) {
    std::mt19937_64 random(5);
    std::uniform_int_distribution<int> noise(-30, 30);
    std::bernoulli_distribution invalid(invalid_share);
    DepthImage depth(width, height);
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u)
            depth(u, v) = invalid(random) ? std::uint16_t{0}
                                          : static_cast<std::uint16_t>(1500 + 3 * u + 2 * v + noise(random));
    }
    return depth;
}

InverseDepthSums brute_force(const DepthImage& depth, const CameraInfo& camera, int u0, int v0, int side) {
    InverseDepthSums sums;
    for (int v = v0; v < std::min(v0 + side, depth.height); ++v) {
        for (int u = u0; u < std::min(u0 + side, depth.width); ++u) {
            if (!is_valid_depth(depth(u, v))) continue;
            const double x = (u - camera.depth.cx) / camera.depth.fx,
                         y = (v - camera.depth.cy) / camera.depth.fy;
            const double w = 1 / camera.metres(depth(u, v));
            sums += {1, x, y, x * x, x * y, y * y, w, x * w, y * w, w * w};
        }
    }
    return sums;
}

class CellSides : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Sides, CellSides, testing::Values(4, 8, 12, 16, 20, 24, 28, 32));

TEST_P(CellSides, SumsEqualBruteForceEvenForCellsOverTheEdge) {
    const CameraInfo camera = scene::camera(75, 51);
    const DepthImage depth = noisy_depth(75, 51, 0.3);
    CellGrid grid;
    grid.reset(depth, camera, GetParam());
    ASSERT_EQ(grid.cell_px(), GetParam());
    double pixels = 0;
    for (int cell = 0; cell < grid.size(); ++cell) {
        const InverseDepthSums sums = grid.inverse_depth_sums(cell);
        const InverseDepthSums expected = brute_force(depth, camera, cell % grid.columns() * GetParam(),
                                                      cell / grid.columns() * GetParam(), GetParam());
        pixels += sums.n;
        ASSERT_EQ(sums.n, expected.n);
        EXPECT_NEAR(sums.x, expected.x, 1e-5);
        EXPECT_NEAR(sums.xx, expected.xx, 1e-5);
        EXPECT_NEAR(sums.xy, expected.xy, 1e-5);
        EXPECT_NEAR(sums.yy, expected.yy, 1e-5);
        EXPECT_NEAR(sums.w, expected.w, 1e-5 * (1 + expected.w));
        EXPECT_NEAR(sums.xw, expected.xw, 1e-5 * (1 + expected.w));
        EXPECT_NEAR(sums.yw, expected.yw, 1e-5 * (1 + expected.w));
        EXPECT_NEAR(sums.ww, expected.ww, 1e-5 * (1 + expected.ww));
        if (!expected.fit().valid) continue;
        EXPECT_NEAR(sums.fit().mse, expected.fit().mse, 1e-3 * expected.fit().mse);
    }
    EXPECT_EQ(pixels,
              static_cast<double>(std::count_if(depth.pixels.begin(), depth.pixels.end(), is_valid_depth)));
}

TEST_P(CellSides, LabelsGoToTheNearestPlaneWithinTheBand) {
    const CameraInfo camera = scene::camera(75, 51);
    DepthImage depth(75, 51, 2000);
    for (int v = 0; v < 51; ++v) {
        for (int u = 0; u < 75; ++u)
            depth(u, v) = static_cast<std::uint16_t>(u % 5 == 0 ? 0 : 1950 + 30 * (u % 5));
    }  // 1980, 2010, 2040, 2070 and invalid
    CellGrid grid;
    grid.reset(depth, camera, GetParam());
    const std::vector<Candidate> planes{{3, {0, 0, 1 / 1.99}}, {9, {0, 0, 1 / 2.032}}};
    const BorderBand band{0.025, 0, camera.noise};
    Image<std::uint16_t> labels(75, 51, 77);
    for (int cell = 0; cell < grid.size(); ++cell) {
        const auto counts = grid.label(cell, planes, band, labels);
        const int u0 = cell % grid.columns() * GetParam(), v0 = cell / grid.columns() * GetParam();
        int threes = 0, nines = 0;
        for (int v = v0; v < std::min(51, v0 + GetParam()); ++v) {
            for (int u = u0; u < std::min(75, u0 + GetParam()); ++u) {
                constexpr std::array<int, 5> kExpected{0, 3, 3, 9, 0};
                const int expected = kExpected[static_cast<std::size_t>(u % 5)];
                EXPECT_EQ(labels(u, v), expected) << u << " " << v;
                threes += labels(u, v) == 3;
                nines += labels(u, v) == 9;
            }
        }
        EXPECT_EQ(counts[0], threes);
        EXPECT_EQ(counts[1], nines);
    }
}

TEST_P(CellSides, MomentsOfLabelledPixelsEqualBruteForce) {
    const CameraInfo camera = scene::camera(75, 51);
    const DepthImage depth = noisy_depth(75, 51, 0.3);
    std::mt19937_64 random(9);
    std::bernoulli_distribution coin(0.6);
    Image<std::uint16_t> labels(75, 51);
    for (std::size_t i = 0; i < labels.pixels.size(); ++i)
        labels.pixels[i] = is_valid_depth(depth.pixels[i]) ? (coin(random) ? 2 : 1) : 0;
    CellGrid grid;
    grid.reset(depth, camera, GetParam());
    Moments moments;
    InverseDepthSums sums;
    for (int cell = 0; cell < grid.size(); ++cell) {
        const Candidate candidate{2, {0, 0, 1 / 1.6}};
        moments += grid.moments(cell, labels, candidate);
        sums += grid.inverse_depth_sums(cell, labels, candidate);
    }
    const Moments expected = scene::brute_force_moments(depth, camera, labels, 2);
    EXPECT_EQ(moments.count, expected.count);
    EXPECT_EQ(sums.n, expected.count);
    EXPECT_LT((moments.sum - expected.sum).norm(), 1e-6 * expected.sum.norm());
    EXPECT_LT((moments.scatter - expected.scatter).norm(), 1e-6 * expected.scatter.norm());
}

TEST(CellGridTest, NothingValidSumsToZero) {
    const CameraInfo camera = scene::camera(40, 30);
    const DepthImage depth(40, 30, 65535);
    CellGrid grid;
    grid.reset(depth, camera, 16);
    for (int cell = 0; cell < grid.size(); ++cell) EXPECT_EQ(grid.inverse_depth_sums(cell).n, 0);
}

TEST(CellGridTest, SideIsAMultipleOfFourWithinLimits) {
    const CameraInfo camera = scene::camera(40, 30);
    const DepthImage depth(40, 30);
    CellGrid grid;
    for (const auto& [asked, given] :
         std::vector<std::pair<double, int>>{{0.1, 4}, {9, 8}, {10.5, 12}, {100, 32}}) {
        grid.reset(depth, camera, asked);
        EXPECT_EQ(grid.cell_px(), given);
        EXPECT_GE(grid.columns() * grid.cell_px(), 40);
        EXPECT_GE(grid.rows() * grid.cell_px(), 30);
    }
}

}  // namespace
}  // namespace planemap
