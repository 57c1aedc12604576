// SPDX-License-Identifier: BSD-3-Clause
// Bags as drivers and RealSense's SDK write them, small ones made here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "convert/bag_source.hpp"
#include "convert/bag_writer.hpp"
#include "convert/ros_bytes.hpp"
#include "core/files.hpp"
#include "messages/image_codec.hpp"
#include "sensor/png.hpp"
#include "temporary_folder.hpp"

namespace planemap::convert {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kWidth = 32, kHeight = 24, kColorWidth = 64, kColorHeight = 48;

std::vector<std::uint8_t> depth_bytes() {
    const std::vector<std::uint16_t> pixels(kWidth * kHeight, 1500);
    std::vector<std::uint8_t> bytes(2 * pixels.size());
    std::memcpy(bytes.data(), pixels.data(), bytes.size());
    return bytes;
}

RosBytes depth_image(std::int64_t utime, const std::string& frame, const std::string& encoding = "16UC1") {
    return image(utime, frame, kWidth, kHeight, encoding, 2 * kWidth, depth_bytes());
}

RosBytes color_image(std::int64_t utime, const std::string& frame, std::uint32_t width = kColorWidth) {
    std::vector<std::uint8_t> data;
    for (std::uint32_t i = 0; i < kColorWidth * kColorHeight; ++i) data.insert(data.end(), {30, 20, 10});
    return image(utime, frame, width, kColorHeight, "bgr8", 3 * kColorWidth, data);
}

RosBytes compressed(std::int64_t utime, const std::string& format, const std::vector<std::uint8_t>& data) {
    return RosBytes("sensor_msgs/CompressedImage").header(utime, "optical").text(format).data(data);
}

/// A translation along x.
RosBytes transform(double x) {
    return RosBytes("geometry_msgs/Transform").numbers({x, 0, 0, 0, 0, 0, 1});
}

RosBytes transforms(const std::vector<std::pair<std::string, double>>& children) {
    RosBytes all("tf2_msgs/TFMessage");
    all.number(static_cast<std::uint32_t>(children.size()));
    for (const auto& [child, x] : children) all.header(1, "link").text(child).numbers({x, 0, 0, 0, 0, 0, 1});
    return all;
}

struct BagTest : testing::Test {
    void write(const std::string& topic, std::int64_t utime, const RosBytes& message) {
        bag.write(topic, utime, message.type(), message.bytes());
    }
    void write_infos(const std::string& depth = "/camera/depth/camera_info",
                     const std::string& color = "/camera/color/camera_info") {
        write(depth, kStart, camera_info(kWidth, kHeight, 30));
        write(color, kStart, camera_info(kColorWidth, kColorHeight, 55));
    }
    std::unique_ptr<FrameSource> open(const BagOptions& options = {}) {
        bag.close();
        return open_bag(file, options);
    }
    std::string error(const BagOptions& options = {}) {
        return test::error_of([&] { open(options); });
    }

