// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/log_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/camera_file.hpp"
#include "data_folder.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/image_codec.hpp"
#include "temporary_folder.hpp"

namespace planemap::sensor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CameraInfo small_camera() {
    CameraInfo camera;
    camera.depth = camera.color = {64, 48, 50, 50, 31.5, 23.5};
    return camera;
}

/// Writes a log message by message.
class Log {
  public:
    explicit Log(const std::filesystem::path& file) : writer_(file) {}
    template <typename T>
    void add(const std::string& channel, const T& message) {
        messages::LogEvent event{
            number_, 1000 * number_, channel,
            std::vector<std::uint8_t>(static_cast<std::size_t>(message.getEncodedSize()))};
        ++number_;
        message.encode(event.bytes.data(), 0, message.getEncodedSize());
        writer_.write(event);
    }
    void close() { writer_.close(); }

  private:
    messages::LogWriter writer_;
    std::int64_t number_ = 0;
};

bot_core::images_t images(std::int64_t utime, int width = 64) {
    bot_core::images_t images;
    images.utime = utime;
    images.image_types = {bot_core::images_t::LEFT, bot_core::images_t::DEPTH_MM_ZIPPED};
    images.images = {
        messages::color_image_message(RgbImage(width, 48, {9, 8, 7}), utime + 1,
                                      messages::ColorEncoding::kRaw, 90),
        messages::depth_image_message(DepthImage(64, 48, 1500), utime, messages::DepthEncoding::kZipped)};
    images.n_images = 2;
    return images;
}

std::vector<std::int64_t> stamps(FrameSource& source) {
    std::vector<std::int64_t> out;
    SensorFrame frame;
    for (ReadResult result = source.next(frame); result.status != ReadResult::Status::kEnd;
         result = source.next(frame))
        out.push_back(result.status == ReadResult::Status::kFrame ? frame.utime : -1);
    return out;
}

TEST(LogSource, GivesFramesAsTheyWereSent) {
    const test::TemporaryFolder folder;
    Log log(folder / "a.lcmlog");
    log.add(messages::channels::kCameraInfo, messages::to_message(small_camera(), 0, 0));
    log.add("ANY_CHANNEL", images(100));
    log.close();
    const auto source = open_source((folder / "a.lcmlog").string());
    EXPECT_EQ(source->camera(), small_camera());
    SensorFrame frame;
    ASSERT_EQ(source->next(frame).status, ReadResult::Status::kFrame);
    EXPECT_EQ(frame.utime, 100);
    EXPECT_EQ(frame.color_utime, 101);
    EXPECT_EQ(frame.depth(5, 5), 1500);
    EXPECT_EQ(frame.color(5, 5), (Rgb{9, 8, 7}));
    EXPECT_EQ(messages::decode_zipped_depth(frame.depth_zipped, 64, 48).pixels, frame.depth.pixels);
    EXPECT_EQ(source->next(frame).status, ReadResult::Status::kEnd);
    EXPECT_EQ(source->progress(), 1);
}

TEST(LogSource, AnotherChannelOnRequest) {
    const test::TemporaryFolder folder;
    Log log(folder / "a.lcmlog");
    for (int i = 0; i < 4; ++i) log.add(i % 2 == 0 ? "LEFT_HAND" : "RIGHT_HAND", images(100 + i));
    log.close();
    const std::string name = (folder / "a.lcmlog").string();
    SourceOptions options;
    options.camera = small_camera();
    EXPECT_THAT(stamps(*open_source(name, options)), ElementsAre(100, 102));
    options.channel = "RIGHT_HAND";
    options.frames = {1, {}};
    EXPECT_THAT(stamps(*open_source(name, options)), ElementsAre(103));
    options.channel = "HEAD";
    EXPECT_THAT(test::error_of([&] { open_source(name, options); }),
                HasSubstr("no channel HEAD in this log; in it are LEFT_HAND bot_core.images_t (2)"));
    EXPECT_THAT(test::error_of([&] { open_source("sim:office", {.channel = "HEAD"}); }),
                HasSubstr("--channel is for LCM logs"));
}

TEST(LogSource, WhatCannotBeUsedIsCountedByItsReason) {
    const test::TemporaryFolder folder;
    CameraInfo other = small_camera();
    other.serial = "another";
    Log log(folder / "a.lcmlog");
    log.add(messages::channels::kCameraInfo, messages::to_message(small_camera(), 0, 0));
    log.add("A", images(100));
    log.add("A", messages::to_message(other, 0, 0));  // no frame
    auto torn = images(101);
    torn.images[1].data.resize(10);
    torn.images[1].size = 10;
    log.add("A", torn);
    log.add("A", images(102, 32));  // colour of another size
    log.add(messages::channels::kCameraInfo, messages::to_message(other, 0, 1));
    log.close();
    LogSource source(folder / "a.lcmlog");
    SensorFrame frame;
    EXPECT_EQ(source.next(frame).message, "");
    EXPECT_THAT(source.next(frame).message,
                HasSubstr("event 2: images_t: the fingerprint is another type's"));
    const ReadResult result = source.next(frame);
    EXPECT_EQ(result.status, ReadResult::Status::kBroken);
    EXPECT_THAT(result.reason, HasSubstr("zipped depth: corrupt or cut short"));
    EXPECT_TRUE(frame.depth.empty());
    const ReadResult colorless = source.next(frame);
    EXPECT_TRUE(colorless.color_left_out);
    EXPECT_THAT(colorless.reason, HasSubstr("colour image is 32x48"));
    EXPECT_TRUE(frame.color.empty());
    EXPECT_EQ(source.next(frame).status, ReadResult::Status::kEnd);
    ASSERT_EQ(source.complaints().size(), 1u);
    EXPECT_THAT(source.complaints()[0], HasSubstr("1 of its camera_info_t"));
}

/// A log, a Kinect's older log, and one of a converter: right values in the data's README.
TEST(LogSource, LogsOfOthers) {
    PLANEMAP_NEEDS_DATA("cases");
    const std::filesystem::path cases = test::data_folder("cases");
    SourceOptions options;
    options.camera = read_camera_file(cases / "camera.json");
    for (const auto& [name, frames] : {std::pair{"webcam_first", 2}, {"kinect_frame", 2}, {"raw357", 1}}) {
        const auto source = open_source((cases / (std::string(name) + ".lcmlog")).string(), options);
        SensorFrame frame;
        for (int i = 0; i < frames; ++i) {
            const ReadResult result = source->next(frame);
            ASSERT_EQ(result.status, ReadResult::Status::kFrame) << name << ": " << result.message;
            EXPECT_FALSE(frame.color.empty() && frame.color_jpeg.empty()) << name;
            auto readings = frame.depth.pixels;
            std::erase_if(readings, [](std::uint16_t z) { return !is_valid_depth(z); });
            const auto middle = readings.begin() + static_cast<std::ptrdiff_t>(readings.size() / 2);
            std::nth_element(readings.begin(), middle, readings.end());
            if (std::string(name) == "raw357") {
                EXPECT_NEAR(*middle, 2920, 10);
            }
            EXPECT_GT(*middle, 500) << name;
            EXPECT_LT(*middle, 6000) << name;
        }
        EXPECT_EQ(source->next(frame).status, ReadResult::Status::kEnd) << name;
    }
}

}  // namespace
}  // namespace planemap::sensor
