// SPDX-License-Identifier: BSD-3-Clause
#include "core/replacement.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

KeyframePose at_x(int id, double x, double turn = 0) {
    Pose pose = Pose::Identity();
    pose.linear() = so3_exp({0, turn, 0});
    pose.translation().x() = x;
    return {id, 1000 * id, pose};
}

TEST(Replacements, AreByTheNearestThatStays) {
    const std::vector<KeyframePose> before{at_x(0, 0), at_x(2, 1), at_x(5, 1.1, 1), at_x(7, 1.3),
                                           at_x(8, 1.2)};
    const std::vector<KeyframePose> now{at_x(0, 5), at_x(5, 6), at_x(7, 7), at_x(9, 1.0)};
    const std::vector<Replacement> gone = replacements(before, now);
    ASSERT_EQ(gone.size(), 2u);
    EXPECT_EQ(gone[0].id, 2);
    EXPECT_EQ(gone[0].by, 7) << "5 is nearer but looks elsewhere, 8 goes too, and nobody knows 9 yet";
    EXPECT_NEAR(gone[0].by_from_id.translation().x(), -0.3, 1e-12) << "as they stood before";
    EXPECT_EQ(gone[1].id, 8);
    EXPECT_EQ(gone[1].by, 7);
}

TEST(Replacements, OfAnotherGraphSayNothing) {
    EXPECT_TRUE(replacements({}, {at_x(0, 0)}).empty());
    EXPECT_TRUE(replacements({at_x(0, 0), at_x(1, 1)}, {at_x(2, 0)}).empty());
    EXPECT_TRUE(replacements({at_x(0, 0)}, {}).empty());
    EXPECT_TRUE(replacements({at_x(0, 0)}, {at_x(0, 1), at_x(1, 1)}).empty());
}

TEST(KeyframePoses, AReplacedKeyframeMovesWithItsReplacementAndWithThatOnesOwn) {
    KeyframePoses poses;
    poses.update({at_x(0, 0), at_x(1, 1), at_x(2, 1.1), at_x(3, 1.3)});
    EXPECT_FALSE(poses.pose_of(4));
    poses.update({at_x(0, 0), at_x(2, 1.1), at_x(3, 1.3)});
    EXPECT_NEAR(poses.pose_of(1)->translation().x(), 1, 1e-12);
    poses.update({at_x(0, 0), at_x(2, 2.1), at_x(3, 2.3)});
    EXPECT_NEAR(poses.pose_of(1)->translation().x(), 2, 1e-12);
    poses.update({at_x(0, 0), at_x(3, 3.3)});  // 2 goes and 3 moves at once
    EXPECT_NEAR(poses.pose_of(1)->translation().x(), 3, 1e-12);
    EXPECT_NEAR(poses.pose_of(2)->translation().x(), 3.1, 1e-12);
    poses.update({at_x(0, 0), at_x(3, 1.3, 0.5)});
    const Pose turned = at_x(3, 1.3, 0.5).world_from_camera * at_x(3, 1.3).world_from_camera.inverse();
    EXPECT_TRUE(poses.pose_of(1)->isApprox(turned * at_x(1, 1).world_from_camera, 1e-12));
    poses.keep_replaced([](int id) { return id == 1; });
    EXPECT_TRUE(poses.pose_of(1));
    EXPECT_FALSE(poses.pose_of(2));
    poses.update({at_x(7, 0)});
    EXPECT_FALSE(poses.pose_of(1)) << "another graph says nothing";
}

}  // namespace
}  // namespace planemap
