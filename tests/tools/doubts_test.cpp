// SPDX-License-Identifier: BSD-3-Clause
#include "run/doubts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace planemap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

DepthImage depth_of(std::uint16_t raw) {
    return DepthImage(64, 48, raw);
}

TEST(Doubts, DepthImagesWithoutAReadingAreCounted) {
    DepthCount count;
    for (const int raw : {1500, 0, 2000}) count.add(depth_of(static_cast<std::uint16_t>(raw)), CameraInfo());
    EXPECT_EQ(count.images, 3);
    EXPECT_EQ(count.empty, 1);
    EXPECT_THAT(doubts_of_depth(count), ElementsAre("1 of 3 depth images hold no reading"));
    EXPECT_THAT(doubts_of_depth({}), IsEmpty());
}

TEST(Doubts, DepthThatIsMostlyOutOfRangeMayHaveOtherUnits) {
    const CameraInfo camera;  // 0.3 to 8 m, in millimetres
    DepthCount good, bad;
    for (const int raw : {1000, 2500, 9000}) good.add(depth_of(static_cast<std::uint16_t>(raw)), camera);
    EXPECT_EQ(good.outside * 3, good.readings);
    EXPECT_THAT(doubts_of_depth(good), IsEmpty());
    for (const int raw : {1500, 10000, 12500}) bad.add(depth_of(static_cast<std::uint16_t>(raw)), camera);
    EXPECT_THAT(doubts_of_depth(bad), ElementsAre(HasSubstr("67 % of the depth readings are out of")));
}

/// A walk along x of 0.4 m/s for 4 s.
std::vector<OdometryEstimate> walk() {
    std::vector<OdometryEstimate> walk(120);
    for (std::size_t i = 0; i < walk.size(); ++i) {
        walk[i].utime = walk[i].pose_utime = 1000000 + 33333 * static_cast<std::int64_t>(i);
        walk[i].status = TrackingStatus::kTracked;
        walk[i].odom_from_camera.translation().x() = 0.4 * static_cast<double>(i) / 30;
    }
    return walk;
}

Trajectory poses_of(const std::vector<OdometryEstimate>& walk, double factor) {
    Trajectory poses;
    const Pose world_from_odom(Eigen::Translation3d(3, 2, 1) *
                               Eigen::AngleAxisd(1, Eigen::Vector3d::UnitZ()));
    for (const OdometryEstimate& estimate : walk) {
        Pose pose = estimate.odom_from_camera;
        pose.translation() *= factor;
        poses.push_back({estimate.pose_utime, world_from_odom * pose});
    }
    return poses;
}

TEST(Doubts, PosesThatMoveOtherwiseThanTheCameraWasSeenTo) {
    const auto seen = walk();
    EXPECT_EQ(doubt_of_given_poses(poses_of(seen, 1), seen), "") << "their world is another one";
    EXPECT_EQ(doubt_of_given_poses(poses_of(seen, 1.1), seen), "") << "odometry errs, too";
    EXPECT_THAT(doubt_of_given_poses(poses_of(seen, 1000), seen), HasSubstr("by 399.60 m and 0.0 deg"));
    EXPECT_THAT(doubt_of_given_poses(poses_of(seen, 0), seen), HasSubstr("over a second"));
    EXPECT_EQ(doubt_of_given_poses({}, seen), "");
    EXPECT_EQ(doubt_of_given_poses(poses_of(seen, 0), {}), "") << "nothing was seen";
    auto often = seen;  // a stamp that comes twice, and time that goes back
    often.insert(often.end(), seen.begin(), seen.end());
    EXPECT_EQ(doubt_of_given_poses(poses_of(seen, 1), often), "");
}

PlaneMap map_of(const std::vector<std::pair<int, int>>& ids_and_keyframes) {
    PlaneMap map;
    for (const auto& [id, keyframes] : ids_and_keyframes) {
        map.planes.emplace_back();
        map.planes.back().id = id;
        map.planes.back().keyframes = static_cast<std::int16_t>(keyframes);
    }
    return map;
}

TEST(Doubts, AMapThatWasStartedFromAndNotSeenAgain) {
    const PlaneMap start = map_of({{1, 5}, {4, 9}});
    EXPECT_THAT(doubt_of_start(start, map_of({{1, 5}, {4, 9}, {7, 3}})), HasSubstr("none of the 2 planes"));
    EXPECT_EQ(doubt_of_start(start, map_of({{1, 6}, {4, 9}})), "");
    EXPECT_EQ(doubt_of_start(start, map_of({{1, 5}})), "") << "the other one was seen to be gone";
    EXPECT_EQ(doubt_of_start({}, map_of({{1, 6}})), "");
    const PlaneMap often = map_of({{1, std::numeric_limits<std::int16_t>::max()}});
    EXPECT_EQ(doubt_of_start(often, often), "") << "it counts no further";
}

}  // namespace
}  // namespace planemap
