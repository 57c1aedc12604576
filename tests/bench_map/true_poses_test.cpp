// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/true_poses.hpp"

#include <gtest/gtest.h>

#include "pipeline/given_poses.hpp"

namespace planemap::bench_map {
namespace {

Pose pose_of(double t) {
    return make_pose({t, 2 * t, -t},
                     Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * t, Eigen::Vector3d::UnitZ())));
}

Trajectory path() {
    Trajectory path;
    for (int i = 0; i <= 10; ++i) path.push_back({i * 40000, pose_of(0.1 * i)});
    return path;
}

Keyframe keyframe(int id, std::int64_t utime) {
    Keyframe keyframe;
    keyframe.id = id;
    keyframe.utime = utime;
    return keyframe;
}

TEST(TruePoses, AreInterpolatedAndNeverInvented) {
    EXPECT_TRUE(pipeline::given_pose(path(), 80000)->isApprox(pose_of(0.2)));
    EXPECT_TRUE(pipeline::given_pose(path(), 100000)->isApprox(pose_of(0.25), 1e-6));
    EXPECT_FALSE(pipeline::given_pose(path(), -1));
    EXPECT_FALSE(pipeline::given_pose(path(), 400001));
    EXPECT_FALSE(pipeline::given_pose({}, 0));
    Trajectory gap = path();
    gap.erase(gap.begin() + 3, gap.begin() + 6);
    EXPECT_FALSE(pipeline::given_pose(gap, 120000));
}

TEST(TruePoses, OfKeyframesThatHaveOne) {
    const auto poses = at_poses({keyframe(3, 40000), keyframe(4, 999999), keyframe(7, 60000)}, path());
    ASSERT_EQ(poses.keyframes.size(), 2u);
    EXPECT_EQ(poses.keyframes[0].id, 3);
    EXPECT_EQ(poses.keyframes[1].id, 7);
    EXPECT_EQ(poses.utime, 60000);
    EXPECT_TRUE(poses.keyframes[1].world_from_camera.isApprox(pose_of(0.15), 1e-6));
}

TEST(Alignment, FindsARigidMotionEvenWithoutMoving) {
    const Pose motion = make_pose({3, -2, 0.7}, Eigen::Quaterniond(0.8, 0.3, -0.4, 0.2));
    for (const std::size_t count : {1u, 2u, 11u}) {
        KeyframeTrajectory from, to;
        for (std::size_t i = 0; i < count; ++i) {
            const Pose pose = pose_of(0.1 * static_cast<double>(i));
            from.keyframes.push_back({static_cast<int>(i), 0, pose});
            to.keyframes.push_back({static_cast<int>(i), 0, motion * pose});
        }
        to.keyframes.push_back({99, 0, Pose::Identity()});  // not in both
        ASSERT_TRUE(alignment(to, from)) << count;
        EXPECT_TRUE(alignment(to, from)->isApprox(motion, 1e-9)) << count;
    }
    EXPECT_FALSE(alignment({}, {}));
}

}  // namespace
}  // namespace planemap::bench_map
