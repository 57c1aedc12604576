// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph_shell.hpp"

#include <chrono>
#include <thread>

#include "core/trajectory_file.hpp"
#include "messages/session.hpp"
#include "messages/told_status.hpp"
#include "places/synthetic.hpp"
#include "shell_fixture.hpp"
#include "temporary_folder.hpp"

namespace planemap::graph {
namespace {

class GraphShellTest : public test::ShellTest {};

TEST_F(GraphShellTest, PublishesTheTrajectoryAmongCorruptMessages) {
    GraphShell shell(bus_, {});
    const auto trajectories = collect<trajectory_t>(messages::channels::kTrajectory);
    Keyframe keyframe;
    keyframe.covariance = Matrix6d::Identity() * 1e-4;
    for (int id = 0; id < 3; ++id) {
        keyframe.id = id;
        keyframe.previous_id = id - 1;
        keyframe.utime = keyframe.pose_utime = 1000 * id;
        keyframe.odom_from_camera.translation().x() = 0.1 * id;
        keyframe.previous_from_camera.translation().x() = id == 0 ? 0 : 0.1;
        publish_corrupt(messages::channels::kKeyframe, messages::to_message(keyframe, id));
        bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, id));
    }
    bus_.publish(messages::channels::kKeyframe,
                 messages::to_message(keyframe, 3));  // the same id and time again: refused
    bus_.drain();
    ASSERT_EQ(trajectories->size(), 3u);
    const KeyframeTrajectory last = messages::from_message(trajectories->back());
    ASSERT_EQ(last.keyframes.size(), 3u);
    EXPECT_NEAR(last.keyframes[2].world_from_camera.translation().x(), 0.2, 1e-9);
    EXPECT_EQ(shell.status().decode_error_count(), 3 * kCorrupt);
    EXPECT_EQ(shell.status().losses().at("keyframes from before those that came"), 1);
}

TEST_F(GraphShellTest, TheLastTrajectoryIsRepeatedForThoseWhoComeLate) {
    GraphShell shell(bus_, {});
    Keyframe keyframe;
    keyframe.id = 0;
    bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, 0));
    bus_.drain();
    const auto late = collect<trajectory_t>(messages::channels::kTrajectory);
    shell.poll();
    bus_.drain();
    EXPECT_TRUE(late->empty());
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    for (int i = 0; i < 3; ++i) shell.poll();
    bus_.drain();
    ASSERT_EQ(late->size(), 1u);
    EXPECT_EQ(late->back().seq, 0) << "the same message, not a new one";
    EXPECT_EQ(late->back().n_keyframes, 1);
}

TEST_F(GraphShellTest, AnotherOdometrysKeyframesAreCountedAndNotUsed) {
    GraphShell shell(bus_, {});
    Keyframe keyframe;
    keyframe.covariance = Matrix6d::Identity() * 1e-4;
    const auto publish = [&](int id, std::int32_t seq, double x) {
        keyframe.id = id;
        keyframe.utime = keyframe.pose_utime = 1000000 * id;
        keyframe.odom_from_camera.translation().x() = x;
        bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, seq));
        bus_.drain();
    };
    for (int i = 0; i < 10; ++i) publish(i, 100 + i, 0.1 * i);
    for (int i = 10; i < 20; ++i) {
        publish(i, 100 + i, 0.1 * i);
        publish(i - 10, i - 10, 7);  // an old log's
    }
    EXPECT_EQ(shell.graph().trajectory().keyframes.size(), 20u);
    EXPECT_EQ(shell.status().decode_error_count(), 0);
    EXPECT_EQ(shell.status().losses().at("keyframes of another sender") +
                  shell.status().losses().at("keyframes from before those that came"),
              10);
}

