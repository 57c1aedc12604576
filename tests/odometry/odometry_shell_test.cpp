// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odometry_shell.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bot_core/pose_t.hpp>
#include <chrono>
#include <limits>
#include <thread>

#include "shell_fixture.hpp"
#include "temporary_folder.hpp"

namespace planemap::odometry {
namespace {

using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

class OdometryShellTest : public test::ShellTest {
  protected:
    void publish_regions(std::int64_t utime) {
        bus_.publish(messages::channels::kRegions,
                     messages::to_message(messages::FrameRegions{utime, {}}, 0));
    }
    /// The wall of frame().
    static PlanarRegion wall() {
        PlanarRegion wall;
        for (int i = 0; i < 400; ++i) wall.moments.add({0.05 * (i % 20) - 0.5, 0.05 * (i / 20) - 0.5, 2});
        const PlaneFit fit = fit_plane(wall.moments);
        wall.plane = fit.plane;
        wall.box.frame_from_box.linear() = principal_axes(fit.plane, wall.moments);
        wall.box.frame_from_box.translation() = wall.moments.mean();
        wall.box.half_extents = {0.5, 0.5, 0};
        wall.outline.rings = {{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
        return wall;
    }
    /// Frames with their regions, as many as `count`, moved sideways by `from`, and `step` more each.
    static void publish_walk(messages::Bus& bus, std::int64_t utime, int count, double from, double step) {
        for (int i = 0; i < count; ++i, utime += 33333) {
            bus.publish(messages::channels::kFrame, frame(utime, from + step * i));
            bus.publish(messages::channels::kRegions,
                        messages::to_message(messages::FrameRegions{utime, {wall()}}, i));
            bus.drain();
        }
    }
};

TEST_F(OdometryShellTest, TracksAmongCorruptMessages) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto estimates = collect<odometry_t>(messages::channels::kOdometry);
    const auto keyframes = collect<keyframe_t>(messages::channels::kKeyframe);
    publish_camera();
    for (int i = 0; i < 10; ++i) {
        const std::int64_t utime = 1000000 + 33333 * i;
        publish_corrupt(messages::channels::kFrame, frame(1));
        publish_corrupt(messages::channels::kRegions,
                        messages::to_message(messages::FrameRegions{utime, {}}, 0));
        bus_.publish(messages::channels::kFrame, frame(utime, 0.01 * i));
        publish_regions(utime);
        bus_.drain();
    }
    ASSERT_EQ(estimates->size(), 10u);
    ASSERT_FALSE(keyframes->empty());
    EXPECT_EQ(keyframes->front().id, 0);
    const OdometryEstimate last = messages::from_message(estimates->back());
    EXPECT_EQ(last.status, TrackingStatus::kTracked)
        << last.inliers << " of " << last.features << " features";
    EXPECT_NEAR(last.odom_from_camera.translation().x(), 0.09, 0.02);
    EXPECT_EQ(shell.status().decode_error_count(), 20 * kCorrupt);
}

TEST_F(OdometryShellTest, TellsTheBodysPoseWhenItKnowsHowTheBodyLies) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto bodies = collect<bot_core::pose_t>(messages::channels::kPose);
    const auto mounts = collect<bot_core::rigid_transform_t>(messages::channels::kBodyFromCamera);
    const auto keyframes = collect<keyframe_t>(messages::channels::kKeyframe);
    publish_camera();
    for (int i = 0; i < 10; ++i) {
        const std::int64_t utime = 1000000 + 33333 * i;
        bus_.publish(messages::channels::kFrame, frame(utime, 0.02 * i));
        publish_regions(utime);
        bus_.drain();
        if (i != 4) continue;
        EXPECT_TRUE(bodies->empty());
        EXPECT_NE(shell.status().line().find("POSE_BODY waits for up"), std::string::npos);
        // Of another session: it does not hold our first keyframe.
        KeyframeTrajectory trajectory;
        trajectory.keyframes = {{0, 77, Pose::Identity()}};
        PlaneMap map;
        map.up = {0, 0, 1};
        bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory, 0));
        bus_.publish(messages::channels::kMap, messages::to_message(map, 0));
        bus_.drain();
        // The world's z is up, and the camera looks along its x.
        trajectory.keyframes = {{keyframes->front().id, keyframes->front().utime, Pose::Identity()}};
        trajectory.keyframes.front().world_from_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
        bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory, 1));
        bus_.publish(messages::channels::kMap, messages::to_message(map, 1));
        bus_.drain();
    }
    ASSERT_EQ(bodies->size(), 5u);
    ASSERT_EQ(mounts->size(), 1u) << "once a second";
    // The camera moves to its right by 0.02 m a frame: to the body's -y, 0.6 m/s.
    EXPECT_NEAR(bodies->back().pos[1], -0.18, 0.02);
    EXPECT_NEAR(bodies->back().pos[0], 0, 0.02);
    EXPECT_NEAR(bodies->back().vel[1], -0.6, 0.1);
    EXPECT_NEAR(bodies->back().orientation[0], 1, 1e-3);
    EXPECT_NEAR(bodies->back().rotation_rate[2], 0, 0.05);
}

