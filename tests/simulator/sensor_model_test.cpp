// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/sensor_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/geometry/angle.hpp"

namespace planemap::simulator {
namespace {

using Eigen::Vector3d;

const PinholeCamera kCamera{320, 240, 525, 525, 159.5, 119.5};

/// A wall `distance` m before the camera, turned about its vertical axis.
World wall_at(double distance, double turned = 0) {
    WorldBuilder builder("wall", 1, 8);
    const Vector3d right(std::cos(turned), 0, std::sin(turned));
    builder.add_panel("wall", Vector3d(0, -6, distance) - 8 * right, right, Vector3d::UnitY(), 16, 12, {});
    return builder.world();
}

DepthImage sense(const World& world, const DepthSensorOptions& options, std::uint64_t seed = 1) {
    static const GaussianTable kGaussian;
    return sense_depth(world, render_view(world, kCamera, Pose::Identity()), options, kGaussian, seed);
}

TEST(DepthSensor, NoiseFollowsTheModel) {
    DepthSensorOptions options;
    options.units_per_metre = 10000;
    for (const double z : {0.8, 1.2, 1.7, 2.5, 3.3}) {
        const DepthImage depth = sense(wall_at(z), options);
        double sum = 0, squares = 0, count = 0;
        for (const std::uint16_t raw : depth.pixels) {
            if (!is_valid_depth(raw)) continue;
            const double error = raw / options.units_per_metre - z;
            sum += error;
            squares += error * error;
            ++count;
        }
        const double sigma = std::sqrt(squares / count - sum * sum / count / count);
        EXPECT_GT(count, 0.95 * static_cast<double>(depth.pixels.size()));
        EXPECT_NEAR(sigma, options.sigma.sigma(z), 0.15 * options.sigma.sigma(z)) << z;
        EXPECT_NEAR(sum / count, 0, 0.3 * options.sigma.sigma(z)) << z;
    }
}

TEST(DepthSensor, DisparityComesInSteps) {
    DepthSensorOptions options;
    options.units_per_metre = 10000;
    const DepthImage depth = sense(wall_at(3), options);
    const std::set<std::uint16_t> levels(depth.pixels.begin(), depth.pixels.end());
    EXPECT_LT(levels.size(), 15u);
    EXPECT_GT(levels.size(), 3u);
}

TEST(DepthSensor, WithoutNoiseDepthIsExactToAUnit) {
    DepthSensorOptions options;
    options.noise = false;
    const World world = wall_at(2, 0.5);
    const View view = render_view(world, kCamera, Pose::Identity());
    const DepthImage depth = sense(world, options);
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) EXPECT_NEAR(depth(u, v), 1000 * view.depth(u, v), 0.51);
    }
}

TEST(DepthSensor, NothingOutsideTheRange) {
    for (const double z : {0.3, 4.6}) {
        const DepthImage depth = sense(wall_at(z), {});
        for (const std::uint16_t raw : depth.pixels) ASSERT_EQ(raw, 0);
    }
}

TEST(DepthSensor, GrazingReadingsAreLost) {
    const auto share = [](double angle_deg) {
        const DepthImage depth = sense(wall_at(1.2, radians(angle_deg)), {});
        int valid = 0;
        for (int v = 100; v < 140; ++v) {
            for (int u = 150; u < 170; ++u) valid += is_valid_depth(depth(u, v)) ? 1 : 0;
        }
        return valid / 800.0;
    };
    EXPECT_EQ(share(60), 1);
    EXPECT_GT(share(80), 0.1);
    EXPECT_LT(share(80), 0.9);
    EXPECT_EQ(share(87), 0);
}

TEST(DepthSensor, AnObjectCastsAShadowToItsLeft) {
    WorldBuilder builder("shadow", 1, 8);
    builder.add_panel("wall", {-8, -6, 2.5}, Vector3d::UnitX(), Vector3d::UnitY(), 16, 12, {});
    builder.add_panel("board", {-0.1, -3, 1}, Vector3d::UnitX(), Vector3d::UnitY(), 0.2, 6, {});
    const DepthImage depth = sense(builder.world(), {});
    const int left = static_cast<int>(159.5 - 52.5), right = static_cast<int>(159.5 + 52.5);
    // The band is f b (1/1 - 1/2.5) = 23.6 pixels wide.
    int dark = 0;
    for (int u = left - 40; u < left; ++u) dark += is_valid_depth(depth(u, 120)) ? 0 : 1;
    EXPECT_NEAR(dark, 23.6, 3);
    for (int u = right + 4; u < right + 40; ++u) EXPECT_TRUE(is_valid_depth(depth(u, 120))) << u;
    for (int u = left + 4; u < right - 4; ++u) EXPECT_NEAR(depth(u, 120), 1000, 20) << u;
}

TEST(DepthSensor, SeedsDecide) {
    const World world = wall_at(2);
    EXPECT_EQ(sense(world, {}, 5).pixels, sense(world, {}, 5).pixels);
    EXPECT_NE(sense(world, {}, 5).pixels, sense(world, {}, 6).pixels);
}

TEST(DepthSensor, BadOptionsAreAllNamed) {
    DepthSensorOptions options;
    options.baseline_m = 0;
    options.max_m = std::nan("");
    options.grazing_to_deg = 91;
    try {
        options.validate();
        FAIL();
    } catch (const std::invalid_argument& error) {
        for (const char* field : {"baseline_m", "max_m", "grazing_to_deg"}) {
            EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << field;
        }
    }
}

TEST(ColorSensor, AveragesExposuresAndAddsNoise) {
    const GaussianTable gaussian;
    for (const int exposures : {1, 3, 16}) {
        const auto lanes = static_cast<std::uint64_t>(exposures) * (100 | 50ull << 16 | 200ull << 32);
        const LaneImage sum(64, 48, lanes);
        const RgbImage clean = sense_color(sum, exposures, 0, gaussian, 1);
        for (const Rgb& pixel : clean.pixels) {
            EXPECT_NEAR(pixel.r, 100, 1);
            EXPECT_NEAR(pixel.g, 200, 1);
            EXPECT_NEAR(pixel.b, 50, 1);
        }
        double squares = 0;
        const RgbImage noisy = sense_color(sum, exposures, 4, gaussian, 1);
        for (const Rgb& pixel : noisy.pixels) squares += (pixel.r - 100) * (pixel.r - 100);
        EXPECT_NEAR(std::sqrt(squares / static_cast<double>(noisy.pixels.size())), 4, 0.4);
    }
}

}  // namespace
}  // namespace planemap::simulator
