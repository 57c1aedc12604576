// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/scripted_source.hpp"

#include <gtest/gtest.h>

#include "messages/image_codec.hpp"

namespace planemap::bench_odometry {
namespace {

constexpr int kWidth = 64, kHeight = 4;

/// Frame i has colour 10 (i + 1) in the left half and 0 in the right one, and depth 1000 + i; each second
/// result is a broken frame.
class Frames : public FrameSource {
  public:
    explicit Frames(int frames, bool as_jpeg = false) : frames_(frames), as_jpeg_(as_jpeg) {
        camera_.color.width = camera_.depth.width = kWidth;
        camera_.color.height = camera_.depth.height = kHeight;
    }
    const CameraInfo& camera() const override { return camera_; }
    std::optional<std::size_t> size() const override { return std::nullopt; }
    ReadResult next(SensorFrame& frame) override {
        frame = {};
        ReadResult result;
        if (next_ == 2 * frames_) return result;
        const int i = next_ / 2;
        if (next_++ % 2 == 0) {
            result.status = ReadResult::Status::kBroken;
            return result;
        }
        frame.utime = 1000000 + 33000 * i;
        frame.color_utime = frame.utime + 5000;
        frame.depth = DepthImage(kWidth, kHeight, static_cast<std::uint16_t>(1000 + i));
        frame.depth_zipped = messages::encode_zipped_depth(frame.depth);
        RgbImage color(kWidth, kHeight);
        const auto value = static_cast<std::uint8_t>(10 * (i + 1));
        for (int v = 0; v < kHeight; ++v)
            for (int u = 0; u < kWidth / 2; ++u) color(u, v) = {value, value, value};
        if (as_jpeg_)
            frame.color_jpeg = messages::encode_jpeg(color, 95);
        else
            frame.color = std::move(color);
        result.status = ReadResult::Status::kFrame;
        return result;
    }

  private:
    CameraInfo camera_;
    int frames_, next_ = 0;
    bool as_jpeg_;
};

std::vector<SensorFrame> shown(const Script& script, int frames, bool as_jpeg = false) {
    ScriptedSource source(std::make_unique<Frames>(frames, as_jpeg), script);
    std::vector<SensorFrame> all;
    for (SensorFrame frame; source.next(frame).status == ReadResult::Status::kFrame;) all.push_back(frame);
    EXPECT_EQ(source.moments().size(), all.size());
    return all;
}

RgbImage color_of(const SensorFrame& frame) {
    return frame.color.empty() ? messages::decode_jpeg_colors(frame.color_jpeg, kWidth, kHeight)
                               : frame.color;
}

TEST(ScriptedSource, ShowsTheSourceAsItIs) {
    const auto all = shown(undisturbed(5), 8);
    ASSERT_EQ(all.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(all[i].utime, 1000000 + 33000 * static_cast<std::int64_t>(i));
        EXPECT_EQ(all[i].color_utime, all[i].utime + 5000);
        EXPECT_EQ(all[i].depth(0, 0), 1000 + i);
        EXPECT_EQ(all[i].color(0, 0).g, 10 * (i + 1));
        EXPECT_FALSE(all[i].depth_zipped.empty());
    }
}

TEST(ScriptedSource, EndsWhereTheSourceDoes) {
    EXPECT_EQ(shown(undisturbed(5), 3).size(), 3u);
    EXPECT_TRUE(shown({}, 3).empty());
}

TEST(ScriptedSource, ShowsImagesAgainUnderNewAndOldStamps) {
    Script script = undisturbed(4);
    script[2].color = script[3].color = 1;
    script[3].keeps_color_stamp = true;
    script[3].depth = 0;
    script.push_back(script[0]);
    script.back().later_us = 500;
    const auto all = shown(script, 4);
    ASSERT_EQ(all.size(), 5u);
    EXPECT_EQ(all[2].color(0, 0).r, 20);
    EXPECT_EQ(all[2].color_utime, 1000000 + 66000 + 5000);
    EXPECT_EQ(all[3].color(0, 0).r, 20);
    EXPECT_EQ(all[3].color_utime, 1000000 + 33000 + 5000);
    EXPECT_EQ(all[3].depth(0, 0), 1000);
    EXPECT_EQ(all[3].utime, 1000000 + 99000);
    EXPECT_EQ(all[4].utime, 1000500);
    EXPECT_EQ(all[4].color_utime, 1005500);
    EXPECT_EQ(all[4].color(0, 0).r, 10);
}

TEST(ScriptedSource, MomentsAreTheSourcesOwn) {
    Script script = undisturbed(2);
    script[1].later_us = -7000;
    ScriptedSource source(std::make_unique<Frames>(2), script);
    SensorFrame frame;
    source.next(frame);
    source.next(frame);
    EXPECT_EQ(frame.utime, 1026000);
    EXPECT_EQ(source.moments(), (std::vector<std::int64_t>{1000000, 1033000}));
}

TEST(ScriptedSource, CoversDimsAndSmears) {
    for (const bool as_jpeg : {false, true}) {
        Script script = undisturbed(3);
        script[0].covered = true;
        script[1].light = 0.5;
        script[2].smear = 8.0 / kWidth;  // 4 pixels to each side
        const auto all = shown(script, 3, as_jpeg);
        ASSERT_EQ(all.size(), 3u);
        for (const std::uint16_t raw : all[0].depth.pixels) EXPECT_EQ(raw, 0);
        EXPECT_EQ(messages::decode_zipped_depth(all[0].depth_zipped, kWidth, kHeight).pixels,
                  all[0].depth.pixels);
        for (const Rgb& pixel : color_of(all[0]).pixels) EXPECT_EQ(pixel, Rgb());
        for (const SensorFrame& frame : all) EXPECT_EQ(frame.color_jpeg.empty(), !as_jpeg);
        EXPECT_NEAR(color_of(all[1])(2, 1).r, 10, 2);
        EXPECT_EQ(all[1].depth(0, 0), 1001);
        EXPECT_NEAR(color_of(all[2])(2, 1).r, 30, 3);
        const int middle = kWidth / 2;
        EXPECT_NEAR(color_of(all[2])(middle, 1).r, 30 * 4 / 9.0, 3);
        EXPECT_NEAR(color_of(all[2])(kWidth - 2, 1).r, 0, 2);
    }
}

}  // namespace
}  // namespace planemap::bench_odometry
