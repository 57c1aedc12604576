// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/image_filter.hpp"

#include <gtest/gtest.h>

#include "room.hpp"

namespace planemap::odometry {
namespace {

class ImageFilterTest : public ::testing::Test {
  protected:
    RenderedFrame images_ = render_room(room_camera(), Pose::Identity());
    CameraInfo camera_ = room_camera();
    std::vector<PlanarRegion> regions_ = std::vector<PlanarRegion>(2);
    OdometryFrame frame_{1, 1, &images_.gray, &images_.depth, &camera_, regions_};
    ImageFilter filter_;

    OdometryFrame only_new(News::Image color, News::Image depth) {
        News news;
        news.color = color;
        news.depth = depth;
        return filter_.only_new(frame_, news);
    }
};

TEST_F(ImageFilterTest, WhatIsNewStays) {
    const OdometryFrame told = only_new(News::Image::kNew, News::Image::kNew);
    EXPECT_EQ(told.gray, frame_.gray);
    EXPECT_EQ(told.depth, frame_.depth);
    EXPECT_EQ(told.regions.size(), 2u);
}

TEST_F(ImageFilterTest, RepeatedAndLateImagesAreLeftOut) {
    for (const News::Image old : {News::Image::kRepeated, News::Image::kLate}) {
        EXPECT_EQ(only_new(old, News::Image::kNew).gray, nullptr);
        const OdometryFrame told = only_new(News::Image::kNew, old);
        EXPECT_EQ(told.gray, frame_.gray);
        EXPECT_EQ(told.depth->width, frame_.depth->width);
        EXPECT_EQ(told.depth->height, frame_.depth->height);
        EXPECT_TRUE(std::all_of(told.depth->pixels.begin(), told.depth->pixels.end(),
                                [](std::uint16_t pixel) { return pixel == 0; }));
        EXPECT_TRUE(told.regions.empty());
    }
}

TEST_F(ImageFilterTest, ColorIsWaitedForUntilNoneCanBeExpected) {
    EXPECT_FALSE(filter_.waits_for_color());
    int waited = 0;
    for (int i = 0; i < 40; ++i) {
        only_new(News::Image::kRepeated, News::Image::kNew);
        waited += filter_.waits_for_color() ? 1 : 0;
    }
    EXPECT_EQ(waited, 15);
    only_new(News::Image::kNew, News::Image::kNew);
    only_new(News::Image::kRepeated, News::Image::kNew);
    EXPECT_TRUE(filter_.waits_for_color()) << "anew after a new one";
    frame_.gray = nullptr;
    only_new(News::Image::kNone, News::Image::kNew);
    EXPECT_FALSE(filter_.waits_for_color()) << "of a camera without colour";
}

}  // namespace
}  // namespace planemap::odometry