TEST_F(OdometryShellTest, TellsTheBodysPoseAfterALossOnceALoopClosureSaysWhereThatWas) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto bodies = collect<bot_core::pose_t>(messages::channels::kPose);
    const auto keyframes = collect<keyframe_t>(messages::channels::kKeyframe);
    publish_camera();
    const auto see = [&](std::int64_t start) {
        for (int i = 0; i < 5; ++i) {
            bus_.publish(messages::channels::kFrame, frame(start + 33333 * i));
            publish_regions(start + 33333 * i);
            bus_.drain();
        }
    };
    see(500000000);
    KeyframeTrajectory trajectory;
    trajectory.keyframes = {{keyframes->front().id, keyframes->front().utime, Pose::Identity()}};
    trajectory.keyframes.front().world_from_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    PlaneMap map;
    map.up = {0, 0, 1};
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory, 0));
    bus_.publish(messages::channels::kMap, messages::to_message(map, 0));
    bus_.drain();
    see(500300000);
    ASSERT_FALSE(bodies->empty());
    EXPECT_NEAR(bodies->back().pos[0], 0, 0.02);

    bodies->clear();
    see(1000000);  // the sensor started again
    EXPECT_TRUE(bodies->empty());
    const keyframe_t& again = keyframes->back();
    ASSERT_EQ(again.previous_id, -1);
    trajectory.keyframes.push_back(
        {again.id, again.utime, trajectory.keyframes[0].world_from_camera, again.id});
    trajectory.keyframes.back().world_from_camera.translation().x() = 2;
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory, 1));
    bus_.drain();
    see(1300000);
    EXPECT_TRUE(bodies->empty()) << "they do not hang together yet";
    trajectory.keyframes.back().component = trajectory.keyframes.front().component;
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory, 2));
    bus_.drain();
    see(1600000);
    ASSERT_FALSE(bodies->empty());
    EXPECT_NEAR(bodies->back().pos[0], 2, 0.02);
    EXPECT_NEAR(bodies->back().pos[1], 0, 0.02);
}

bot_core::pose_t prior(std::int64_t utime) {
    bot_core::pose_t pose{};
    pose.utime = utime;
    pose.orientation[0] = 1;
    return pose;
}

TEST_F(OdometryShellTest, HearsMotionPriorsAmongCorruptOnesAndCountsThem) {
    OdometryOptions options;
    options.motion.channel = "WHEELS";
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), options);
    const auto estimates = collect<odometry_t>(messages::channels::kOdometry);
    publish_camera();  // which says nothing of a mount
    bot_core::pose_t bad = prior(900000);
    bad.orientation[0] = 7;
    bus_.publish("WHEELS", bad);
    publish_corrupt("WHEELS", prior(900000));
    for (int i = 0; i < 5; ++i) {
        const std::int64_t utime = 1000000 + 33333 * i;
        bus_.publish("WHEELS", prior(utime));
        bus_.publish("WHEELS", prior(utime));  // twice
        bus_.publish(messages::channels::kFrame, frame(utime, 0.01 * i));
        publish_regions(utime);
        bus_.drain();
    }
    ASSERT_EQ(estimates->size(), 5u);
    EXPECT_EQ(messages::from_message(estimates->back()).status, TrackingStatus::kTracked);
    EXPECT_EQ(shell.status().losses().at(OdometryShell::kPriorBroken), 5);
    EXPECT_EQ(shell.status().losses().at(OdometryShell::kPriorNoMount), 4) << "all but the first frame";
}

