// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_worker.hpp"

#include <gtest/gtest.h>

#include "octomap/scenes.hpp"

namespace planemap::octomap {
namespace {

using namespace std::chrono_literals;
using test::pose;
using test::room;
using test::small_camera;

std::shared_ptr<const StoredScan> scan(int i) {
    return std::make_shared<StoredScan>(room(small_camera(), static_cast<std::uint16_t>(20 * i)),
                                        small_camera());
}

KeyframeTrajectory moved(int count, double by, int revision) {
    std::vector<Pose> poses;
    for (int i = 0; i < count; ++i) poses.push_back(pose(0.1 * i + by, 0.05 * i));
    KeyframeTrajectory trajectory = test::trajectory(poses);
    trajectory.revision = revision;
    return trajectory;
}

TEST(OctomapWorker, EndsAtTheTreeOfTheLastPoses) {
    OctomapBuilder builder, alone;
    OctomapWorker worker(builder);
    for (int i = 0; i < 40; ++i) {
        worker.add(i, scan(i), pose(0.1 * i, 0.05 * i));
        if (i % 10 == 9) worker.update(moved(i + 1, 0.01 * i, i));
    }
    worker.finish(120s);
    const auto state = worker.newer_state();
    const KeyframeTrajectory last = moved(40, 0.39, 39);
    for (const KeyframePose& keyframe : last.keyframes)
        alone.keep(keyframe.id, scan(keyframe.id), keyframe.world_from_camera,
                   {keyframe.id, Pose::Identity()});
    alone.flush();
    ASSERT_TRUE(state.has_value());
    EXPECT_TRUE(state->is_up_to_date);
    EXPECT_EQ(state->keyframes, 40u);
    EXPECT_EQ(state->revision, 39);
    EXPECT_EQ(state->sizes.bt_bytes, alone.sizes().bt_bytes);
    EXPECT_TRUE(builder.tree() == alone.tree());
    EXPECT_FALSE(worker.newer_state().has_value()) << "each state is given once";
}

TEST(OctomapWorker, CountsWhatTheBuilderDoesNotTake) {
    OctomapBuilder builder;
    OctomapWorker worker(builder);
    Pose nan = Pose::Identity();
    nan.translation().x() = std::numeric_limits<double>::quiet_NaN();
    worker.add(0, scan(0), pose(0, 0));
    worker.add(1, scan(1), nan);
    worker.finish(120s);
    const auto state = worker.newer_state();
    ASSERT_TRUE(state.has_value());
    EXPECT_EQ(state->refused, 1u);
    EXPECT_EQ(state->keyframes, 1u);
}

TEST(OctomapWorker, RefusesWhatItHasNoRoomFor) {
    OctomapOptions fine;
    fine.resolution_m = 0.004;  // seconds of work a scan
    OctomapBuilder builder(fine);
    OctomapWorker worker(builder);
    const auto one = scan(0);
    int taken = 0;
    while (taken < 100000 && worker.add(taken, one, pose(0, 0))) ++taken;
    EXPECT_GE(taken, static_cast<int>(OctomapWorker::kMaxWaiting));
    EXPECT_LT(taken, static_cast<int>(OctomapWorker::kMaxWaiting) + 50);
}

TEST(OctomapWorker, AStopAbandonsWhatIsUnderWay) {
    OctomapOptions fine;
    fine.resolution_m = 0.004;  // seconds of work a scan
    OctomapBuilder builder(fine);
    {
        OctomapWorker worker(builder);
        for (int i = 0; i < 200; ++i) worker.add(i, scan(i), pose(0.1 * i, 0.05 * i));
        worker.finish(0ms);
        const auto state = worker.newer_state();
        EXPECT_FALSE(state.has_value() && state->is_up_to_date);
    }
    EXPECT_LT(builder.keyframes_in_tree(), 200u);
    OctomapWorker unused(builder);  // destroyed at once
}

}  // namespace
}  // namespace planemap::octomap
