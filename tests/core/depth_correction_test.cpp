// SPDX-License-Identifier: BSD-3-Clause
#include "core/depth_correction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/lens_distortion.hpp"
#include "core/offset_at.hpp"

namespace planemap {
namespace {

CameraInfo camera_of(int width, int height) {
    CameraInfo camera;
    camera.depth = {width, height, 1.0 * width, 1.0 * width, width / 2.0, height / 2.0};
    camera.color = camera.depth;
    return camera;
}

DepthCorrection ramp() {
    DepthCorrection correction;
    for (std::size_t i = 0; i < DepthCorrection::kNodes; ++i) {
        const std::size_t row = i / DepthCorrection::kColumns, column = i % DepthCorrection::kColumns;
        correction.offsets[i] = 0.001 * static_cast<double>(column) - 0.002 * static_cast<double>(row);
    }
    return correction;
}

TEST(DepthCorrection, WeightsAddUpToOneAndStayInTheField) {
    const PinholeCamera depth = camera_of(64, 48).depth;
    for (double u = -20; u < 90; u += 3.7) {
        for (double v = -20; v < 70; v += 2.9) {
            const FieldWeights field = field_weights(depth, u, v);
            double sum = 0;
            for (std::size_t i = 0; i < 4; ++i) {
                EXPECT_LT(field.nodes[i], DepthCorrection::kNodes);
                EXPECT_GE(field.weights[i], 0);
                sum += field.weights[i];
            }
            EXPECT_NEAR(sum, 1, 1e-12);
        }
    }
}

TEST(DepthCorrection, NodesAreAtTheImagesCornersAndTheFieldIsLinearBetween) {
    const PinholeCamera depth = camera_of(64, 48).depth;
    EXPECT_NEAR(test::offset_at(ramp(), depth, -0.5, -0.5), ramp().offsets.front(), 1e-12);
    EXPECT_NEAR(test::offset_at(ramp(), depth, 63.5, 47.5), ramp().offsets.back(), 1e-12);
    EXPECT_NEAR(test::offset_at(ramp(), depth, 31.5, 23.5), 0.001 * 2 - 0.002 * 1.5, 1e-12);
}

TEST(DepthCorrection, NodesLieInTheImageThatTheLensDraws) {
    CameraInfo camera = camera_of(64, 48);
    camera.depth_distortion = LensDistortion{LensDistortion::Model::kBrown, {-0.3, 0, 0, 0}};
    const Eigen::Vector2d drawn = sensed_pixel(camera.depth, camera.depth_distortion, {60, 45});
    EXPECT_GT((drawn - Eigen::Vector2d(60, 45)).norm(), 1);
    const FieldWeights there = field_weights(camera.depth, drawn.x(), drawn.y()),
                       field = field_weights(camera, 60, 45);
    EXPECT_EQ(field.nodes, there.nodes);
    EXPECT_EQ(field.weights, there.weights);
}

TEST(DepthCorrection, InverseDepthsAddUp) {
    CameraInfo camera = camera_of(4, 4);
    camera.depth_correction.emplace();
    camera.depth_correction->offsets.fill(0.01);
    DepthImage depth(4, 4, 3000);
    depth(1, 1) = 0;
    depth(2, 1) = 65535;
    correct_depth(depth, camera);
    EXPECT_EQ(depth(0, 0), std::lround(1000 / (1 / 3.0 + 0.01)));
    EXPECT_EQ(depth(1, 1), 0);
    EXPECT_EQ(depth(2, 1), 65535);
}

TEST(DepthCorrection, WithoutACorrectionReadingsStay) {
    DepthImage depth(4, 4, 3000);
    correct_depth(depth, camera_of(4, 4));
    EXPECT_EQ(depth.pixels, DepthImage(4, 4, 3000).pixels);
}

TEST(DepthCorrection, WhatLeavesTheUnitsIsNoReading) {
    CameraInfo camera = camera_of(4, 4);
    camera.depth_correction.emplace();
    camera.depth_correction->offsets.fill(-0.09);
    DepthImage depth(4, 4, 60000);  // behind infinity
    correct_depth(depth, camera);
    EXPECT_EQ(depth.pixels, DepthImage(4, 4, 0).pixels);
}

TEST(DepthCorrection, BothTogetherAreTheirSum) {
    DepthCorrection first = ramp(), second = ramp();
    second.sigmas.fill(0.5e-3);
    const DepthCorrection both = composed(first, second);
    for (std::size_t i = 0; i < DepthCorrection::kNodes; ++i)
        EXPECT_DOUBLE_EQ(both.offsets[i], 2 * first.offsets[i]);
    EXPECT_EQ(both.sigmas, second.sigmas);
}

}  // namespace
}  // namespace planemap
