// SPDX-License-Identifier: BSD-3-Clause
#include "map/hidden_blocks.hpp"

#include <gtest/gtest.h>

#include <list>

#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::facing;
using scene::Rectangle;
using Place = HiddenBlocks::Place;

constexpr double kBlock_m = 0.1, kRange_m = 10;
constexpr int kWall = 1, kCupboard = 2;
/// A wall 3 m before the camera, whose plane the blocks are of, and a cupboard half a metre before it.
const Pose kRaster = facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0});
const Rectangle kWallPart{facing({-1, 0, 3}, {0, 0, -1}, {1, 0, 0}), 0.5, 0.5, {}};
const Rectangle kFront{facing({0, 0, 2.5}, {0, 0, -1}, {1, 0, 0}), 0.5, 0.5, {}};
constexpr BlockRange kAll{-20, -20, 19, 19};

/// Views and what they see, the newest first.
struct Views {
    std::list<StoredKeyframe> keyframes;
    std::list<Viewpoint> viewpoints;
    std::vector<OccludingView> views;

    struct Thing {
        int plane;
        Rectangle rectangle;
        bool is_bound = false;
    };
    void look(const std::vector<Thing>& things, const Pose& world_from_camera = Pose::Identity()) {
        std::vector<PlanarRegion> regions;
        OccludingView view{nullptr, {}, {}};
        for (const Thing& thing : things) {
            regions.push_back(scene::region_of(thing.rectangle, world_from_camera, 0.05));
            view.planes.push_back(thing.plane);
            view.bounds.push_back(thing.is_bound ? 1 : 0);
        }
        StoredKeyframe& keyframe = keyframes.emplace_back(stored(0, regions));
        keyframe.world_from_camera = world_from_camera;
        view.viewpoint = &viewpoints.emplace_back(keyframe);
        views.push_back(std::move(view));
    }
    HiddenBlocks blocks(const BlockRange& range = kAll) const {
        return {kRaster, kWall, range, kBlock_m, views, kRange_m};
    }
};

/// Of the block that holds a point of the wall, by its x and y in the world.
Place at(HiddenBlocks& blocks, double x, double y) {
    const Eigen::Vector3d p = kRaster.inverse(Eigen::Isometry) * Eigen::Vector3d(x, y, 3);
    return blocks.at(static_cast<int>(std::floor(p.x() / kBlock_m)),
                     static_cast<int>(std::floor(p.y() / kBlock_m)));
}

TEST(HiddenBlocks, BehindAThingTheyAreHidden) {
    Views views;
    views.look({{kWall, kWallPart, true}, {kCupboard, kFront}});
    HiddenBlocks blocks = views.blocks();
    EXPECT_EQ(at(blocks, 0.05, 0.05), Place::kHidden);
    EXPECT_EQ(at(blocks, 0.45, -0.45), Place::kHidden);
    EXPECT_EQ(at(blocks, -1.05, 0.05), Place::kUnknown) << "it is seen there itself";
    EXPECT_EQ(at(blocks, 1.55, 0.05), Place::kUnknown) << "nobody looked";
    EXPECT_EQ(blocks.at(1000, 0), Place::kUnknown) << "beyond the range";
}

TEST(HiddenBlocks, WhereAViewSawPastThemTheyAreOpen) {
    Views views;
    views.look({{kCupboard, kFront}});
    views.look({{7, {facing({0, 0, 6}, {0, 0, -1}, {1, 0, 0}), 0.6, 3, {}}}});  // through its middle
    HiddenBlocks blocks = views.blocks();
    EXPECT_EQ(at(blocks, -0.05, 0.05), Place::kOpen) << "one view is enough";
    EXPECT_EQ(at(blocks, 0.45, 0.05), Place::kHidden);
}

TEST(HiddenBlocks, WhatBoundsTheRoomHidesNothing) {
    Views views;
    views.look({{kCupboard, kFront, true}});
    HiddenBlocks blocks = views.blocks();
    EXPECT_EQ(at(blocks, 0.05, 0.05), Place::kUnknown);
    Views own;
    own.look({{kWall, kFront}});
    HiddenBlocks of_own = own.blocks();
    EXPECT_EQ(at(of_own, 0.05, 0.05), Place::kUnknown) << "a region of its own plane";
}

TEST(HiddenBlocks, FromItsOtherSideNothingHidesAPlane) {
    Views views;
    Pose behind = Pose::Identity();
    behind.linear() = Eigen::AngleAxisd(std::acos(-1.0), Eigen::Vector3d::UnitY()).toRotationMatrix();
    behind.translation().z() = 6;
    views.look({{kCupboard, {facing({0, 0, 3.5}, {0, 0, 1}, {1, 0, 0}), 0.5, 0.5, {}}}}, behind);
    HiddenBlocks blocks = views.blocks();
    EXPECT_EQ(at(blocks, 0.05, 0.05), Place::kUnknown);
}

TEST(HiddenBlocks, WithoutViewsOrARangeNothingIsKnown) {
    Views none;
    HiddenBlocks unseen = none.blocks();
    EXPECT_EQ(at(unseen, 0, 0), Place::kUnknown);
    none.look({{kCupboard, kFront}});
    HiddenBlocks empty = none.blocks(BlockRange{});
    EXPECT_EQ(empty.at(0, 0), Place::kUnknown);
}

}  // namespace
}  // namespace planemap::map