    static constexpr std::int64_t kStart = 1600000000000000;
    test::TemporaryFolder folder;
    std::filesystem::path file = folder / "a.bag";
    BagWriter bag{file.string()};
};

TEST_F(BagTest, ImagesOfADriverWithTransformsBetweenItsCameras) {
    write_infos();
    write("/tf_static", kStart, transforms({{"depth_optical", 0.01}, {"color_optical", 0.025}}));
    for (int i = 0; i < 3; ++i) {
        write("/camera/depth/image_raw", kStart + 33000 * i + 9,
              depth_image(kStart + 33000 * i, "depth_optical"));
        write("/camera/color/image_raw", kStart + 33000 * i + 8000,
              color_image(kStart + 33000 * i + 5000, "color_optical"));
        write("/camera/infra1/image_raw", kStart + 33000 * i,
              color_image(kStart + 33000 * i, "depth_optical"));
    }
    write("/camera/color/image_raw", kStart + 500000,
          color_image(kStart + 500000, "color_optical"));  // alone
    const auto source = open();
    EXPECT_FALSE(source->camera().registered);
    EXPECT_NEAR(source->camera().color_from_depth.translation().x(), -0.015, 1e-12);
    EXPECT_EQ(source->camera().depth, (PinholeCamera{32, 24, 30, 30, 16, 12}));
    EXPECT_EQ(source->camera().color, (PinholeCamera{64, 48, 55, 55, 32, 24}));
    EXPECT_EQ(source->camera().depth_units_per_metre, 1000);
    EXPECT_EQ(source->size(), 3u);
    SensorFrame frame;
    for (int i = 0; i < 3; ++i) {
        const ReadResult result = source->next(frame);
        ASSERT_EQ(result.status, ReadResult::Status::kFrame) << result.message;
        EXPECT_EQ(frame.utime, kStart + 33000 * i);
        EXPECT_EQ(frame.color_utime, kStart + 33000 * i + 5000);
        EXPECT_EQ(frame.depth(3, 3), 1500);
        EXPECT_EQ(frame.color(3, 3), (Rgb{10, 20, 30}));
    }
    EXPECT_EQ(source->next(frame).status, ReadResult::Status::kEnd);
    ASSERT_EQ(source->complaints().size(), 1u);
    EXPECT_THAT(source->complaints()[0], HasSubstr("1 colour images without depth"));
}

TEST_F(BagTest, DepthInTheColourCamerasFrameIsRegistered) {
    write_infos();
    write("/camera/depth/image", kStart, depth_image(kStart, "optical"));
    write("/camera/color/image_color", kStart, color_image(kStart, "optical"));
    EXPECT_TRUE(open()->camera().registered);
}

TEST_F(BagTest, LensesAreThoseOfTheirCameraInfo) {
    write("/camera/depth/camera_info", kStart,
          camera_info(kWidth, kHeight, 30, "equidistant", {0.01, 0.002, 0, 0}));
    write("/camera/color/camera_info", kStart,
          camera_info(kColorWidth, kColorHeight, 55, "plumb_bob", {-0.2, 0.03, 0.001, 0, 0}));
    write("/camera/depth/image_raw", kStart, depth_image(kStart, "optical"));
    write("/camera/color/image_raw", kStart, color_image(kStart, "optical"));
    const auto source = open();
    EXPECT_EQ(source->camera().depth_distortion,
              (LensDistortion{LensDistortion::Model::kFisheye, {0.01, 0.002, 0, 0}}));
    EXPECT_EQ(source->camera().color_distortion,
              (LensDistortion{LensDistortion::Model::kBrown, {-0.2, 0.03, 0.001, 0, 0}}));
    SensorFrame frame;
    ASSERT_EQ(source->next(frame).status, ReadResult::Status::kFrame);
    EXPECT_EQ(frame.depth(0, 0), 1500) << "images stay as they were";
}

TEST_F(BagTest, ALensOfAModelThatIsNotKnownIsNoted) {
    write("/camera/depth/camera_info", kStart,
          camera_info(kWidth, kHeight, 30, "plumb_bob", {0, 0, 0, 0, 0}));
    write("/camera/color/camera_info", kStart, camera_info(kColorWidth, kColorHeight, 55, "ftheta", {1, 0}));
    write("/camera/depth/image_raw", kStart, depth_image(kStart, "optical"));
    write("/camera/color/image_raw", kStart, color_image(kStart, "optical"));
    const auto source = open();
    EXPECT_FALSE(source->camera().depth_distortion) << "zeros are a pinhole";
    EXPECT_FALSE(source->camera().color_distortion);
    ASSERT_EQ(source->notes().size(), 2u);
    EXPECT_THAT(source->notes()[0], HasSubstr("/camera/color/camera_info: known, but not used: distortion of "
                                              "model ftheta"));
}

TEST_F(BagTest, CompressedImages) {
    write_infos();
    const auto jpeg = messages::encode_jpeg(RgbImage(64, 48, {9, 9, 9}), 90);
    sensor::write_depth_png(folder / "d.png", DepthImage(32, 24, 777));
    const std::string png = std::string(12, '\0') + read_file(folder / "d.png");
    write("/camera/color/image_raw/compressed", kStart,
          compressed(kStart, "bgr8; jpeg compressed bgr8", jpeg));
    write("/camera/depth/image_raw/compressedDepth", kStart,
          compressed(kStart, "16UC1; compressedDepth", {png.begin(), png.end()}));
    const auto source = open();
    SensorFrame frame;
    const ReadResult result = source->next(frame);
    ASSERT_EQ(result.status, ReadResult::Status::kFrame) << result.message;
    EXPECT_EQ(frame.depth(1, 1), 777);
    EXPECT_EQ(frame.color_jpeg, jpeg) << "as it was stored";
}

/// The SDK's images have the unit of depth behind them, and the cameras' poses are messages.
TEST_F(BagTest, RealSensesOwnTopics) {
    const std::string depth = "/device_0/sensor_0/Depth_0", color = "/device_0/sensor_1/Color_0";
    write_infos(depth + "/info/camera_info", color + "/info/camera_info");
    write(depth + "/tf/0", kStart, transform(0));
    write(color + "/tf/0", kStart, transform(0.0148));
    write("/device_0/sensor_0/option/Depth_Units/value", kStart, RosBytes("std_msgs/Float32").number(0.001f));
    write("/device_0/info", kStart, RosBytes("diagnostic_msgs/KeyValue").text("Serial Number").text("0123"));
    write(depth + "/image/data", kStart, depth_image(kStart, "1", "mono16").number(0.00025f));
    write(color + "/image/data", kStart, color_image(kStart, "1"));
    const auto source = open();
    EXPECT_FALSE(source->camera().registered);
    EXPECT_NEAR(source->camera().color_from_depth.translation().x(), 0.0148, 1e-12);
    EXPECT_NEAR(source->camera().depth_units_per_metre, 4000, 1e-6);
    EXPECT_EQ(source->camera().serial, "0123");
    SensorFrame frame;
    const ReadResult result = source->next(frame);
    ASSERT_EQ(result.status, ReadResult::Status::kFrame) << result.message;
    EXPECT_EQ(frame.depth(31, 23), 1500);
    EXPECT_EQ(frame.color_utime, kStart);
}

TEST_F(BagTest, WhatIsMissingIsNamedWithTheWayOut) {
    write("/camera/depth/image_raw", kStart, depth_image(kStart, "depth_optical"));
    write("/camera/color/image_raw", kStart, color_image(kStart, "color_optical"));
    EXPECT_THAT(error(), HasSubstr("no CameraInfo on /camera/depth/camera_info; give --camera camera.json"));
    EXPECT_THAT(error({.depth_topic = "/x", .color_topic = {}, .camera = {}}),
                HasSubstr("no images on /x; in it are /camera/color"));
}

TEST_F(BagTest, CamerasThatNothingTiesAreNamed) {
    write_infos();
    write("/camera/depth/image_raw", kStart, depth_image(kStart, "depth_optical"));
    write("/camera/color/image_raw", kStart, color_image(kStart, "color_optical"));
    EXPECT_THAT(error(),
                HasSubstr("nothing in it says how /camera/depth/image_raw lies to /camera/color/image_raw; "
                          "give --camera camera.json"));
}

TEST_F(BagTest, WithoutDepthThereIsNothing) {
    write("/camera/color/image_raw", kStart, color_image(kStart, "color_optical"));
    EXPECT_THAT(
        error(),
        HasSubstr("no topic with depth images; in it are /camera/color/image_raw sensor_msgs/Image (bgr8)"));
}

TEST_F(BagTest, BrokenImagesAreCountedByTheirReason) {
    write_infos();
    write("/camera/depth/image", kStart, depth_image(kStart - 1000, "optical"));
    write("/camera/depth/image", kStart,
          image(kStart, "optical", kWidth, kHeight, "16UC1", 64, std::vector<std::uint8_t>(100)));
    write("/camera/color/image_color", kStart + 100000, color_image(kStart + 100000, "optical", 7));
    write("/camera/depth/image", kStart + 100000, depth_image(kStart + 100000, "optical"));
    const auto source = open();
    SensorFrame frame;
    EXPECT_EQ(source->next(frame).status, ReadResult::Status::kFrame);
    const ReadResult broken = source->next(frame);
    EXPECT_EQ(broken.status, ReadResult::Status::kBroken);
    EXPECT_THAT(broken.reason, HasSubstr("100 bytes in rows of 64 do not hold 32x24"));
    const ReadResult colorless = source->next(frame);
    EXPECT_TRUE(colorless.color_left_out);
    EXPECT_THAT(colorless.reason, HasSubstr("7x48"));
    EXPECT_EQ(source->next(frame).status, ReadResult::Status::kEnd);
}

int frames_of(FrameSource& source) {
    SensorFrame frame;
    int frames = 0;
    for (ReadResult result = source.next(frame); result.status != ReadResult::Status::kEnd;
         result = source.next(frame))
        frames += result.status == ReadResult::Status::kFrame;
    return frames;
}

struct AnyBag : BagTest {
    /// A bag of 20 frames in several chunks.
    std::string make(const std::string& compression) {
        BagWriter writer(file.string(), compression);
        const auto put = [&](const std::string& topic, std::int64_t utime, const RosBytes& message) {
            writer.write(topic, utime, message.type(), message.bytes());
        };
        put("/camera/depth/camera_info", kStart, camera_info(kWidth, kHeight, 30));
        put("/camera/color/camera_info", kStart, camera_info(kColorWidth, kColorHeight, 55));
        for (int i = 0; i < 20; ++i) {
            put("/camera/depth/image", kStart + 33000 * i, depth_image(kStart + 33000 * i, "optical"));
            put("/camera/color/image_color", kStart + 33000 * i, color_image(kStart + 33000 * i, "optical"));
        }
        writer.close();
        return read_file(file);
    }
};

TEST_F(AnyBag, EveryCompression) {
    for (const char* compression : {"none", "bz2", "lz4"}) {
        make(compression);
        const auto source = open_bag(file, {});
        EXPECT_EQ(source->size(), 20u);
        EXPECT_EQ(frames_of(*source), 20) << compression;
        EXPECT_TRUE(source->complaints().empty()) << compression << ": " << source->complaints()[0];
    }
}

TEST_F(AnyBag, ABagThatWasNotClosedGivesWhatIsWhole) {
    for (const char* compression : {"none", "lz4"}) {
        const std::string whole = make(compression);
        write_file(file, whole.substr(0, whole.size() / 2));
        const auto source = open_bag(file, {});
        const int frames = frames_of(*source);
        EXPECT_GT(frames, 5) << compression;
        EXPECT_LT(frames, 20) << compression;
        EXPECT_THAT(source->complaints(), testing::Contains(HasSubstr("the bag is whole up to byte")));
    }
}

TEST_F(AnyBag, HostileBytesEndInOneLineOrFewerFrames) {
    for (const char* compression : {"none", "bz2", "lz4"}) {
        const std::string whole = make(compression);
        std::uint32_t random = 12345;
        for (int i = 0; i < 150; ++i) {
            std::string bytes = whole;
            for (int flips = 0; flips < 4; ++flips) {
                random = random * 1664525 + 1013904223;
                // Headers and indices are few of a bag's bytes: most flips go to its first and last parts.
                const std::size_t range =
                    i % 2 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 9000);
                const std::size_t at = (random >> 8) % range;
                bytes[i % 4 == 1 ? bytes.size() - 1 - at : at] =
                    static_cast<char>(i % 3 == 0 ? 0xff : random >> 3);
            }
            write_file(file, bytes);
            try {
                EXPECT_LE(frames_of(*open_bag(file, {})), 40);
            } catch (const std::runtime_error& error) {
                EXPECT_THAT(error.what(), HasSubstr("a.bag: "));
            }
        }
    }
}

TEST_F(AnyBag, WhatIsNoBagIsOneLine) {
    const std::string whole = make("none");
    for (const std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{13}, std::size_t{100}}) {
        write_file(file, whole.substr(0, size));
        EXPECT_THAT(test::error_of([&] { open_bag(file, {}); }), HasSubstr("a.bag: ")) << size;
    }
}

}  // namespace
}  // namespace planemap::convert
