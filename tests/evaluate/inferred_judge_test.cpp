// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/inferred_judge.hpp"

#include <gtest/gtest.h>

#include "evaluate/room.hpp"

namespace planemap::evaluation {
namespace {

TEST(InferredJudge, WhatLiesOnATruePlaneIsRightSeenOrNot) {
    const std::vector<Face> floor{
        {"floor", {2, 1.5, 0}, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), 2, 1.5}};
    std::vector<TruePlane> truth = truth_of(floor);
    truth[0].material = truth[0].visible;
    std::fill(truth[0].visible.mask.cells.begin(), truth[0].visible.mask.cells.end(), std::uint8_t{0});
    PlaneMap map = map_of(floor);
    EXPECT_FALSE(judge_inferred(truth, map, Pose::Identity()).right());
    // Half of it lies beyond the floor's end.
    map.inferred.push_back({map.planes[0].id, MapOutline(Outline{{{{1, -1}, {3, -1}, {3, 1}, {1, 1}}}})});
    const InferredJudgement inferred = judge_inferred(truth, map, Pose::Identity());
    EXPECT_NEAR(inferred.area_m2, 4, 0.1);
    EXPECT_NEAR(inferred.right().value(), 0.5, 0.03);
    const Pose lower(Eigen::Translation3d(0, 0, -0.1));
    EXPECT_EQ(judge_inferred(truth, map, lower).right(), 0.0) << "another height";
}

}  // namespace
}  // namespace planemap::evaluation
