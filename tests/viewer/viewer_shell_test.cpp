// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/viewer_shell.hpp"

#include <vs/object_collection_t.hpp>
#include <vs/point3d_list_collection_t.hpp>

#include "messages/image_codec.hpp"
#include "shell_fixture.hpp"

namespace planemap::viewer {
namespace {

class ViewerShellTest : public test::ShellTest {
  protected:
    /// Messages of a type that only viewers decode.
    template <typename T>
    std::shared_ptr<std::vector<T>> collect_foreign(const char* channel) {
        auto all = std::make_shared<std::vector<T>>();
        bus_.subscribe(channel, [all](const messages::RawMessage& m) {
            EXPECT_LE(m.bytes.size(), ViewerShell::kMostBytes);
            T message;
            ASSERT_GT(message.decode(m.bytes.data(), 0, static_cast<int>(m.bytes.size())), 0);
            all->push_back(message);
        });
        return all;
    }
    std::shared_ptr<messages::FrameDecoder> decoder() {
        return std::make_shared<messages::FrameDecoder>(bus_);
    }
};

TEST_F(ViewerShellTest, ShowsAFrameSmallAndNotEveryOne) {
    ViewerOptions options;
    options.preview_px = 160;
    ViewerShell shell(bus_, decoder(), options);
    const auto color = collect_foreign<bot_core::image_t>(messages::channels::kPreviewColor);
    const auto depth = collect_foreign<bot_core::image_t>(messages::channels::kPreviewDepth);
    const auto regions = collect_foreign<bot_core::image_t>(messages::channels::kPreviewRegions);
    publish_camera();
    for (int i = 0; i < 5; ++i) {
        const std::int64_t utime = 1000000 + 33333 * i;
        publish_corrupt(messages::channels::kFrame, frame(1));
        publish_corrupt(messages::channels::kRegions,
                        messages::to_message(messages::FrameRegions{utime, {}}, 0));
        bus_.publish(messages::channels::kFrame, frame(utime));
        bus_.publish(messages::channels::kRegions,
                     messages::to_message(messages::FrameRegions{utime, {}}, i));
        bus_.drain();
    }
    ASSERT_EQ(color->size(), 1u) << "two a second at most";
    ASSERT_EQ(depth->size(), 1u);
    ASSERT_EQ(regions->size(), 1u);
    EXPECT_EQ(color->front().width, 160);
    EXPECT_EQ(color->front().utime, 1000000);
    EXPECT_EQ(color->front().pixelformat, bot_core::image_t::PIXEL_FORMAT_MJPEG);
    // The same picture, smaller.
    const GrayImage small = messages::decode_jpeg_luma(color->front().data, 160, 120);
    const bot_core::images_t full = frame(1000000);
    double difference = 0;
    for (int v = 0; v < 120; ++v)
        for (int u = 0; u < 160; ++u) {
            const std::size_t pixel = 640 * static_cast<std::size_t>(v) + 2 * static_cast<std::size_t>(u);
            difference += std::abs(small(u, v) - full.images[0].data[3 * pixel]);
        }
    EXPECT_LT(difference / (160 * 120), 10);
    EXPECT_EQ(shell.status().decode_error_count(), 5 * kCorrupt)
        << "regions that no preview waits for are not decoded";
}

TEST_F(ViewerShellTest, DrawsCollectionsWhenTheLocalFrameIsKnown) {
    ViewerOptions options;
    options.previews = false;
    ViewerShell shell(bus_, decoder(), options);
    const auto objects = collect_foreign<vs::object_collection_t>(messages::channels::kObjectCollection);
    const auto points = collect_foreign<vs::point3d_list_collection_t>(messages::channels::kPointsCollection);
    KeyframeTrajectory trajectory;
    trajectory.world_from_odom = Pose(Eigen::Translation3d(0, 0, 0.25));
    trajectory.keyframes = {{0, 5, Pose::Identity()}};
    publish_corrupt(messages::channels::kLocalFromOdom, messages::to_rigid_transform(Pose::Identity(), 5));
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory, 0));
    bus_.publish(messages::channels::kMap, messages::to_message(PlaneMap{}, 0));
    bus_.drain();
    shell.poll();
    bus_.drain();
    EXPECT_TRUE(objects->empty() && points->empty());
    EXPECT_NE(shell.status().line().find("wait for the local frame"), std::string::npos);
    bus_.publish(messages::channels::kLocalFromOdom,
                 messages::to_rigid_transform(Pose(Eigen::Translation3d(1, 0, 0)), 5));
    bus_.drain();
    shell.poll();
    shell.poll();
    bus_.drain();
    ASSERT_EQ(objects->size(), 2u) << "the frame's origin and the keyframes, once";
    ASSERT_EQ(points->size(), 1u);
    EXPECT_NEAR(objects->back().objects[0].x, 1, 1e-9);
    EXPECT_NEAR(objects->back().objects[0].z, -0.25, 1e-9) << "the map is where loop closures moved it";
}

TEST_F(ViewerShellTest, NamesBadOptions) {
    ViewerOptions options;
    options.rate_hz = 0;
    options.preview_px = 5000;
    try {
        ViewerShell shell(bus_, decoder(), options);
        FAIL();
    } catch (const std::invalid_argument& error) {
        EXPECT_NE(std::string(error.what()).find("rate_hz"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("preview_px"), std::string::npos);
    }
}

}  // namespace
}  // namespace planemap::viewer
