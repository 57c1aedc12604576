// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/rigid_motion.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

TEST(RigidMotion, LaysPointsOnTheirCounterparts) {
    const Pose motion = make_pose({3, -2, 0.7}, Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2));
    Eigen::Matrix3Xd from(3, 4);
    from << 0, 1, 0, 0.3, 0, 0, 2, 0.5, 0, 0, 0, 0.7;
    const Eigen::Matrix3Xd to = motion * from;
    const Eigen::Vector3d to_mean = to.rowwise().mean(), from_mean = from.rowwise().mean();
    const Pose found =
        rigid_motion((to.colwise() - to_mean) * (from.colwise() - from_mean).transpose(), to_mean, from_mean);
    EXPECT_TRUE(found.isApprox(motion, 1e-9));
}

TEST(RigidMotion, IsNeverAMirror) {
    const Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const Eigen::Matrix3d& correlation : {Eigen::Matrix3d(Eigen::Vector3d(1, 1, -1).asDiagonal()),
                                               Eigen::Matrix3d(Eigen::Matrix3d::Zero())}) {
        EXPECT_NEAR(rigid_motion(correlation, mean, mean).linear().determinant(), 1, 1e-9);
    }
}

}  // namespace
}  // namespace planemap
