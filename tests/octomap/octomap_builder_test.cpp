// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_builder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <random>
#include <set>

#include "core/files.hpp"

namespace planemap {
namespace {

using ::testing::HasSubstr;

CameraInfo small_camera() {
    CameraInfo camera;
    camera.depth = camera.color = {64, 48, 52.5, 52.5, 31.5, 23.5};
    return camera;
}

/// A wall two metres ahead with a box before it and some invalid pixels.
DepthImage room(const CameraInfo& camera, std::uint16_t shift = 0) {
    DepthImage depth(camera.depth.width, camera.depth.height, static_cast<std::uint16_t>(2000 + shift));
    for (int v = 10; v < 30; ++v)
        for (int u = 20; u < 40; ++u) depth(u, v) = static_cast<std::uint16_t>(1200 + 5 * u);
    for (int u = 0; u < 20; ++u) depth(u, 3) = u % 2 ? 0 : 65535;
    return depth;
}

Pose pose(double x, double angle) {
    return make_pose({x, 0.02, -0.1},
                     Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d(0.2, 1, 0.1).normalized())));
}

KeyframeTrajectory trajectory(const std::vector<Pose>& poses) {
    KeyframeTrajectory result;
    for (const Pose& p : poses) result.keyframes.push_back({static_cast<int>(result.keyframes.size()), 0, p});
    return result;
}

TEST(OctomapBuilder, PutsLeavesWhereTheDepthIs) {
    const CameraInfo camera = small_camera();
    OctomapBuilder builder;
    ASSERT_TRUE(builder.add(0, DepthImage(64, 48, 2000), camera, Pose::Identity()));
    builder.flush();
    const auto voxels = builder.occupied_voxels();
    ASSERT_GT(voxels.size(), 500u);
    for (const auto& p : voxels) EXPECT_NEAR(p.z(), 2.0, 0.05);
    EXPECT_EQ(voxels.size(), builder.sizes().occupied_voxels);
    const auto* free = builder.tree().search(0, 0, 1);
    ASSERT_NE(free, nullptr);
    EXPECT_FALSE(builder.tree().isNodeOccupied(free));
}

TEST(OctomapBuilder, UsesTheDepthCamerasOwnPose) {
    CameraInfo camera = small_camera();
    camera.registered = false;
    camera.color_from_depth = make_pose({0.5, 0, 0}, Eigen::Quaterniond::Identity());
    OctomapBuilder moved, plain;
    moved.add(0, room(camera), camera, Pose::Identity());
    plain.add(0, room(camera), small_camera(), make_pose({0.5, 0, 0}, Eigen::Quaterniond::Identity()));
    moved.flush();
    plain.flush();
    EXPECT_TRUE(moved.tree() == plain.tree());
}

TEST(OctomapBuilder, LeavesOutReadingsOutsideTheCamerasRange) {
    CameraInfo camera = small_camera();
    camera.depth_min_m = 0.5;
    camera.depth_max_m = 4;
    OctomapBuilder builder;
    builder.add(0, DepthImage(64, 48, 400), camera, Pose::Identity());
    builder.add(1, DepthImage(64, 48, 4100), camera, Pose::Identity());
    builder.add(2, DepthImage(64, 48, 0), camera, Pose::Identity());
    builder.add(3, DepthImage(64, 48, 65535), camera, Pose::Identity());
    builder.flush();
    EXPECT_EQ(builder.sizes().nodes, 0u);
    EXPECT_EQ(builder.voxel_cloud_size(0.01), 0u);
}

TEST(OctomapBuilder, RebuildAfterACorrectionEqualsAFreshTree) {
    const CameraInfo camera = small_camera();
    const std::vector<Pose> before{pose(0, 0), pose(0.3, 0.1), pose(0.7, 0.3)};
    const std::vector<Pose> after{pose(0, 0), pose(0.25, 0.12), pose(0.6, 0.25)};
    OctomapBuilder corrected, fresh;
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const DepthImage depth = room(camera, static_cast<std::uint16_t>(100 * i));
        corrected.add(i, depth, camera, before[at]);
        fresh.add(i, depth, camera, after[at]);
    }
    fresh.flush();
    EXPECT_TRUE(corrected.update(trajectory(after)));
    corrected.flush();
    EXPECT_EQ(corrected.rebuilds(), 1u);
    EXPECT_TRUE(corrected.tree() == fresh.tree());
    EXPECT_EQ(corrected.bt(), fresh.bt());
    EXPECT_EQ(corrected.voxel_cloud_size(0.01), fresh.voxel_cloud_size(0.01));
}

