// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_builder.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <limits>
#include <random>
#include <set>

#include "core/files.hpp"
#include "octomap/scenes.hpp"

namespace planemap::octomap {
namespace {

using test::add_keyframe;
using test::pose;
using test::room;
using test::small_camera;
using test::trajectory;

TEST(OctomapBuilder, PutsLeavesWhereTheDepthIs) {
    const CameraInfo camera = small_camera();
    OctomapBuilder builder;
    ASSERT_TRUE(add_keyframe(builder, 0, DepthImage(64, 48, 2000), camera, Pose::Identity()));
    builder.flush();
    const auto voxels = builder.occupied_voxels();
    ASSERT_GT(voxels.size(), 500u);
    for (const auto& p : voxels) EXPECT_NEAR(p.z(), 2.0, 0.05);
    EXPECT_EQ(voxels.size(), builder.sizes().occupied_voxels);
    const auto* free = builder.tree().search(0, 0, 1);
    ASSERT_NE(free, nullptr);
    EXPECT_FALSE(builder.tree().isNodeOccupied(free));
}

TEST(OctomapBuilder, AtAnotherResolutionItIsTheTreeThatWouldHaveBeenBuilt) {
    const CameraInfo camera = small_camera();
    OctomapOptions coarse;
    coarse.resolution_m = 0.1;
    OctomapBuilder fine, other(coarse);
    for (OctomapBuilder* builder : {&fine, &other}) {
        for (int i = 0; i < 3; ++i)
            add_keyframe(*builder, i, room(camera), camera,
                         make_pose({0.1 * i, 0, 0}, Eigen::Quaterniond::Identity()));
        builder->flush();
    }
    ASSERT_NE(fine.tree_at(0.1), nullptr);
    EXPECT_EQ(ot_of(*fine.tree_at(0.1)), ot_of(other.tree()));
    EXPECT_EQ(ot_of(*fine.tree_at(0.05)), ot_of(fine.tree()));
    OctomapOptions few;
    few.max_keyframes = 1;
    OctomapBuilder frozen(few);
    for (int i = 0; i < 3; ++i) add_keyframe(frozen, i, room(camera), camera, Pose::Identity());
    EXPECT_EQ(frozen.tree_at(0.1), nullptr) << "the depth of some is no longer there";
}

TEST(OctomapBuilder, UsesTheDepthCamerasOwnPose) {
    CameraInfo camera = small_camera();
    camera.registered = false;
    camera.color_from_depth = make_pose({0.5, 0, 0}, Eigen::Quaterniond::Identity());
    OctomapBuilder moved, plain;
    add_keyframe(moved, 0, room(camera), camera, Pose::Identity());
    add_keyframe(plain, 0, room(camera), small_camera(),
                 make_pose({0.5, 0, 0}, Eigen::Quaterniond::Identity()));
    moved.flush();
    plain.flush();
    EXPECT_TRUE(moved.tree() == plain.tree());
}

TEST(OctomapBuilder, LeavesOutReadingsOutsideTheCamerasRange) {
    CameraInfo camera = small_camera();
    camera.depth_min_m = 0.5;
    camera.depth_max_m = 4;
    OctomapBuilder builder;
    add_keyframe(builder, 0, DepthImage(64, 48, 400), camera, Pose::Identity());
    add_keyframe(builder, 1, DepthImage(64, 48, 4100), camera, Pose::Identity());
    add_keyframe(builder, 2, DepthImage(64, 48, 0), camera, Pose::Identity());
    add_keyframe(builder, 3, DepthImage(64, 48, 65535), camera, Pose::Identity());
    builder.flush();
    EXPECT_EQ(builder.sizes().nodes, 0u);
    EXPECT_EQ(builder.voxel_cloud(0.01).size(), 0u);
}

TEST(OctomapBuilder, RebuildAfterACorrectionEqualsAFreshTree) {
    const CameraInfo camera = small_camera();
    const std::vector<Pose> before{pose(0, 0), pose(0.3, 0.1), pose(0.7, 0.3)};
    const std::vector<Pose> after{pose(0, 0), pose(0.25, 0.12), pose(0.6, 0.25)};
    OctomapBuilder corrected, fresh;
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const DepthImage depth = room(camera, static_cast<std::uint16_t>(100 * i));
        add_keyframe(corrected, i, depth, camera, before[at]);
        add_keyframe(fresh, i, depth, camera, after[at]);
    }
    fresh.flush();
    EXPECT_TRUE(corrected.update(trajectory(after)));
    corrected.flush();
    EXPECT_EQ(corrected.rebuilds(), 1u);
    EXPECT_TRUE(corrected.tree() == fresh.tree());
    EXPECT_EQ(corrected.bt(), fresh.bt());
    EXPECT_EQ(corrected.voxel_cloud(0.01).size(), fresh.voxel_cloud(0.01).size());
}

/// What a replaced keyframe saw would stay behind as a second wall.
TEST(OctomapBuilder, AReplacedKeyframesDepthMovesWithItsReplacement) {
    const CameraInfo camera = small_camera();
    const std::vector<Pose> before{pose(0, 0), pose(0.02, 0.01), pose(0.04, 0.02), pose(0.06, 0.03)};
    const Pose correction = pose(0.4, 0.1);
    OctomapBuilder corrected, fresh;
    for (int id = 0; id < 4; ++id) {
        add_keyframe(corrected, id, room(camera), camera, before[static_cast<std::size_t>(id)]);
        add_keyframe(fresh, id, room(camera), camera, correction * before[static_cast<std::size_t>(id)]);
    }
    KeyframeTrajectory named = trajectory(before);
    corrected.update(named);
    for (const int gone : {1, 2}) {  // 1 by 2, or 0; then 2 by another
        std::erase_if(named.keyframes, [&](const KeyframePose& keyframe) { return keyframe.id == gone; });
        EXPECT_FALSE(corrected.update(named)) << "nothing moved";
    }
    for (KeyframePose& keyframe : named.keyframes)
        keyframe.world_from_camera = correction * keyframe.world_from_camera;
    EXPECT_TRUE(corrected.update(named));
    corrected.flush();
    fresh.flush();
    EXPECT_EQ(corrected.keyframes_in_tree(), 4u);
    EXPECT_TRUE(corrected.tree() == fresh.tree());
}

TEST(OctomapBuilder, SmallCorrectionsCostNothingUntilTheyAddUp) {
    OctomapBuilder builder;
    add_keyframe(builder, 0, room(small_camera()), small_camera(), pose(0, 0));
    EXPECT_FALSE(builder.update(trajectory({pose(0.001, 0)})));
    EXPECT_TRUE(builder.update(trajectory({pose(0.003, 0)})));
}

TEST(OctomapBuilder, OrderOfArrivalDoesNotMatter) {
    const CameraInfo camera = small_camera();
    OctomapBuilder in_order, shuffled;
    for (const int i : {0, 1, 2, 3}) add_keyframe(in_order, i, room(camera), camera, pose(0.2 * i, 0.1 * i));
    for (const int i : {2, 0, 3, 1}) add_keyframe(shuffled, i, room(camera), camera, pose(0.2 * i, 0.1 * i));
    in_order.flush();
    shuffled.flush();
    EXPECT_TRUE(in_order.tree() == shuffled.tree());
    add_keyframe(shuffled, 3, room(camera), camera, pose(0.6, 0.3));
    shuffled.flush();
    EXPECT_TRUE(in_order.tree() == shuffled.tree()) << "a repeated keyframe counts once";
}

TEST(OctomapBuilder, FrozenKeyframesStayInTheTree) {
    const CameraInfo camera = small_camera();
    OctomapOptions options;
    options.max_keyframes = 2;
    OctomapBuilder bounded(options), unbounded;
    for (int i = 0; i < 5; ++i) {
        add_keyframe(bounded, i, room(camera), camera, pose(0.2 * i, 0.1 * i));
        add_keyframe(unbounded, i, room(camera), camera, pose(0.2 * i, 0.1 * i));
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

/// The tree of all scans at their last poses, made at once.
std::unique_ptr<OctomapBuilder> fresh(const std::map<int, std::pair<DepthImage, Pose>>& scans,
                                      const OctomapOptions& options = {}) {
    auto builder = std::make_unique<OctomapBuilder>(options);
    for (const auto& [id, scan] : scans) add_keyframe(*builder, id, scan.first, small_camera(), scan.second);
    builder->flush();
    return builder;
}

TEST(OctomapBuilder, ARebuildLeavesWhatNothingMovedIn) {
    OctomapBuilder builder;
    std::map<int, std::pair<DepthImage, Pose>> scans;
    // Ten rooms, ten metres from one another, three keyframes each.
    for (int i = 0; i < 30; ++i) {
        const int of_room = i / 3;
        scans[i] = {room(small_camera()), pose(10 * of_room + 0.1 * i, 0.02 * i)};
        add_keyframe(builder, i, scans[i].first, small_camera(), scans[i].second);
    }
    scans[7].second = pose(20.9, 0.2);
    KeyframeTrajectory corrected;
    for (const auto& [id, scan] : scans) corrected.keyframes.push_back({id, 0, scan.second});
    EXPECT_TRUE(builder.update(corrected));
    int steps = 0;
    while (builder.advance(true)) ++steps;
    builder.flush();
    EXPECT_EQ(builder.rebuilds(), 1u);
    EXPECT_EQ(steps, 2 + 1 + 3 + 1) << "two to begin, one that moved, the three of that room, and the end";
    EXPECT_TRUE(builder.tree() == fresh(scans)->tree());
    EXPECT_EQ(builder.tree().size(), fresh(scans)->tree().size());
}

TEST(OctomapBuilder, GrowsOnWhileARebuildIsUnderWay) {
    OctomapBuilder builder;
    std::map<int, std::pair<DepthImage, Pose>> scans;
    const auto take = [&](int id, double x) {
        scans[id] = {room(small_camera()), pose(x, 0.1)};
        EXPECT_TRUE(builder.keep(id, std::make_shared<StoredScan>(scans[id].first, small_camera()),
                                 scans[id].second, {id, Pose::Identity()}));
    };
    for (int i = 0; i < 10; ++i) take(i, 0.3 * i);
    while (builder.advance(true)) continue;
    for (auto& [id, scan] : scans) scan.second = pose(0.35 * id, 0.1);
    KeyframeTrajectory corrected;
    for (const auto& [id, scan] : scans) corrected.keyframes.push_back({id, 0, scan.second});
    ASSERT_TRUE(builder.update(corrected));
    for (int steps = 0; steps < 5; ++steps) ASSERT_TRUE(builder.advance(true));
    take(10, 3.6);
    ASSERT_TRUE(builder.advance(true));
    EXPECT_EQ(builder.keyframes_in_tree(), 11u) << "a new keyframe does not wait for the rebuild";
    EXPECT_EQ(builder.rebuilds(), 0u);
    EXPECT_EQ(builder.waiting(), 0u);
    while (builder.advance(true)) continue;
    builder.tidy();
    EXPECT_EQ(builder.rebuilds(), 1u);
    EXPECT_TRUE(builder.tree() == fresh(scans)->tree());
    EXPECT_FALSE(builder.advance(true));
}

TEST(OctomapBuilder, ManySmallStepsEndAtTheTreeOfOneBuild) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> jitter(-0.2, 0.2);
        const auto chance = [&](int of) { return std::uniform_int_distribution<int>(1, of)(random) == 1; };
        OctomapOptions options;
        options.max_keyframes = seed % 2 == 0 ? 2000 : 12;
        options.moved_m = options.moved_deg = 0;
        options.resolution_m = 0.1;
        OctomapBuilder builder(options);
        std::map<int, std::pair<DepthImage, Pose>> scans;
        int next = 0;
        for (int step = 0; step < 200; ++step) {
            if (next < 25 && chance(5)) {
                const int id = next++;
                scans[id] = {room(small_camera(), static_cast<std::uint16_t>(10 * id)),
                             pose(0.7 * id, 0.03 * id)};
                ASSERT_TRUE(builder.keep(id, std::make_shared<StoredScan>(scans[id].first, small_camera()),
                                         scans[id].second, {id, Pose::Identity()}));
            }
            if (chance(15)) {
                KeyframeTrajectory corrected;
                for (auto& [id, scan] : scans) {
                    if (id < static_cast<int>(builder.frozen())) continue;
                    // Near the newest, or all: a small correction and a loop closure.
                    if (id + 4 >= next || step % 3 == 0)
                        scan.second = pose(0.7 * id + jitter(random), 0.03 * id);
                    corrected.keyframes.push_back({id, 0, scan.second});
                }
                builder.update(corrected);
            }
            builder.advance(!chance(3));
            if (chance(20)) builder.tidy();
        }
        while (builder.advance(true)) continue;
        builder.tidy();
        ASSERT_GT(builder.rebuilds(), 1u);
        ASSERT_TRUE(builder.tree() == fresh(scans, options)->tree()) << "seed " << seed;
    }
}

TEST(OctomapBuilder, TheListenerHearsAllOfTheGrowthAndTheTreeIsTheSame) {
    const CameraInfo camera = small_camera();
    OctomapOptions options;
    options.max_keyframes = 3;
    OctomapBuilder heard(options), unheard(options);
    std::vector<int> ids;
    heard.listen([&](ScanId id, const ::octomap::OcTree& tree, bool is_in) {
        if (!ids.empty() && !is_in && id.keyframe <= ids.back()) ids.clear();
        EXPECT_TRUE(is_in || !ids.empty() || tree.size() == 0);
        if (is_in) {
            ids.push_back(id.keyframe);
            EXPECT_GT(tree.size(), 0u);
        }
    });
    const std::vector<Pose> before{pose(0, 0), pose(0.3, 0.1), pose(0.7, 0.3)},
        after{pose(0, 0), pose(0.25, 0.12), pose(0.6, 0.25)};
    for (OctomapBuilder* builder : {&heard, &unheard}) {
        for (int i = 0; i < 2; ++i)
            add_keyframe(*builder, i, room(camera), camera, before[static_cast<std::size_t>(i)]);
    }
    EXPECT_EQ(ids, (std::vector<int>{0, 1})) << "as they come";
    for (OctomapBuilder* builder : {&heard, &unheard}) {
        EXPECT_TRUE(builder->update(trajectory(after)));
        add_keyframe(*builder, 2, room(camera, 100), camera, after[2]);
        builder->flush();
    }
    EXPECT_EQ(ids, (std::vector<int>{0, 1, 2})) << "where they are now";
    EXPECT_EQ(ot_of(heard.tree()), ot_of(unheard.tree()));
    EXPECT_EQ(heard.rebuilds(), 1u);
    EXPECT_TRUE(heard.is_growth_heard());
    EXPECT_FALSE(unheard.is_growth_heard());
    for (OctomapBuilder* builder : {&heard, &unheard}) {
        EXPECT_TRUE(builder->update(trajectory(before)));
        builder->flush();
        add_keyframe(*builder, 3, room(camera, 50), camera, pose(0.9, 0.3));
        add_keyframe(*builder, 4, room(camera, 20), camera, pose(1, 0.2));
        builder->flush();
    }
    EXPECT_EQ(ot_of(heard.tree()), ot_of(unheard.tree()));
    EXPECT_EQ(heard.frozen(), 2u);
    EXPECT_FALSE(heard.is_growth_heard()) << "the first ones' depth is gone";
}

TEST(OctomapBuilder, AFrozenKeyframeDoesNotComeAgain) {
    OctomapOptions options;
    options.max_keyframes = 1;
    OctomapBuilder builder(options);
    EXPECT_TRUE(add_keyframe(builder, 4, room(small_camera()), small_camera(), pose(0, 0)));
    EXPECT_TRUE(add_keyframe(builder, 5, room(small_camera()), small_camera(), pose(0.1, 0)));
    EXPECT_FALSE(add_keyframe(builder, 4, room(small_camera()), small_camera(), pose(0.2, 0)));
    EXPECT_FALSE(add_keyframe(builder, 3, room(small_camera()), small_camera(), pose(0.2, 0)));
    EXPECT_EQ(builder.frozen(), 1u);
    EXPECT_EQ(builder.keyframes_in_tree(), 2u);
}

TEST(OctomapBuilder, SizesAreThoseOfTheFiles) {
    OctomapBuilder builder;
    for (int i = 0; i < 3; ++i)
        add_keyframe(builder, i, room(small_camera()), small_camera(), pose(0.3 * i, 0.2 * i));
    builder.flush();
    const OctomapSizes sizes = builder.sizes();
    const auto folder = std::filesystem::temp_directory_path() / "planemap_octomap_test";
    std::filesystem::create_directories(folder);
    ::octomap::OcTree copy(builder.tree());
    ASSERT_TRUE(copy.write((folder / "map.ot").string()));
    ASSERT_TRUE(copy.writeBinary((folder / "map.bt").string()));
    EXPECT_EQ(sizes.ot_bytes, std::filesystem::file_size(folder / "map.ot"));
    EXPECT_EQ(sizes.bt_bytes, std::filesystem::file_size(folder / "map.bt"));
    EXPECT_EQ(builder.bt(), read_file(folder / "map.bt"));
    EXPECT_EQ(ot_of(builder.tree()), read_file(folder / "map.ot"));
    ::octomap::OcTree reread(0.1);
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
    ::octomap::OcTree tree(0.05);
    // A depth image that fills a thick block, so that eight occupied leaves become one.
    for (int i = 0; i < 12; ++i) {
        DepthImage depth(64, 48, static_cast<std::uint16_t>(1000 + 25 * i));
        add_keyframe(builder, i, depth, small_camera(),
                     make_pose({0, 0, -0.025 * i}, Eigen::Quaterniond::Identity()));
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
    add_keyframe(builder, 0, room(camera), camera, Pose::Identity());
    const std::size_t once = builder.voxel_cloud(0.01).size();
    EXPECT_GT(once, 1000u);
    EXPECT_LE(once, static_cast<std::size_t>(64 * 48));
    add_keyframe(builder, 1, room(camera), camera, Pose::Identity());
    EXPECT_EQ(builder.voxel_cloud(0.01).size(), once);
}

TEST(OctomapBuilder, TakesNothingThatIsNotSound) {
    OctomapBuilder builder;
    const CameraInfo camera = small_camera();
    Pose nan = Pose::Identity();
    nan.translation().x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(add_keyframe(builder, 0, room(camera), camera, nan));
    // Beyond the tree's key range nothing is stored, and nothing breaks.
    EXPECT_TRUE(add_keyframe(builder, 0, room(camera), camera,
                             make_pose({1e7, 0, 0}, Eigen::Quaterniond::Identity())));
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
    EXPECT_TRUE(add_keyframe(builder, 0, depth, camera, pose(0.1, 2)));
    builder.flush();
    EXPECT_GT(builder.sizes().occupied_leaves, 0u);
}

}  // namespace
}  // namespace planemap::octomap