TEST_F(OdometryShellTest, ItsOwnPosesAreNoPrior) {
    OdometryOptions options;
    options.motion.channel = messages::channels::kPose;
    EXPECT_THROW(OdometryShell(bus_, std::make_shared<messages::FrameDecoder>(bus_), options),
                 std::invalid_argument);
}

TEST_F(OdometryShellTest, WithoutAJournalItsIdsBeginAfterThoseThatTheGraphKnows) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto keyframes = collect<keyframe_t>(messages::channels::kKeyframe);
    publish_camera();
    const auto see = [&](std::int64_t utime) {
        bus_.publish(messages::channels::kFrame, frame(utime));
        publish_regions(utime);
        bus_.drain();
    };
    see(1000000);
    ASSERT_EQ(keyframes->size(), 1u);
    EXPECT_EQ(keyframes->front().id, 0);
    KeyframeTrajectory trajectory;
    trajectory.keyframes = {{0, 77, Pose::Identity()}, {41, 88, Pose::Identity()}};
    for (int seq = 0; seq < 2; ++seq) {
        bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory, seq));
        bus_.drain();
        see(1033333 + 33333 * seq);
        ASSERT_EQ(keyframes->size(), 2u) << "one new chain";
        EXPECT_GT(keyframes->back().id, 41);
        EXPECT_EQ(keyframes->back().previous_id, -1);
        EXPECT_EQ(keyframes->back().chain, keyframes->back().id);
    }
}

TEST_F(OdometryShellTest, ATrajectoryOfAbsurdIdsMovesNothing) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto keyframes = collect<keyframe_t>(messages::channels::kKeyframe);
    publish_camera();
    KeyframeTrajectory trajectory;
    trajectory.keyframes = {{std::numeric_limits<int>::max(), 77, Pose::Identity()}};
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory, 0));
    bus_.drain();
    bus_.publish(messages::channels::kFrame, frame(1000000));
    publish_regions(1000000);
    bus_.drain();
    ASSERT_EQ(keyframes->size(), 1u);
    EXPECT_EQ(keyframes->front().id, 0);
}

TEST_F(OdometryShellTest, SaysThatTheSensorStartedAgainAndWhatItsPosesAreThen) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto keyframes = collect<keyframe_t>(messages::channels::kKeyframe);
    publish_camera();
    for (const int start : {500000000, 1000000}) {
        for (int i = 0; i < 10; ++i) {
            bus_.publish(messages::channels::kFrame, frame(start + 33333 * i));
            publish_regions(start + 33333 * i);
            bus_.drain();
        }
        const std::vector<std::string> remarks = shell.status().remarks();
        if (start == 500000000) {
            EXPECT_TRUE(remarks.empty());
            continue;
        }
        EXPECT_THAT(remarks, UnorderedElementsAre(HasSubstr("POSE_BODY is silent"),
                                                  HasSubstr("a component of its own begins"),
                                                  HasSubstr("the sensor started again, or")));
    }
    EXPECT_EQ(keyframes->back().previous_id, -1);
}

TEST_F(OdometryShellTest, AFrameWaitsForItsRegionsButNotForEver) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto estimates = collect<odometry_t>(messages::channels::kOdometry);
    publish_camera();
    for (int i = 0; i < 11; ++i) bus_.publish(messages::channels::kFrame, frame(1000000 + 33333 * i));
    bus_.drain();
    EXPECT_EQ(estimates->size(), 3u) << "eight wait, the first frame too";
    shell.finish();
    bus_.drain();
    EXPECT_EQ(estimates->size(), 11u);
    for (std::size_t i = 1; i < 11; ++i) EXPECT_GT((*estimates)[i].utime, (*estimates)[i - 1].utime);
    EXPECT_EQ(shell.status().losses().at("frames handled without their regions"), 11);
}