TEST(OctomapBuilder, SmallCorrectionsCostNothingUntilTheyAddUp) {
    OctomapBuilder builder;
    builder.add(0, room(small_camera()), small_camera(), pose(0, 0));
    EXPECT_FALSE(builder.update(trajectory({pose(0.001, 0)})));
    EXPECT_TRUE(builder.update(trajectory({pose(0.003, 0)})));
}

TEST(OctomapBuilder, OrderOfArrivalDoesNotMatter) {
    const CameraInfo camera = small_camera();
    OctomapBuilder in_order, shuffled;
    for (const int i : {0, 1, 2, 3}) in_order.add(i, room(camera), camera, pose(0.2 * i, 0.1 * i));
    for (const int i : {2, 0, 3, 1}) shuffled.add(i, room(camera), camera, pose(0.2 * i, 0.1 * i));
    in_order.flush();
    shuffled.flush();
    EXPECT_TRUE(in_order.tree() == shuffled.tree());
    shuffled.add(3, room(camera), camera, pose(0.6, 0.3));
    shuffled.flush();
    EXPECT_TRUE(in_order.tree() == shuffled.tree()) << "a repeated keyframe counts once";
}

TEST(OctomapBuilder, FrozenKeyframesStayInTheTree) {
    const CameraInfo camera = small_camera();
    OctomapOptions options;
    options.max_keyframes = 2;
    OctomapBuilder bounded(options), unbounded;
    for (int i = 0; i < 5; ++i) {
        bounded.add(i, room(camera), camera, pose(0.2 * i, 0.1 * i));
        unbounded.add(i, room(camera), camera, pose(0.2 * i, 0.1 * i));
    }
    std::vector<Pose> after;
    for (int i = 0; i < 4; ++i) after.push_back(pose(0.2 * i, 0.1 * i));
    after.push_back(pose(0.9, 0.5));
    EXPECT_EQ(bounded.frozen(), 3u);
    EXPECT_LT(bounded.stored_bytes(), unbounded.stored_bytes());
    for (OctomapBuilder* builder : {&bounded, &unbounded}) {
        EXPECT_TRUE(builder->update(trajectory(after)));
        builder->flush();
    }
    EXPECT_TRUE(bounded.tree() == unbounded.tree());
}

TEST(OctomapBuilder, SizesAreThoseOfTheFiles) {
    OctomapBuilder builder;
    for (int i = 0; i < 3; ++i) builder.add(i, room(small_camera()), small_camera(), pose(0.3 * i, 0.2 * i));
    builder.flush();
    const OctomapSizes sizes = builder.sizes();
    const auto folder = std::filesystem::temp_directory_path() / "planemap_octomap_test";
    std::filesystem::create_directories(folder);
    octomap::OcTree copy(builder.tree());
    ASSERT_TRUE(copy.write((folder / "map.ot").string()));
    ASSERT_TRUE(copy.writeBinary((folder / "map.bt").string()));
    EXPECT_EQ(sizes.ot_bytes, std::filesystem::file_size(folder / "map.ot"));
    EXPECT_EQ(sizes.bt_bytes, std::filesystem::file_size(folder / "map.bt"));
    EXPECT_EQ(builder.bt(), read_file(folder / "map.bt"));
    EXPECT_EQ(builder.ot(), read_file(folder / "map.ot"));
    octomap::OcTree reread(0.1);
    ASSERT_TRUE(reread.readBinary((folder / "map.bt").string()));
    EXPECT_EQ(reread.getResolution(), 0.05);
    std::filesystem::remove_all(folder);

    EXPECT_EQ(sizes.memory_bytes, builder.tree().memoryUsage());
    EXPECT_EQ(sizes.leaves, builder.tree().getNumLeafNodes());
    EXPECT_GT(sizes.occupied_leaves, 0u);
    EXPECT_GE(sizes.occupied_voxels, sizes.occupied_leaves);
}

