// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/revisits.hpp"

#include <gtest/gtest.h>

#include "evaluate/walks.hpp"

namespace planemap::evaluation {
namespace {

using Eigen::Vector3d;
using test::circle;
using test::moved;

TEST(FindPlaces, FindsThoseThatAreVisitedAgain) {
    const Trajectory truth = circle(3.5);
    const std::vector<VisitedPlace> places = find_places(truth);
    ASSERT_EQ(places.size(), 5u);
    for (const VisitedPlace& place : places) {
        EXPECT_EQ(place.visits.size(), 4u) << "those of the half round come first";
        for (std::size_t i = 1; i < place.visits.size(); ++i)
            EXPECT_NEAR(static_cast<double>(place.visits[i] - place.visits[i - 1]), 10e6, 0.1e6);
        for (const VisitedPlace& other : places) {
            if (&place == &other) continue;
            EXPECT_GT((place.world_from_camera.translation() - other.world_from_camera.translation()).norm(),
                      0.35);
        }
    }
    EXPECT_TRUE(find_places(circle(0.9)).empty()) << "nothing twice";
    EXPECT_TRUE(find_places({}).empty());
}

TEST(RevisitErrors, NoneForAPerfectEstimateInAnotherFrame) {
    const Trajectory truth = circle(3);
    Twist twist;
    twist << 1, 2, 3, 0.1, -0.5, 0.9;
    const auto errors = revisit_errors(truth, moved(truth, pose_from_twist(twist)), find_places(truth));
    ASSERT_TRUE(errors);
    EXPECT_GE(errors->revisits, 10);
    EXPECT_EQ(errors->lost, 0);
    EXPECT_LT(errors->metres.max, 1e-9);
    EXPECT_LT(errors->step_metres.max, 1e-9);
    EXPECT_LT(errors->step_degrees.max, 1e-4);
}

TEST(RevisitErrors, DriftSinceTheFirstVisitIsAnError) {
    const Trajectory truth = circle(3);
    Trajectory drifting = truth;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const std::size_t round = i / 300;
        drifting[i].world_from_camera.translation().z() += 0.001 * static_cast<double>(round);
    }
    const auto errors = revisit_errors(truth, drifting, find_places(truth));
    ASSERT_TRUE(errors);
    // After one round 1 mm, after two 2 mm; alignment takes a part of it.
    EXPECT_GT(errors->metres.rmse, 2e-4);
    EXPECT_LT(errors->metres.rmse, 2e-3);
    EXPECT_GT(errors->step_metres.max, 0.9e-3);
    EXPECT_LT(errors->step_metres.max, 1.1e-3);
}

TEST(RevisitErrors, VisitsWithoutAPoseAreCounted) {
    const Trajectory truth = circle(3);
    const std::vector<VisitedPlace> places = find_places(truth);
    const Trajectory two_rounds(truth.begin(), truth.begin() + 600);
    const auto errors = revisit_errors(truth, two_rounds, places);
    ASSERT_TRUE(errors);
    EXPECT_GE(errors->revisits, 5);
    EXPECT_GE(errors->lost, 5);
    EXPECT_EQ(errors->revisits + errors->lost, revisit_errors(truth, truth, places)->revisits);
    EXPECT_FALSE(revisit_errors(truth, Trajectory(truth.begin(), truth.begin() + 300), places));
    EXPECT_FALSE(revisit_errors(truth, {}, places));
    EXPECT_FALSE(revisit_errors(truth, truth, {}));
}

}  // namespace
}  // namespace planemap::evaluation