TEST_F(OdometryShellTest, ALonelyFrameWaitsForATimeOnly) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto estimates = collect<odometry_t>(messages::channels::kOdometry);
    publish_camera();
    bus_.publish(messages::channels::kFrame, frame(1000000));
    bus_.drain();
    const std::int64_t start = messages::now_us();
    while (estimates->empty() && messages::now_us() - start < 5000000) {
        std::this_thread::sleep_for(std::chrono::milliseconds(shell.poll()));
        bus_.drain();
    }
    EXPECT_EQ(estimates->size(), 1u);
    EXPECT_GT(messages::now_us() - start, 400000);
}

TEST_F(OdometryShellTest, RegionsOfALaterFrameEndTheWaitOfThoseBefore) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto estimates = collect<odometry_t>(messages::channels::kOdometry);
    publish_camera();
    for (int i = 0; i < 4; ++i) bus_.publish(messages::channels::kFrame, frame(1000000 + 33333 * i));
    publish_regions(1000000 + 33333 * 2);  // the segmentation has dropped the first two
    bus_.drain();
    EXPECT_EQ(estimates->size(), 3u);
}

TEST_F(OdometryShellTest, TheFirstKeyframeHasItsRegions) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto keyframes = collect<keyframe_t>(messages::channels::kKeyframe);
    publish_camera();
    bus_.publish(messages::channels::kFrame, frame(1000000));
    bus_.drain();
    EXPECT_TRUE(keyframes->empty());
    bus_.publish(messages::channels::kRegions,
                 messages::to_message(messages::FrameRegions{1000000, {wall()}}, 0));
    bus_.drain();
    ASSERT_EQ(keyframes->size(), 1u);
    EXPECT_EQ(keyframes->front().n_regions, 1);
}

TEST_F(OdometryShellTest, AFrameWithBrokenDepthCostsItselfOnly) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto estimates = collect<odometry_t>(messages::channels::kOdometry);
    publish_camera();
    for (int i = 0; i < 6; ++i) {
        bot_core::images_t images = frame(1000000 + 33333 * i);
        if (i % 2 == 1) images.images[1].pixelformat = 0;  // found out only when odometry asks for the depth
        bus_.publish(messages::channels::kFrame, images);
    }
    bus_.drain();
    EXPECT_NO_THROW(shell.finish());
    bus_.drain();
    EXPECT_EQ(estimates->size(), 3u);
    EXPECT_EQ(shell.status().decode_error_count(), 3);
}

TEST_F(OdometryShellTest, RegionsMayComeFirst) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto estimates = collect<odometry_t>(messages::channels::kOdometry);
    publish_camera();
    publish_regions(1000000);
    bus_.drain();
    bus_.publish(messages::channels::kFrame, frame(1000000));
    bus_.drain();
    EXPECT_EQ(estimates->size(), 1u);
}

TEST_F(OdometryShellTest, RegionsThatComeTwiceOrTooLateTakeNoPlaceOfEarlyOnes) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    publish_camera();
    const auto stamp = [](int i) { return 1000000 + 33333 * std::int64_t{i}; };
    for (int i = 0; i < 12; ++i) {
        bus_.publish(messages::channels::kFrame, frame(stamp(i), 0.01 * i));
        publish_regions(stamp(i));
        bus_.drain();
    }
    publish_regions(stamp(12));  // early
    publish_regions(stamp(12));
    for (int i = 0; i < 12; ++i) publish_regions(stamp(i));
    bus_.publish(messages::channels::kFrame, frame(stamp(12), 0.12));
    bus_.drain();
    const auto& losses = shell.status().losses();
    EXPECT_EQ(losses.size(), 1u) << "the last frame has its regions: " << shell.status().line();
    EXPECT_EQ(losses.at("regions that came late or twice"), 13);
}

