// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph_shell.hpp"

#include "shell_fixture.hpp"

namespace planemap {
namespace {

class GraphShellTest : public test::ShellTest {};

TEST_F(GraphShellTest, PublishesTheTrajectoryAmongCorruptMessages) {
    GraphShell shell(bus_, {});
    const auto trajectories = collect<trajectory_t>(channels::kTrajectory);
    Keyframe keyframe;
    keyframe.covariance = Matrix6d::Identity() * 1e-4;
    for (int id = 0; id < 3; ++id) {
        keyframe.id = id;
        keyframe.previous_id = id - 1;
        keyframe.utime = keyframe.pose_utime = 1000 * id;
        keyframe.odom_from_camera.translation().x() = 0.1 * id;
        keyframe.previous_from_camera.translation().x() = id == 0 ? 0 : 0.1;
        publish_corrupt(channels::kKeyframe, to_message(keyframe, id));
        bus_.publish(channels::kKeyframe, to_message(keyframe, id));
    }
    bus_.publish(channels::kKeyframe, to_message(keyframe, 3));  // the same id again: refused
    bus_.drain();
    ASSERT_EQ(trajectories->size(), 3u);
    const KeyframeTrajectory last = from_message(trajectories->back());
    ASSERT_EQ(last.keyframes.size(), 3u);
    EXPECT_NEAR(last.keyframes[2].world_from_camera.translation().x(), 0.2, 1e-9);
    EXPECT_EQ(shell.status().decode_error_count(), 3 * kCorrupt + 1);
}

}  // namespace
}  // namespace planemap
