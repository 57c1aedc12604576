// SPDX-License-Identifier: BSD-3-Clause
#include "map/handling.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/furniture.hpp"
#include "core/geometry/angle.hpp"
#include "core/random_values.hpp"

namespace planemap::map {
namespace {

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

TEST(Handling, ACameraIsHeldUprightAndTurnsAboutUp) {
    for (const double pitch_deg : {-10.0, 20.0, 45.0}) {
        const std::optional<Handling> handling = Handling::of(scene::looking_around(1.4, radians(pitch_deg)));
        ASSERT_TRUE(handling);
        for (const Eigen::Vector3d& other :
             {Eigen::Vector3d(-kUp), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0.7, 0.7)}) {
            EXPECT_GT(handling->log_held(kUp), handling->log_held(other.normalized())) << pitch_deg;
            EXPECT_GE(handling->log_turned(kUp), handling->log_turned(other.normalized())) << pitch_deg;
        }
        EXPECT_EQ(handling->log_turned(kUp), handling->log_turned(-kUp)) << "either way up";
        EXPECT_LT(handling->log_held(kUp), Handling::kMostHeld);
    }
}

TEST(Handling, ACameraMovesLevel) {
    std::vector<Pose> poses;
    for (int i = 0; i < 20; ++i) poses.push_back(scene::looking({0.2 * i, 0.1 * (i % 5), 1.4}, 0, 0.3));
    const std::optional<Handling> handling = Handling::of(poses);
    ASSERT_TRUE(handling);
    EXPECT_EQ(handling->log_moved(kUp), 0);
    EXPECT_LT(handling->log_moved({1, 0, 0}), handling->log_moved({0, 1, 0})) << "it moved farther along x";
    EXPECT_LT(handling->log_moved({0, 1, 0}), 0);
    EXPECT_NEAR(handling->log_turned(kUp), 0, 1e-9) << "it did not turn";
    EXPECT_LT((handling->middle() - Eigen::Vector3d(1.9, 0.2, 1.4)).norm(), 1e-9);
    EXPECT_LT((handling->image_right() - Eigen::Vector3d(0, -1, 0)).norm(), 1e-9);
    EXPECT_LT(handling->image_down().z(), -0.9);
}

TEST(Handling, SaysTheSameInAnyWorld) {
    test::Random random(2);
    const std::vector<Pose> poses = scene::looking_around(1.4, 0.4);
    const std::optional<Handling> here = Handling::of(poses);
    for (int i = 0; i < 10; ++i) {
        const Pose world = random.pose();
        const std::optional<Handling> there = Handling::of(scene::moved(world, poses));
        const Eigen::Vector3d up = random.direction(), up_there = world.linear() * up;
        EXPECT_NEAR(there->log_held(up_there), here->log_held(up), 1e-6);
        EXPECT_NEAR(there->log_turned(up_there), here->log_turned(up), 1e-6);
        EXPECT_NEAR(there->log_moved(up_there), here->log_moved(up), 1e-6);
    }
}

TEST(Handling, OfPosesThatAreNoneNothing) {
    EXPECT_FALSE(Handling::of({}));
    Pose bad = Pose::Identity();
    bad.translation().x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(Handling::of(std::vector<Pose>{bad, bad}));
    const std::optional<Handling> one =
        Handling::of(std::vector<Pose>{bad, scene::looking({1, 2, 3}, 0, 0.3)});
    ASSERT_TRUE(one);
    EXPECT_LT((one->middle() - Eigen::Vector3d(1, 2, 3)).norm(), 1e-9);
    EXPECT_EQ(one->log_moved(kUp), 0);
}

}  // namespace
}  // namespace planemap::map
