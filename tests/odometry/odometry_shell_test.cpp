// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odometry_shell.hpp"

#include "shell_fixture.hpp"

namespace planemap {
namespace {

class OdometryShellTest : public test::ShellTest {
  protected:
    void publish_regions(std::int64_t utime) {
        bus_.publish(channels::kRegions, to_message(FrameRegions{utime, {}}, 0));
    }
};

TEST_F(OdometryShellTest, TracksAmongCorruptMessages) {
    OdometryShell shell(bus_, std::make_shared<FrameDecoder>(bus_), {});
    const auto estimates = collect<odometry_t>(channels::kOdometry);
    const auto keyframes = collect<keyframe_t>(channels::kKeyframe);
    publish_camera();
    for (int i = 0; i < 10; ++i) {
        const std::int64_t utime = 1000000 + 33333 * i;
        publish_corrupt(channels::kFrame, frame(1));
        publish_corrupt(channels::kRegions, to_message(FrameRegions{utime, {}}, 0));
        bus_.publish(channels::kFrame, frame(utime, 0.01 * i));
        publish_regions(utime);
        bus_.drain();
    }
    ASSERT_EQ(estimates->size(), 10u);
    ASSERT_FALSE(keyframes->empty());
    EXPECT_EQ(keyframes->front().id, 0);
    const OdometryEstimate last = from_message(estimates->back());
    EXPECT_EQ(last.status, TrackingStatus::kTracked)
        << last.inliers << " of " << last.features << " features";
    EXPECT_NEAR(last.odom_from_camera.translation().x(), 0.09, 0.02);
    EXPECT_EQ(shell.status().decode_error_count(), 20 * kCorrupt);
}

TEST_F(OdometryShellTest, AFrameWaitsForItsRegionsButNotForEver) {
    OdometryShell shell(bus_, std::make_shared<FrameDecoder>(bus_), {});
    const auto estimates = collect<odometry_t>(channels::kOdometry);
    publish_camera();
    for (int i = 0; i < 6; ++i) bus_.publish(channels::kFrame, frame(1000000 + 33333 * i));
    bus_.drain();
    EXPECT_EQ(estimates->size(), 3u);
    shell.finish();
    bus_.drain();
    EXPECT_EQ(estimates->size(), 6u);
    for (std::size_t i = 1; i < 6; ++i) EXPECT_GT((*estimates)[i].utime, (*estimates)[i - 1].utime);
}

TEST_F(OdometryShellTest, AFrameWithBrokenDepthCostsItselfOnly) {
    OdometryShell shell(bus_, std::make_shared<FrameDecoder>(bus_), {});
    const auto estimates = collect<odometry_t>(channels::kOdometry);
    publish_camera();
    for (int i = 0; i < 6; ++i) {
        bot_core::images_t images = frame(1000000 + 33333 * i);
        if (i % 2 == 1) images.images[1].pixelformat = 0;  // found out only when odometry asks for the depth
        bus_.publish(channels::kFrame, images);
    }
    bus_.drain();
    EXPECT_NO_THROW(shell.finish());
    bus_.drain();
    EXPECT_EQ(estimates->size(), 3u);
    EXPECT_EQ(shell.status().decode_error_count(), 3);
}

TEST_F(OdometryShellTest, RegionsMayComeFirst) {
    OdometryShell shell(bus_, std::make_shared<FrameDecoder>(bus_), {});
    const auto estimates = collect<odometry_t>(channels::kOdometry);
    publish_camera();
    publish_regions(1000000);
    bus_.drain();
    bus_.publish(channels::kFrame, frame(1000000));
    bus_.drain();
    EXPECT_EQ(estimates->size(), 1u);
}

TEST_F(OdometryShellTest, WhatIsWrongWithALostFramesDepthIsCounted) {
    OdometryShell shell(bus_, std::make_shared<FrameDecoder>(bus_), {});
    const auto publish = [&](const CameraInfo& info, std::uint16_t raw, std::int64_t utime) {
        bus_.publish(channels::kCameraInfo, to_message(info, 0, 0));
        bot_core::images_t images = frame(utime);
        images.images[0] = color_image_message(RgbImage(kWidth, kHeight), utime, ColorEncoding::kRaw, 90);
        images.images[1] = depth_image_message(DepthImage(kWidth, kHeight, raw), utime, DepthEncoding::kRaw);
        bus_.publish(channels::kFrame, images);
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
    publish(aside, 2000, 3);
    EXPECT_EQ(count(OdometryShell::kNoReadings), 2);
    EXPECT_EQ(count(OdometryShell::kBesideColor), 1);
}

}  // namespace
}  // namespace planemap
