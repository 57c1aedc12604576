// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_shell.hpp"

#include <chrono>
#include <planemap/map_size_t.hpp>
#include <thread>

#include "messages/told_status.hpp"
#include "shell_fixture.hpp"
#include "temporary_folder.hpp"

namespace planemap::octomap {
namespace {

class OctomapShellTest : public test::ShellTest {
  protected:
    /// Frames, keyframes and the trajectory after each.
    void walk(int keyframes) {
        for (int id = 0; id < keyframes; ++id) {
            Keyframe keyframe;
            keyframe.id = id;
            keyframe.utime = 1000 * (id + 1);
            bus_.publish(messages::channels::kFrame, frame(keyframe.utime));
            bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, id));
            Pose pose = Pose::Identity();
            pose.translation().x() = 0.1 * id;
            trajectory_.keyframes.push_back({id, keyframe.utime, pose});
            trajectory_.utime = keyframe.utime;
            ++trajectory_.revision;
            bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory_, seq_++));
        }
    }
    /// The trajectory again, with all keyframes `shift` metres aside.
    void correct(double shift) {
        for (KeyframePose& keyframe : trajectory_.keyframes)
            keyframe.world_from_camera.translation().x() += shift;
        ++trajectory_.revision;
        bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory_, seq_++));
    }

    KeyframeTrajectory trajectory_;
    std::int32_t seq_ = 0;
};

TEST_F(OctomapShellTest, MapsTheDepthOfKeyframesAmongCorruptMessages) {
    OctomapShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto sizes = collect<map_size_t>(messages::channels::kOctomapSize);
    Keyframe keyframe;
    keyframe.id = 0;
    keyframe.utime = 1000;
    KeyframeTrajectory trajectory;
    trajectory.keyframes = {{0, 1000, Pose::Identity()}};
    publish_camera();
    publish_corrupt(messages::channels::kFrame, frame(1));
    bus_.publish(messages::channels::kFrame, frame(1000));
    publish_corrupt(messages::channels::kKeyframe, messages::to_message(keyframe, 0));
    bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, 0));
    publish_corrupt(messages::channels::kTrajectory, messages::to_message(trajectory, 0));
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory, 0));
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
    OctomapShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    Keyframe keyframe;
    keyframe.id = 0;
    keyframe.utime = 5;
    bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, 0));
    bus_.drain();
    EXPECT_EQ(test::told(shell.status()).dropped, 1);
    EXPECT_EQ(shell.status().losses().at("keyframes whose frame was gone"), 1);
}

TEST_F(OctomapShellTest, AKeyframeThatNeverGotAPoseIsCounted) {
    OctomapShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    publish_camera();
    bus_.publish(messages::channels::kFrame, frame(1000));
    Keyframe keyframe;
    keyframe.id = 0;
    keyframe.utime = 1000;
    bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, 0));
    bus_.drain();
    EXPECT_EQ(test::told(shell.status()).dropped, 0);
    shell.finish();
    EXPECT_EQ(test::told(shell.status()).dropped, 1);
    EXPECT_EQ(shell.status().losses().at("keyframes that never got a pose"), 1);
}

TEST_F(OctomapShellTest, AnOctoMapThatWasStartedAgainSaysWhatItLacks) {
    OctomapShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    publish_camera();
    for (int id = -3; id < 0; ++id) trajectory_.keyframes.push_back({10 + id, 10 + id, Pose::Identity()});
    trajectory_.utime = 9;
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory_, seq_++));
    bus_.drain();
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));
    shell.poll();
    EXPECT_NE(shell.status().line().find(
                  "3 keyframes of the trajectory were never received: the OctoMap is incomplete"),
              std::string::npos)
        << shell.status().line();
}

TEST_F(OctomapShellTest, FrozenKeyframesAreCounted) {
    OctomapOptions options;
    options.max_keyframes = 2;
    OctomapShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), options);
    publish_camera();
    walk(5);
    bus_.drain();
    shell.finish();
    EXPECT_EQ(test::told(shell.status()).dropped, 0);
    EXPECT_EQ(shell.status().losses().at("depth images of old keyframes, which stay at their pose"), 3);
}

TEST_F(OctomapShellTest, TheBackgroundComesToTheSameSizes) {
    OctomapShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    OctomapShell background(bus_, std::make_shared<messages::FrameDecoder>(bus_), {},
                            Building::kInBackground);
    const auto sizes = collect<map_size_t>(messages::channels::kOctomapSize);
    publish_camera();
    walk(12);
    bus_.drain();
    correct(0.04);
    bus_.drain();
    EXPECT_EQ(test::told(background.status()).dropped, 0);
    // No time is asserted: it is asked until it has caught up, which the test's time-out bounds.
    while (sizes->empty() || sizes->back().revision != 13 ||
           background.status().line().find("not yet where") != std::string::npos) {
        background.poll();
        bus_.drain();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    background.finish();
    shell.finish();
    bus_.drain();
    ASSERT_GE(sizes->size(), 2u);
    const map_size_t &ours = (*sizes)[sizes->size() - 2], &theirs = sizes->back();
    EXPECT_EQ(ours.n_keyframes, 12);
    EXPECT_EQ(ours.revision, theirs.revision);
    EXPECT_EQ(ours.bt_bytes, theirs.bt_bytes);
    EXPECT_EQ(ours.n_nodes, theirs.n_nodes);
}

/// As after a SIGKILL: nothing is told to finish.
TEST_F(OctomapShellTest, AProcessThatIsStartedAgainHasTheDepthOfItsKeyframes) {
    const TemporaryFolder folder;
    OctomapFiles files;
    files.journal = folder / "octomap.journal";
    files.output = folder / "out";
    std::size_t before = 0;
    {
        OctomapShell killed(bus_, std::make_shared<messages::FrameDecoder>(bus_), {}, Building::kInHandler,
                            files);
        publish_camera();
        walk(3);
        bus_.drain();
        killed.poll();
        bus_.drain();
        before = killed.builder().sizes().occupied_leaves;
        ASSERT_GT(before, 0u);
    }
    messages::Bus bus("memq://");
    OctomapShell shell(bus, std::make_shared<messages::FrameDecoder>(bus), {}, Building::kInHandler, files);
    shell.finish();
    EXPECT_EQ(shell.builder().keyframes_in_tree(), 3u);
    EXPECT_EQ(shell.builder().sizes().occupied_leaves, before);
    EXPECT_GT(std::filesystem::file_size(folder / "out/octomap.bt"), 100u);
}

}  // namespace
}  // namespace planemap::octomap
