// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_shell.hpp"

#include <planemap/map_size_t.hpp>

#include "shell_fixture.hpp"

namespace planemap {
namespace {

class OctomapShellTest : public test::ShellTest {};

TEST_F(OctomapShellTest, MapsTheDepthOfKeyframesAmongCorruptMessages) {
    OctomapShell shell(bus_, std::make_shared<FrameDecoder>(bus_), {});
    const auto sizes = collect<map_size_t>(channels::kOctomapSize);
    Keyframe keyframe;
    keyframe.id = 0;
    keyframe.utime = 1000;
    KeyframeTrajectory trajectory;
    trajectory.keyframes = {{0, 1000, Pose::Identity()}};
    publish_camera();
    publish_corrupt(channels::kFrame, frame(1));
    bus_.publish(channels::kFrame, frame(1000));
    publish_corrupt(channels::kKeyframe, to_message(keyframe, 0));
    bus_.publish(channels::kKeyframe, to_message(keyframe, 0));
    publish_corrupt(channels::kTrajectory, to_message(trajectory, 0));
    bus_.publish(channels::kTrajectory, to_message(trajectory, 0));
    bus_.drain();
    shell.finish();
    bus_.drain();
    ASSERT_EQ(sizes->size(), 1u);
    EXPECT_EQ(sizes->back().n_keyframes, 1);
    EXPECT_GT(sizes->back().n_occupied_leaves, 500);
    EXPECT_GT(sizes->back().memory_bytes, sizes->back().bt_bytes);
    EXPECT_EQ(shell.status().decode_error_count(), 3 * kCorrupt);
}

TEST_F(OctomapShellTest, AKeyframeWhoseFrameNeverCameIsCounted) {
    OctomapShell shell(bus_, std::make_shared<FrameDecoder>(bus_), {});
    Keyframe keyframe;
    keyframe.id = 0;
    keyframe.utime = 5;
    bus_.publish(channels::kKeyframe, to_message(keyframe, 0));
    bus_.drain();
    EXPECT_EQ(shell.status().dropped_count(), 1);
}

}  // namespace
}  // namespace planemap