TEST(OctomapBuilder, OccupiedVoxelsOfPrunedLeavesAreOnTheGrid) {
    OctomapBuilder builder;
    octomap::OcTree tree(0.05);
    // A depth image that fills a thick block, so that eight occupied leaves become one.
    for (int i = 0; i < 12; ++i) {
        DepthImage depth(64, 48, static_cast<std::uint16_t>(1000 + 25 * i));
        builder.add(i, depth, small_camera(), make_pose({0, 0, -0.025 * i}, Eigen::Quaterniond::Identity()));
    }
    builder.flush();
    std::set<std::tuple<int, int, int>> seen;
    for (const auto& p : builder.occupied_voxels()) {
        const auto* node = builder.tree().search(p.x(), p.y(), p.z());
        ASSERT_NE(node, nullptr);
        EXPECT_TRUE(builder.tree().isNodeOccupied(node));
        const Eigen::Vector3d cell = p / 0.05 - Eigen::Vector3d::Constant(0.5);
        EXPECT_NEAR((cell - cell.array().round().matrix()).norm(), 0, 1e-4);
        EXPECT_TRUE(
            seen.insert({std::lround(cell.x()), std::lround(cell.y()), std::lround(cell.z())}).second);
    }
    EXPECT_EQ(seen.size(), builder.sizes().occupied_voxels);
}

TEST(OctomapBuilder, VoxelCloudCountsEachVoxelOnce) {
    OctomapBuilder builder;
    const CameraInfo camera = small_camera();
    builder.add(0, room(camera), camera, Pose::Identity());
    const std::size_t once = builder.voxel_cloud_size(0.01);
    EXPECT_GT(once, 1000u);
    EXPECT_LE(once, static_cast<std::size_t>(64 * 48));
    builder.add(1, room(camera), camera, Pose::Identity());
    EXPECT_EQ(builder.voxel_cloud_size(0.01), once);
}

TEST(OctomapBuilder, TakesNothingThatIsNotSound) {
    OctomapBuilder builder;
    const CameraInfo camera = small_camera();
    EXPECT_FALSE(builder.add(0, DepthImage(), camera, Pose::Identity()));
    EXPECT_FALSE(builder.add(0, DepthImage(48, 64, 1000), camera, Pose::Identity()));
    Pose nan = Pose::Identity();
    nan.translation().x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(builder.add(0, room(camera), camera, nan));
    CameraInfo bad = camera;
    bad.depth.fx = 0;
    EXPECT_THROW(builder.add(0, room(camera), bad, Pose::Identity()), std::invalid_argument);
    // Beyond the tree's key range nothing is stored, and nothing breaks.
    EXPECT_TRUE(builder.add(0, room(camera), camera, make_pose({1e7, 0, 0}, Eigen::Quaterniond::Identity())));
    builder.flush();
    EXPECT_EQ(builder.sizes().nodes, 0u);
    EXPECT_TRUE(builder.occupied_voxels().empty());
    EXPECT_FALSE(builder.bt().empty());
    KeyframeTrajectory unknown = trajectory({nan, pose(1, 1), pose(2, 2)});
    EXPECT_FALSE(builder.update(unknown));
}

TEST(OctomapBuilder, SurvivesRandomDepth) {
    std::mt19937_64 random(5);
    std::uniform_int_distribution<int> raw(0, 65535);
    const CameraInfo camera = small_camera();
    OctomapBuilder builder;
    DepthImage depth(64, 48);
    for (auto& pixel : depth.pixels) pixel = static_cast<std::uint16_t>(raw(random));
    EXPECT_TRUE(builder.add(0, depth, camera, pose(0.1, 2)));
    builder.flush();
    EXPECT_GT(builder.sizes().occupied_leaves, 0u);
}

TEST(OctomapOptions, NamesAllBadFields) {
    OctomapOptions options;
    options.resolution_m = 0;
    options.subsample = 0;
    try {
        OctomapBuilder{options};
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(), HasSubstr("resolution_m"));
        EXPECT_THAT(error.what(), HasSubstr("subsample"));
    }
}

}  // namespace
}  // namespace planemap