TEST_F(OdometryShellTest, WhatIsWrongWithALostFramesDepthIsCounted) {
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto publish = [&](const CameraInfo& info, std::uint16_t raw, std::int64_t utime) {
        bus_.publish(messages::channels::kCameraInfo, messages::to_message(info, 0, 0));
        bot_core::images_t images = frame(utime);
        images.images[0] = messages::color_image_message(RgbImage(kWidth, kHeight), utime,
                                                         messages::ColorEncoding::kRaw, 90);
        images.images[1] = messages::depth_image_message(DepthImage(kWidth, kHeight, raw), utime,
                                                         messages::DepthEncoding::kRaw);
        bus_.publish(messages::channels::kFrame, images);
        bus_.drain();
        shell.finish();
    };
    const auto count = [&](const char* reason) {
        const auto& losses = shell.status().losses();
        return losses.count(reason) == 0 ? 0 : losses.at(reason);
    };
    publish(camera(), 0, 1);
    publish(camera(), 20000, 2);  // 20 m
    EXPECT_EQ(count(OdometryShell::kNoReadings), 2);
    EXPECT_EQ(count(OdometryShell::kBesideColor), 0);
    CameraInfo aside = camera();
    aside.registered = false;
    aside.color_from_depth.linear() = so3_exp({0, 1.5, 0});
    // The camera described before lives no more; the first frame at a jump in time is not used.
    publish(aside, 2000, 3000003);
    publish(aside, 2000, 3000004);
    EXPECT_EQ(count(OdometryShell::kNoReadings), 2);
    EXPECT_EQ(count(OdometryShell::kBesideColor), 1);
}

/// As after a SIGKILL: it knows the place again, and gives no id twice.
TEST_F(OdometryShellTest, AProcessThatIsStartedAgainFindsItsPlaceOrBeginsAPartOfItsOwn) {
    const TemporaryFolder folder;
    const std::filesystem::path journal = folder / "odometry.journal";
    int last_id = -1;
    {
        messages::Bus bus("memq://");
        OdometryShell killed(bus, std::make_shared<messages::FrameDecoder>(bus), {}, journal);
        bus.publish(messages::channels::kCameraInfo, messages::to_message(camera(), 0, 0));
        bus.subscribe(messages::channels::kKeyframe, [&](const messages::RawMessage& m) {
            last_id = messages::decode<keyframe_t>(m.bytes).id;
        });
        publish_walk(bus, 1000000, 30, 0, 0.01);
    }
    ASSERT_GE(last_id, 0);
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {}, journal);
    const auto estimates = collect<odometry_t>(messages::channels::kOdometry);
    const auto keyframes = collect<keyframe_t>(messages::channels::kKeyframe);
    publish_camera();
    publish_walk(bus_, 5000000, 5, 0.1, 0);
    bus_.drain();
    shell.finish();
    bus_.drain();
    ASSERT_EQ(estimates->size(), 5u);
    ASSERT_FALSE(keyframes->empty());
    EXPECT_GT(keyframes->front().id, last_id);
    EXPECT_GE(keyframes->front().previous_id, 0) << "it hangs on those before";
    const OdometryEstimate last = messages::from_message(estimates->back());
    EXPECT_EQ(last.status, TrackingStatus::kTracked);
    EXPECT_NEAR(last.odom_from_camera.translation().x(), 0.1, 0.03);
}

TEST_F(OdometryShellTest, StartedAgainElsewhereItIsLostForAWhileAndThenAPartOfItsOwn) {
    const TemporaryFolder folder;
    const std::filesystem::path journal = folder / "odometry.journal";
    {
        messages::Bus bus("memq://");
        OdometryShell killed(bus, std::make_shared<messages::FrameDecoder>(bus), {}, journal);
        bus.publish(messages::channels::kCameraInfo, messages::to_message(camera(), 0, 0));
        publish_walk(bus, 1000000, 1, 0, 0);
    }
    OdometryShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {}, journal);
    const auto estimates = collect<odometry_t>(messages::channels::kOdometry);
    const auto keyframes = collect<keyframe_t>(messages::channels::kKeyframe);
    publish_camera();
    publish_walk(bus_, 5000000, 30, 20, 0);
    bus_.drain();
    shell.finish();
    bus_.drain();
    ASSERT_EQ(estimates->size(), 30u);
    EXPECT_EQ(estimates->front().status, odometry_t::LOST);
    EXPECT_EQ(estimates->back().status, odometry_t::TRACKED);
    ASSERT_FALSE(keyframes->empty());
    EXPECT_GT(keyframes->front().id, 0);
    EXPECT_EQ(keyframes->front().previous_id, -1);
}

}  // namespace
}  // namespace planemap::odometry
