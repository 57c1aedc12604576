// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/planar_patches.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>
#include <vector>

#include "room.hpp"

namespace planemap::odometry {
namespace {

TEST(PlanarPatches, CellsLieOnThePlanesOfTheRoom) {
    const CameraInfo camera = room_camera();
    const RenderedFrame frame = render_room(camera, Pose::Identity());
    const PlanarPatches patches(frame.depth, camera.color, camera, 16);
    EXPECT_GT(patches.cells(), 150);
    const Plane* wall = patches.at({160, 120});
    ASSERT_TRUE(wall);
    EXPECT_LT(angle_between(wall->normal, {0, 0, -1}), 0.01);
    EXPECT_NEAR(wall->d, 3, 0.01);
    EXPECT_EQ(patches.at({-20, 5}), nullptr);
    EXPECT_EQ(patches.at({1e9, 5}), nullptr);
}

TEST(PlanarPatches, EmptyDepthHasNone) {
    const CameraInfo camera = room_camera();
    const DepthImage empty(320, 240, 0);
    EXPECT_EQ(PlanarPatches(empty, camera.color, camera, 16).cells(), 0);
    EXPECT_TRUE(sample_depth(empty, camera.color, camera, 8).empty());
    const PatchMatch match = match_patches(PlanarPatches(), camera.color, {}, Pose::Identity(), 0.04, 1);
    EXPECT_EQ(match.matched, 0);
    EXPECT_EQ(match.term.information.norm(), 0);
}

TEST(PlanarPatches, StepsOfTheMatchLeadToTheTrueMotion) {
    const CameraInfo camera = room_camera();
    const RenderedFrame before = render_room(camera, Pose::Identity());
    Twist twist;
    twist << 0.02, -0.01, 0.03, 0.01, -0.015, 0.01;
    const Pose room_from_camera = pose_from_twist(twist);
    const RenderedFrame after = render_room(camera, room_from_camera);
    const PlanarPatches patches(before.depth, camera.color, camera, 16);
    const auto samples = sample_depth(after.depth, camera.color, camera, 8);
    Pose camera_from_keyframe = Pose::Identity();
    for (int i = 0; i < 10; ++i) {
        const PatchMatch match = match_patches(patches, camera.color, samples, camera_from_keyframe, 0.1, 1);
        QuadraticTerm sum;
        for (const QuadraticTerm& tile : match.tiles) {
            sum.information += tile.information;
            sum.gradient += tile.gradient;
        }
        EXPECT_GT(match.tiles.size(), 6u);
        EXPECT_LT((sum.information - match.term.information).norm(), 1e-9 * sum.information.norm());
        EXPECT_LT((sum.gradient - match.term.gradient).norm(), 1e-9 * (1 + sum.gradient.norm()));
        camera_from_keyframe =
            pose_from_twist(-match.term.information.ldlt().solve(match.term.gradient)) * camera_from_keyframe;
    }
    EXPECT_LT(twist_from_pose(camera_from_keyframe * room_from_camera).norm(), 2e-3);
}

TEST(PlanarPatches, OneWallSaysNothingAlongItself) {
    const CameraInfo camera = room_camera();
    const RenderedFrame frame = render_room(camera, Pose::Identity(), true, {{{0, 0, -1}, 2}});
    const PlanarPatches patches(frame.depth, camera.color, camera, 16);
    const auto samples = sample_depth(frame.depth, camera.color, camera, 8);
    const Matrix6d information =
        match_patches(patches, camera.color, samples, Pose::Identity(), 0.04, 1).term.information;
    EXPECT_LT(information(0, 0), 1e-3 * information(2, 2));
    EXPECT_LT(information(1, 1), 1e-3 * information(2, 2));
    EXPECT_LT(information(5, 5), 1e-3 * information(3, 3));
}

TEST(PlanarPatches, CellsOnARegionTakeItsPlane) {
    const CameraInfo camera = room_camera();
    DepthImage depth = render_room(camera, Pose::Identity(), true, {{{0, 0, -1}, 2}}).depth;
    std::mt19937_64 random(4);
    std::normal_distribution<double> noise(0, camera.noise.sigma(2) * camera.depth_units_per_metre);
    for (std::uint16_t& raw : depth.pixels)
        raw = static_cast<std::uint16_t>(std::lround(raw + noise(random)));
    PlanarPatches patches(depth, camera.color, camera, 16);
    const auto samples = sample_depth(depth, camera.color, camera, 8);
    const auto hold_along_wall = [&] {
        return match_patches(patches, camera.color, samples, Pose::Identity(), 0.04, 1)
            .term.information(0, 0);
    };
    const auto pretended = [&] {
        return information_of_tilts(patches, camera.color, samples, Pose::Identity(), 0.04, 1);
    };
    const double tilted = hold_along_wall();
    // All that holds it there is noise, and known to be.
    EXPECT_NEAR(pretended()(0, 0) / tilted, 1, 0.3);
    EXPECT_LT(pretended()(2, 2), 0.1 * tilted) << "across the wall it is held";
    PlanarRegion wall;
    wall.plane = {{0, 0, -1}, 2};
    wall.outline.rings = {{{-3, -3}, {3, -3}, {3, 3}, {-3, 3}}};
    wall.box.frame_from_box = Pose(Eigen::Translation3d(0, 0, 2));
    wall.box.half_extents = {3, 3, 0};
    patches.lay_on(std::vector{wall}, camera.noise);
    EXPECT_LT(hold_along_wall(), 0.2 * tilted);
    EXPECT_LT(pretended()(0, 0), 0.2 * tilted);
    const Plane* cell = patches.at({160, 120});
    ASSERT_TRUE(cell);
    EXPECT_EQ(cell->d, 2);
    // A region elsewhere changes nothing.
    PlanarPatches other(depth, camera.color, camera, 16);
    const Plane before = *other.at({160, 120});
    wall.plane.d = 2.2;
    other.lay_on(std::vector{wall}, camera.noise);
    EXPECT_EQ(other.at({160, 120})->d, before.d);
}

TEST(SamplesTest, AreWhereTheyWereAtTheImagesTime) {
    Twist over_readout;
    over_readout << 0.01, 0, 0, 0, 0.02, 0;
    const Eigen::Vector3d p(0.1, 0.2, 2);
    std::vector<DepthSample> samples;
    for (const double share : {-0.5, 0.0, 0.4})
        samples.push_back({pose_from_twist(share * over_readout) * p, 0.002, share});
    for (const DepthSample& sample : without_shutter(samples, over_readout))
        EXPECT_LT((sample.point - p).norm(), 1e-4);
    for (std::size_t i = 0; i < samples.size(); ++i)
        EXPECT_EQ(without_shutter(samples, Twist::Zero())[i].point, samples[i].point);
}

}  // namespace
}  // namespace planemap::odometry