TEST_F(GraphShellTest, AnOdometryThatStartedAgainIsNotTakenForTheFirst) {
    GraphShell shell(bus_, {});
    Keyframe keyframe;
    keyframe.covariance = Matrix6d::Identity() * 1e-4;
    std::int32_t seq = 0;
    const auto publish = [&](int id) {
        keyframe.id = id;
        keyframe.utime = keyframe.pose_utime += 1000000;
        bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, seq++));
        bus_.drain();
    };
    for (int id = 0; id < 6; ++id) publish(id);
    for (int id = 0; id < 12; ++id) publish(id);
    EXPECT_EQ(shell.graph().trajectory().keyframes.size(), 6u) << "its sixth is not the first one's";
    EXPECT_EQ(shell.status().losses().at("keyframes with an id out of order"), 12);
    EXPECT_NE(shell.status().line().find("odometry started again"), std::string::npos)
        << shell.status().line();

    keyframe.chain = 106;  // it heard of the first one's ids, and begins beyond them
    publish(106);
    keyframe.previous_id = 106;
    publish(107);
    const std::vector<KeyframePose>& named = shell.graph().trajectory().keyframes;
    ASSERT_EQ(named.size(), 8u);
    EXPECT_EQ(named[6].component, 106);
    EXPECT_EQ(named[7].component, 106);
}

TEST_F(GraphShellTest, SaysThatAPartBegins) {
    GraphShell shell(bus_, {});
    Keyframe keyframe;
    keyframe.covariance = Matrix6d::Identity() * 1e-4;
    for (int id = 0; id < 4; ++id) {
        keyframe.id = id;
        keyframe.previous_id = id == 2 ? -1 : id - 1;
        keyframe.utime = keyframe.pose_utime = 1000000 * (id + 1);
        bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, id));
        bus_.drain();
        EXPECT_EQ(shell.status().remarks().size(), id < 2 ? 0u : 1u) << id;
    }
    EXPECT_NE(shell.status().line().find("4 keyframes, 0 loop closures; keyframe 2, at 3.000 s"),
              std::string::npos)
        << shell.status().line();
}

TEST_F(GraphShellTest, WhatItLeavesOutIsCounted) {
    GraphShell shell(bus_, {});
    const auto trajectories = collect<trajectory_t>(messages::channels::kTrajectory);
    Keyframe keyframe;
    keyframe.covariance = Matrix6d::Identity() * 1e-4;
    keyframe.features.resize(5);  // all at the camera's centre
    std::int32_t seq = 0;
    const auto publish = [&](int id) {
        keyframe.id = id;
        keyframe.utime = keyframe.pose_utime += 1000000;
        bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, seq++));
        bus_.drain();
    };
    for (const int id : {3, 4, 2147483647, 5, 0, 1, 6}) publish(id);
    EXPECT_EQ(trajectories->size(), 4u) << "3 to 6; nothing stops at the others";
    EXPECT_EQ(shell.status().losses().at("keyframes with an id out of order"), 3);
    EXPECT_EQ(test::told(shell.status()).dropped, 3);
    EXPECT_EQ(shell.status().losses().at(
                  "features without a point before the camera, or beyond the most of a keyframe"),
              4 * 5);
    EXPECT_EQ(shell.status().decode_error_count(), 0);
}

TEST_F(GraphShellTest, TheBackgroundComesToTheSameTrajectory) {
    test::Random random(1);
    const auto room = test::make_room(random, Eigen::Vector3d::Zero(), 3.5, 3000);
    const test::Walk walk = test::walk(room, test::square_loop(3, 12, 1.2), random);
    PoseGraph alone;
    GraphShell shell(bus_, {}, Optimising::kInBackground);
    const auto trajectories = collect<trajectory_t>(messages::channels::kTrajectory);
    for (const Keyframe& keyframe : walk.keyframes) {
        alone.add(keyframe);
        shell.poll();
        bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, keyframe.id));
        bus_.drain();
        const KeyframeTrajectory newest = messages::from_message(trajectories->back());
        ASSERT_EQ(newest.keyframes.size(), static_cast<std::size_t>(keyframe.id) + 1)
            << "a keyframe does not wait for the optimisation";
        EXPECT_TRUE((newest.world_from_odom * keyframe.odom_from_camera)
                        .isApprox(newest.keyframes.back().world_from_camera, 1e-6));
    }
    alone.finish();
    shell.finish();
    bus_.drain();
    EXPECT_GT(shell.graph().trajectory().loop_closures, 3);
    const KeyframeTrajectory last = messages::from_message(trajectories->back());
    for (std::size_t i = 0; i < walk.keyframes.size(); ++i) {
        EXPECT_LT((last.keyframes[i].world_from_camera.translation() -
                   alone.trajectory().keyframes[i].world_from_camera.translation())
                      .norm(),
                  0.05);
    }
}

