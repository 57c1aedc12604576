// SPDX-License-Identifier: BSD-3-Clause
#include "map/folded_planes.hpp"

#include <gtest/gtest.h>

#include "map/estimates.hpp"
#include "map/evidence_shape.hpp"

namespace planemap::map {
namespace {

using samples::drawn_estimate_of;
using samples::kRules;
using samples::points_of;
using samples::stored_at;
using samples::wall_at;

const FreeSpace kFreeSpace{0.05};

TEST(FoldedPlanes, KeepPointsShapeAndKeyframes) {
    FoldedPlanes folded(kRules, 200);
    RegionJoiner joiner(observation_model({}), 0.025);
    double points = 0;
    for (int i = 0; i < 4; ++i) {
        const StoredKeyframe keyframe =
            stored_at(scene::camera_at({0.1 * i, 0, 0}), {wall_at(0.2 * i, 0, 3), wall_at(2, 0, 2)}, {7, 3});
        for (const StoredRegion& region : keyframe.regions) points += static_cast<double>(region.count);
        folded.fold(i, keyframe, joiner, kFreeSpace);
    }
    ASSERT_EQ(folded.planes().size(), 2u);
    EXPECT_EQ(folded.planes()[0].id, 7) << "the plane that its region is part of, whatever else it fits";
    EXPECT_EQ(folded.planes()[1].id, 3);
    EXPECT_EQ(folded.planes()[0].keyframes, 4);
    EXPECT_NEAR(points_of(folded.planes()), points, 1e-6);
    EXPECT_NEAR(area(outline_of(folded.planes()[0].grid, samples::kOutline)), 1.6, 0.1);
}

TEST(FoldedPlanes, WhatIsOnNoPlaneIsNotKept) {
    FoldedPlanes folded(kRules, 200);
    RegionJoiner joiner(observation_model({}), 0.025);
    folded.fold(0, stored_at(Pose::Identity(), {wall_at(0, 0, 3)}), joiner, kFreeSpace);
    folded.fold(1, stored_at(Pose::Identity(), {}), joiner, kFreeSpace);
    EXPECT_TRUE(folded.planes().empty());
    folded.rename({{1, 2}});
    folded.unite();
    EXPECT_TRUE(folded.planes().empty());
}

TEST(FoldedPlanes, OfOnePlaneBecomeOne) {
    FoldedPlanes folded(kRules, 200);
    for (const int id : {4, 5, 9}) folded.push_back(drawn_estimate_of(wall_at(0.8 * id, 0, 3), id));
    const double points = points_of(folded.planes());
    folded.rename({{9, 4}, {2, 5}});
    EXPECT_EQ(folded.planes().size(), 3u) << "several may be part of one plane";
    EXPECT_EQ(folded.planes()[2].id, 4);
    folded.unite();
    ASSERT_EQ(folded.planes().size(), 2u);
    EXPECT_EQ(folded.planes()[0].id, 4);
    EXPECT_EQ(folded.planes()[0].keyframes, 2);
    EXPECT_EQ(folded.planes()[1].id, 5);
    EXPECT_EQ(points_of(folded.planes()), points);
}

}  // namespace
}  // namespace planemap::map
