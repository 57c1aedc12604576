// SPDX-License-Identifier: BSD-3-Clause
#include "map/region_joiner.hpp"

#include <gtest/gtest.h>

#include "map/estimates.hpp"
#include "map/evidence_shape.hpp"

namespace planemap::map {
namespace {

using samples::kRules;
using samples::stored_at;
using samples::wall_at;

TEST(RegionJoiner, PointsOfAllRegionsAreInThePlanes) {
    RegionJoiner joiner(observation_model({}), 0.025);
    PlaneSet planes(kRules, 200);
    PlaneIds ids;
    Moments all;
    for (int i = 0; i < 6; ++i) {
        const StoredKeyframe keyframe = stored_at(scene::camera_at({0.1 * i, 0, 0}, 0.1 * i),
                                                  {wall_at(0.3 * i, 0, 3), wall_at(0, 0, 4.5, 1)});
        for (const StoredRegion& region : keyframe.regions) {
            const Observation seen(keyframe, region);
            joiner.join_best(planes, ids, seen);
            all += seen.placed.moments;
        }
    }
    ASSERT_EQ(planes.estimates().size(), 2u);
    EXPECT_EQ(planes.estimates()[0].id, 0);
    EXPECT_EQ(planes.estimates()[1].id, 1);
    Moments sum = planes.estimates()[0].moments;
    sum += planes.estimates()[1].moments;
    EXPECT_EQ(sum.count, all.count);
    EXPECT_LT((sum.mean() - all.mean()).norm(), 1e-9);
    EXPECT_EQ(ids.upcoming(), 2) << "an id is taken for a new plane only";
}

TEST(RegionJoiner, JoinsThePlaneThatItIsTold) {
    RegionJoiner joiner(observation_model({}), 0.025);
    PlaneSet planes(kRules, 200);
    const StoredKeyframe keyframe = stored_at(Pose::Identity(), {wall_at(0, 0, 3)});
    const Observation seen(keyframe, keyframe.regions[0]);
    const std::size_t at = joiner.join(planes, PlaneSet::none(), 7, seen);
    EXPECT_EQ(planes.estimates()[at].id, 7);
    EXPECT_EQ(joiner.join(planes, at, -1, seen), at);
    EXPECT_EQ(planes.estimates().size(), 1u);
    EXPECT_EQ(planes.estimates()[at].id, 7);
    EXPECT_EQ(planes.estimates()[at].moments.count, 2 * seen.placed.moments.count);
    // The set knows how far it reaches now.
    const StoredKeyframe beside = stored_at(Pose::Identity(), {wall_at(1.2, 0, 3)});
    EXPECT_EQ(planes.partner_of(PlacedRegion(Pose::Identity(), beside.regions[0])), at);
}

TEST(RegionJoiner, DrawsTheOutlineAndCountsWhatIsNew) {
    RegionJoiner joiner(observation_model({}), 0.025);
    PlaneSet planes(kRules, 200);
    const StoredKeyframe keyframe = stored_at(Pose::Identity(), {wall_at(0, 0, 3)});
    const Observation seen(keyframe, keyframe.regions[0]);
    PlaneEstimate& plane = planes.estimates()[joiner.join(planes, PlaneSet::none(), 0, seen)];
    EXPECT_TRUE(plane.grid.empty()) << "joining does not draw";
    const int cells = joiner.draw(plane, seen.world_from_box(), seen.region, keyframe, 1);
    EXPECT_NEAR(cells, 1600, 90);
    EXPECT_EQ(joiner.draw(plane, seen.world_from_box(), seen.region, keyframe, 1), 0);
    EXPECT_NEAR(area(outline_of(plane.grid, samples::kOutline)), 1, 0.06);
}

}  // namespace
}  // namespace planemap::map