TEST_F(GraphShellTest, EndsWhileTheBackgroundIsAtWork) {
    test::Random random(1);
    const auto room = test::make_room(random, Eigen::Vector3d::Zero(), 3.5, 3000);
    const test::Walk walk = test::walk(room, test::square_loop(3, 12, 1.1), random);
    GraphShell shell(bus_, {}, Optimising::kInBackground);
    for (const Keyframe& keyframe : walk.keyframes)
        bus_.publish(messages::channels::kKeyframe, messages::to_message(keyframe, keyframe.id));
    bus_.drain();
    EXPECT_EQ(shell.graph().trajectory().keyframes.size(), walk.keyframes.size());
}

/// As after a SIGKILL: nothing is told to finish.
TEST_F(GraphShellTest, AProcessThatIsStartedAgainGoesOnInItsWorldFrameWithItsIds) {
    const TemporaryFolder folder;
    GraphFiles files;
    files.journal = folder / "graph.journal";
    files.output = folder / "out";
    test::Random random(1);
    const auto room = test::make_room(random, Eigen::Vector3d::Zero(), 3.5, 3000);
    const test::Walk walk = test::walk(room, test::square_loop(3, 12, 1.1), random);
    const std::size_t half = walk.keyframes.size() / 2;
    KeyframeTrajectory before;
    {
        messages::Bus bus("memq://");
        GraphShell killed(bus, {}, Optimising::kInHandler, files);
        for (std::size_t i = 0; i < half; ++i)
            bus.publish(messages::channels::kKeyframe,
                        messages::to_message(walk.keyframes[i], static_cast<std::int32_t>(i), 7));
        bus.drain();
        before = killed.graph().trajectory();
        ASSERT_EQ(before.keyframes.size(), half);
    }
    GraphShell shell(bus_, {}, Optimising::kInHandler, files);
    ASSERT_EQ(shell.graph().trajectory().keyframes.size(), half);
    for (std::size_t i = 0; i < half; ++i) {
        EXPECT_EQ(shell.graph().trajectory().keyframes[i].id, before.keyframes[i].id);
        EXPECT_TRUE(shell.graph().trajectory().keyframes[i].world_from_camera.isApprox(
            before.keyframes[i].world_from_camera, 1e-9));
    }
    for (std::size_t i = half - 2; i < walk.keyframes.size(); ++i)  // two of them odometry sends again
        bus_.publish(messages::channels::kKeyframe,
                     messages::to_message(walk.keyframes[i], static_cast<std::int32_t>(i), 7));
    bus_.drain();
    EXPECT_EQ(shell.graph().trajectory().keyframes.size(), walk.keyframes.size());
    EXPECT_EQ(test::told(shell.status()).dropped, 0);
    // Odometry was started again, too: another session that follows, ids further on, a part of its own.
    Keyframe next = walk.keyframes.back();
    next.id += 101;
    next.previous_id = -1;
    next.utime += 1000000;
    next.pose_utime = next.utime;
    bus_.publish(messages::channels::kKeyframe, messages::to_message(next, 0, messages::next_session(7)));
    bus_.drain();
    EXPECT_EQ(shell.graph().trajectory().keyframes.back().id, next.id);
    ASSERT_EQ(shell.status().remarks().size(), 1u);
    EXPECT_NE(shell.status().remarks()[0].find("does not hang on those before"), std::string::npos);
    shell.finish();
    EXPECT_EQ(read_trajectory_file(folder / "out/trajectory.txt").poses.size(), walk.keyframes.size() + 1);
}

}  // namespace
}  // namespace planemap::graph
