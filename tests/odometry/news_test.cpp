// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/news.hpp"

#include <gtest/gtest.h>

#include <random>

#include "room.hpp"

namespace planemap::odometry {
namespace {

constexpr std::int64_t kPeriod = 33333;  // microseconds

using enum News::Image;

class NewsTest : public ::testing::Test {
  protected:
    /// What a standing camera sees: the same room, another noise.
    RenderedFrame look() {
        RenderedFrame frame = render_room(camera_, Pose::Identity());
        std::normal_distribution<float> noise(0, 1.5F);
        for (std::uint8_t& pixel : frame.gray.pixels)
            pixel = static_cast<std::uint8_t>(std::lround(pixel + noise(random_)));
        for (std::uint16_t& pixel : frame.depth.pixels)
            if (pixel != 0) pixel = static_cast<std::uint16_t>(std::lround(pixel + 5 * noise(random_)));
        return frame;
    }
    News see(const RenderedFrame& frame, std::int64_t utime, std::int64_t color_utime) {
        return watch_.see({utime, color_utime, &frame.gray, &frame.depth, &camera_, {}});
    }

    CameraInfo camera_ = room_camera();
    std::mt19937 random_{7};
    NewsWatch watch_;
};

TEST_F(NewsTest, AStandingCameraHasNews) {
    for (int i = 1; i < 5; ++i) {
        const News news = see(look(), i * kPeriod, i * kPeriod);
        EXPECT_EQ(news.color, kNew) << i;
        EXPECT_EQ(news.depth, kNew) << i;
    }
}

TEST_F(NewsTest, AStreamThatHangsHasNone) {
    const RenderedFrame first = look();
    see(first, kPeriod, kPeriod);
    for (int i = 2; i < 5; ++i) {
        RenderedFrame frame = look();
        frame.gray = first.gray;
        const News news = see(frame, i * kPeriod, i * kPeriod);
        EXPECT_EQ(news.color, kRepeated) << i;
        EXPECT_EQ(news.depth, kNew) << i;
    }
    const News both = see(look(), 5 * kPeriod, 5 * kPeriod);
    EXPECT_EQ(both.color, kNew);

    RenderedFrame frame = look();
    see(frame, 6 * kPeriod, 6 * kPeriod);
    frame.gray = look().gray;
    EXPECT_EQ(see(frame, 7 * kPeriod, 7 * kPeriod).depth, kRepeated);
    const News none = see(frame, 8 * kPeriod, 8 * kPeriod);
    EXPECT_FALSE(none.any());
}

TEST_F(NewsTest, ADriversBuffersInTurnAreNoNews) {
    std::vector<RenderedFrame> buffers;
    for (int i = 0; i < 4; ++i) {
        buffers.push_back(look());
        EXPECT_EQ(see(buffers.back(), (i + 1) * kPeriod, (i + 1) * kPeriod).color, kNew);
    }
    for (int i = 4; i < 20; ++i)
        EXPECT_FALSE(
            see(buffers[static_cast<std::size_t>(i) % 4], (i + 1) * kPeriod, (i + 1) * kPeriod).any())
            << i;
    EXPECT_EQ(see(look(), 21 * kPeriod, 21 * kPeriod).depth, kNew);
}

TEST_F(NewsTest, AFewOtherPixelsAreNoNews) {
    RenderedFrame frame = look();
    see(frame, kPeriod, kPeriod);
    for (std::size_t i = 0; i < 200; ++i) {
        frame.gray.pixels[i * 300] ^= 0x10;
        frame.depth.pixels[i * 300] ^= 0x10;
    }
    EXPECT_FALSE(see(frame, 2 * kPeriod, 2 * kPeriod).any());
}

TEST_F(NewsTest, AnImageWithTheStampOfTheLastOneIsTheLastOne) {
    see(look(), 10 * kPeriod, 10 * kPeriod);
    EXPECT_EQ(see(look(), 11 * kPeriod, 10 * kPeriod).color, kRepeated);
}

TEST_F(NewsTest, AnImageFurtherOffThanTheRateExplainsIsLate) {
    for (int i = 10; i < 15; ++i) EXPECT_EQ(see(look(), i * kPeriod, i * kPeriod + kPeriod / 2).color, kNew);
    EXPECT_EQ(see(look(), 15 * kPeriod, 13 * kPeriod).color, kLate);
    EXPECT_EQ(see(look(), 16 * kPeriod, 20 * kPeriod).color, kLate);
    EXPECT_EQ(see(look(), 17 * kPeriod, 17 * kPeriod).color, kNew);
}

TEST_F(NewsTest, FramesFarApartDoNotExcuseAnImageFarOff) {
    for (int i = 1; i < 5; ++i) see(look(), i * 1000000, i * 1000000);
    EXPECT_EQ(see(look(), 5000000, 4700000).color, kLate);
}

TEST_F(NewsTest, WhatShowsNothingIsNotCalledRepeated) {
    RenderedFrame frame = look();
    frame.gray = GrayImage(camera_.color.width, camera_.color.height, 0);
    frame.depth = DepthImage(camera_.color.width, camera_.color.height, 0);
    for (int i = 1; i < 4; ++i) {
        const News news = see(frame, i * kPeriod, i * kPeriod);
        EXPECT_EQ(news.color, kNew);
        EXPECT_EQ(news.depth, kNew);
    }
}

TEST_F(NewsTest, AnotherRunBeginsAnew) {
    const RenderedFrame frame = look();
    see(frame, 10 * kPeriod, 10 * kPeriod);
    const News news = see(frame, kPeriod, kPeriod);
    EXPECT_EQ(news.color, kNew);
    EXPECT_EQ(news.depth, kNew);
}

TEST_F(NewsTest, ImagesOfAnotherSizeAreNew) {
    EXPECT_FALSE(is_repeated(GrayImage(4, 3, 9), GrayImage(3, 4, 9)));
    EXPECT_FALSE(is_repeated(DepthImage(40, 30, 900), DepthImage(30, 40, 900)));
    EXPECT_TRUE(is_repeated(DepthImage(40, 30, 900), DepthImage(40, 30, 900)));
    EXPECT_FALSE(is_repeated(GrayImage(), GrayImage()));
}

TEST_F(NewsTest, WithoutColourThereIsNone) {
    const RenderedFrame frame = look();
    EXPECT_EQ(watch_.see({kPeriod, 0, nullptr, &frame.depth, &camera_, {}}).color, kNone);
}

}  // namespace
}  // namespace planemap::odometry
