// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/segmentation_shell.hpp"

#include "messages/told_status.hpp"
#include "shell_fixture.hpp"

namespace planemap::segmentation {
namespace {

class SegmentationShellTest : public test::ShellTest {};

TEST_F(SegmentationShellTest, PublishesRegionsInTheCameraFrameAmongCorruptMessages) {
    SegmentationShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto regions = collect<planar_regions_t>(messages::channels::kRegions);
    publish_camera();
    publish_corrupt(messages::channels::kFrame, frame(1));
    bus_.publish(messages::channels::kFrame, frame(100));
    publish_corrupt(messages::channels::kFrame, frame(2));
    bus_.publish(messages::channels::kFrame, frame(200));
    bus_.drain();
    ASSERT_EQ(regions->size(), 2u);
    EXPECT_EQ(regions->back().utime, 200);
    const messages::FrameRegions found = messages::from_message(regions->back());
    ASSERT_EQ(found.regions.size(), 1u);
    EXPECT_NEAR(found.regions[0].plane.d, 2.0, 0.01);
    EXPECT_LT(found.regions[0].plane.normal.z(), -0.999);
    EXPECT_EQ(shell.status().decode_error_count(), 2 * kCorrupt);
}

TEST_F(SegmentationShellTest, MovesRegionsOfAnUnregisteredSensor) {
    SegmentationShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    const auto regions = collect<planar_regions_t>(messages::channels::kRegions);
    CameraInfo unregistered = camera();
    unregistered.registered = false;
    unregistered.color_from_depth.translation() = Eigen::Vector3d(0, 0, 0.5);
    bus_.publish(messages::channels::kCameraInfo, messages::to_message(unregistered, 0, 0));
    bus_.publish(messages::channels::kFrame, frame(100));
    bus_.drain();
    ASSERT_EQ(regions->size(), 1u);
    EXPECT_NEAR(messages::from_message(regions->front()).regions.at(0).plane.d, 2.5, 0.01);
}

TEST_F(SegmentationShellTest, WithoutACameraFramesAreDroppedAndCounted) {
    SegmentationShell shell(bus_, std::make_shared<messages::FrameDecoder>(bus_), {});
    bus_.publish(messages::channels::kFrame, frame(100));
    bus_.drain();
    EXPECT_EQ(test::told(shell.status()).dropped, 1);
}

}  // namespace
}  // namespace planemap::segmentation
