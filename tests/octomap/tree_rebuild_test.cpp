// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/tree_rebuild.hpp"

#include <gtest/gtest.h>

#include "octomap/scenes.hpp"

namespace planemap::octomap {
namespace {

using test::pose;
using test::room;
using test::small_camera;
using test::trajectory;

/// A tree of keyframes 0, 1, 2 ... that stand ten metres apart, so that no two see the same block.
class TreeRebuildTest : public ::testing::Test {
  protected:
    TreeRebuildTest() {
        for (int id = 0; id < 5; ++id) insert(id);
    }

    void insert(int id) {
        keyframes_.keep(id, std::make_shared<StoredScan>(room(small_camera()), small_camera()),
                        pose(10 * id, 0));
        const KeptKeyframe& keyframe = keyframes_.all().at(id);
        tracer_.trace(tree_, *keyframe.scan, keyframe.world_from_camera);
        tracer_.apply(tree_);
        keyframes_.enter(id, tracer_.blocks());
    }

    /// Moves the keyframes with these ids by a metre.
    void move(const std::vector<int>& ids) {
        std::vector<Pose> poses;
        for (const auto& [id, keyframe] : keyframes_.all()) poses.push_back(keyframe.world_from_camera);
        for (const int id : ids) poses[static_cast<std::size_t>(id)].translation().y() += 1;
        keyframes_.move(trajectory(poses));
    }

    TreeRebuild begun(BlockSet dirty = {}) {
        TreeRebuild rebuild(keyframes_, std::move(dirty));
        keyframes_.take_misplaced();
        return rebuild;
    }

    /// A tree of all keyframes where they are now, over what `base` holds.
    ::octomap::OcTree fresh(const ::octomap::OcTree* base = nullptr) {
        ::octomap::OcTree tree =
            base != nullptr ? ::octomap::OcTree(*base) : ::octomap::OcTree(tree_.getResolution());
        for (const auto& [id, keyframe] : keyframes_.all()) {
            tracer_.trace(tree, *keyframe.scan, keyframe.world_from_camera);
            tracer_.apply(tree);
        }
        return up_to_date(std::move(tree));
    }

    static ::octomap::OcTree up_to_date(::octomap::OcTree tree) {
        bring_up_to_date(tree);
        return tree;
    }

    KeptKeyframes keyframes_{OctomapOptions{}};
    KeyframeTracer tracer_{OctomapOptions{}};
    ::octomap::OcTree tree_{OctomapOptions{}.resolution_m};
};

TEST_F(TreeRebuildTest, BuildsAnewOnlyWhereSomethingMoved) {
    move({3});
    TreeRebuild rebuild = begun();
    EXPECT_EQ(rebuild.tree(), nullptr);
    while (rebuild.advance(tracer_, tree_, nullptr)) continue;
    EXPECT_EQ(rebuild.reinserted(), 1u);
    EXPECT_TRUE(up_to_date(*rebuild.tree()) == fresh());
}

TEST_F(TreeRebuildTest, WhenMostMovedAllIsBuiltAnew) {
    move({0, 1, 3});
    TreeRebuild rebuild = begun();
    ASSERT_TRUE(rebuild.advance(tracer_, tree_, nullptr));
    ASSERT_NE(rebuild.tree(), nullptr) << "nothing is surveyed";
    EXPECT_EQ(rebuild.tree()->size(), 0u);
    while (rebuild.advance(tracer_, tree_, nullptr)) continue;
    EXPECT_EQ(rebuild.reinserted(), 5u);
    EXPECT_TRUE(up_to_date(*rebuild.tree()) == fresh());
}

TEST_F(TreeRebuildTest, WhatEnteredTheTreeMeanwhileIsInTheNewOneToo) {
    for (const int steps : {0, 1, 2, 3}) {
        SCOPED_TRACE(steps);
        move({1});
        TreeRebuild rebuild = begun();
        for (int i = 0; i < steps; ++i) rebuild.advance(tracer_, tree_, nullptr);
        const int id = 5 + steps;
        insert(id);
        rebuild.append(id, keyframes_.all().at(id));
        while (rebuild.advance(tracer_, tree_, nullptr)) continue;
        EXPECT_TRUE(up_to_date(*rebuild.tree()) == fresh());
        tree_.swapContent(*rebuild.take_tree());
        for (TreeRebuild::Planned& planned : rebuild.plan())
            keyframes_.rebuilt(planned.id, std::move(planned.blocks));
    }
}

TEST_F(TreeRebuildTest, GivenBlocksAreBuiltAnewFromTheFrozenKeyframes) {
    ::octomap::OcTree base(tree_.getResolution());
    BlockSet dirty;
    const auto [id, frozen] = keyframes_.let_oldest_go();
    for (const Voxel& block : frozen.blocks) dirty.insert(block);
    tracer_.trace(base, *frozen.scan, pose(0.5, 0));
    tracer_.apply(base);
    for (const Voxel& block : tracer_.blocks()) dirty.insert(block);
    TreeRebuild rebuild = begun(std::move(dirty));
    while (rebuild.advance(tracer_, tree_, &base)) continue;
    EXPECT_EQ(rebuild.reinserted(), 0u) << "no kept keyframe sees those blocks";
    EXPECT_TRUE(up_to_date(*rebuild.tree()) == fresh(&base));
}

TEST_F(TreeRebuildTest, ThePlanOutlivesTheKeyframesThatItNames) {
    move({0});
    TreeRebuild rebuild = begun();
    const ::octomap::OcTree expected = fresh();
    keyframes_.let_oldest_go();
    rebuild.note_frozen_aside(0);
    while (rebuild.advance(tracer_, tree_, nullptr)) continue;
    EXPECT_TRUE(up_to_date(*rebuild.tree()) == expected);
    for (const TreeRebuild::Planned& planned : rebuild.plan()) {
        EXPECT_EQ(planned.frozen_aside, planned.id == 0);
        EXPECT_FALSE(planned.blocks.empty());
    }
}

}  // namespace
}  // namespace planemap::octomap
