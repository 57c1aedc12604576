// SPDX-License-Identifier: BSD-3-Clause
// Folders as the tools of RealSense and Azure Kinect cameras leave them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "convert/layout_source.hpp"
#include "convert/shrunk_color.hpp"
#include "core/files.hpp"
#include "messages/image_codec.hpp"
#include "sensor/png.hpp"
#include "temporary_folder.hpp"

namespace planemap::convert {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr const char* kDepthIntrinsic =
    R"({"width": 32, "height": 24, "fx": 30, "fy": 30, "ppx": 16, "ppy": 12})";

struct LayoutTest : testing::Test {
    void image(const std::string& file, bool depth, int width = 32, int height = 24) {
        std::filesystem::create_directories((folder / file).parent_path());
        if (depth) {
            sensor::write_depth_png(folder / file, DepthImage(width, height, 1500));
        } else if (file.ends_with(".png")) {
            sensor::write_color_png(folder / file, RgbImage(width, height, {10, 20, 30}));
        } else {
            const auto jpeg = messages::encode_jpeg(RgbImage(width, height, {90, 90, 90}), 95);
            write_file(folder / file, {reinterpret_cast<const char*>(jpeg.data()), jpeg.size()});
        }
    }
    test::TemporaryFolder folder;
};

TEST_F(LayoutTest, AlignedAndNumberedAsOpen3DsRecordersLeaveIt) {
    for (int i = 0; i < 3; ++i) {
        image("depth/0000" + std::to_string(i) + ".png", true);
        image("color/0000" + std::to_string(i) + ".jpg", false);
    }
    write_file(folder / "intrinsic.json",
               R"({"width": 32, "height": 24, "intrinsic_matrix": [30, 0, 0, 0, 31, 0, 16, 12, 1]})");
    ASSERT_TRUE(is_camera_layout(folder.path()));
    const auto source = open_layout(folder.path(), {});
    EXPECT_TRUE(source->camera().registered);
    EXPECT_EQ(source->camera().depth, (PinholeCamera{32, 24, 30, 31, 16, 12}));
    EXPECT_THAT(source->notes(), Contains(HasSubstr("assumed: depth is aligned to colour")));
    EXPECT_THAT(source->notes(), Contains(HasSubstr("assumed: numbered images are taken at 30 Hz")));
    SensorFrame frame;
    ASSERT_EQ(source->next(frame).status, ReadResult::Status::kFrame);
    ASSERT_EQ(source->next(frame).status, ReadResult::Status::kFrame);
    EXPECT_EQ(frame.utime, 33333);
    EXPECT_EQ(frame.color_utime, 33333);
    EXPECT_FALSE(frame.color_jpeg.empty());
    EXPECT_EQ(source->size(), 3u);
}

TEST_F(LayoutTest, DepthAsSensedWithColourOfAnySize) {
    image("depth/1600000000.100000.png", true);
    image("rgb/1600000000.105000.jpg", false, 320, 240);
    write_file(folder / "depth_intrinsic.json", kDepthIntrinsic);
    write_file(folder / "color_intrinsic.json",
               R"({"width": 320, "height": 240, "fx": 310, "fy": 310, "cx": 159.5, "cy": 119.5})");
    write_file(folder / "extrinsic.json",
               R"({"rotation": [0, 1, 0, -1, 0, 0, 0, 0, 1], "translation": [-32, 2, 4]})");
    const auto source = with_color_small_enough(open_layout(folder.path(), {}));
    const CameraInfo& camera = source->camera();
    EXPECT_FALSE(camera.registered);
    EXPECT_NEAR(camera.color_from_depth.translation().x(), -0.032, 1e-12) << "millimetres";
    EXPECT_NEAR(camera.color_from_depth.linear()(1, 0), 1, 1e-12) << "column by column";
    EXPECT_EQ(camera.color.width, 80) << "30 / 310 is below 0.3: four times smaller";
    EXPECT_NEAR(camera.color.cx, 39.5, 1e-12);
    SensorFrame frame;
    ASSERT_EQ(source->next(frame).status, ReadResult::Status::kFrame);
    EXPECT_EQ(frame.color.width, 80);
    EXPECT_NEAR(frame.color(40, 30).g, 90, 2);
    EXPECT_EQ(frame.color_utime, 1600000000105000);
    EXPECT_THAT(source->notes(), Contains(HasSubstr("4 times smaller, to 80x60")));
}

TEST_F(LayoutTest, LensesAreTheirFiles) {
    image("depth/00001.png", true);
    image("color/00001.jpg", false);
    const auto write = [&](const std::string& more) {
        write_file(folder / "intrinsic.json",
                   R"({"width": 32, "height": 24, "fx": 30, "fy": 30, "ppx": 16, "ppy": 12, )" + more + "}");
        return open_layout(folder.path(), {});
    };
    const LensDistortion brown{LensDistortion::Model::kBrown, {0.1, -0.02, 0, 0, 0.001}};
    const auto named = write(R"("model": "Brown Conrady", "coeffs": [0.1, -0.02, 0, 0, 0.001])");
    EXPECT_EQ(named->camera().depth_distortion, brown);
    EXPECT_EQ(named->camera().color_distortion, brown) << "depth is aligned to colour as it is";
    const auto unnamed = write(R"("distortion": [0.1, -0.02, 0, 0, 0.001])");
    EXPECT_EQ(unnamed->camera().color_distortion, brown);
    EXPECT_THAT(unnamed->notes(), Contains(HasSubstr("assumed: its distortion is of the model of Brown")));
    const auto inverse = write(R"("model": "Inverse Brown Conrady", "coeffs": [0.1, -0.02, 0, 0, 0.001])");
    EXPECT_FALSE(inverse->camera().color_distortion);
    EXPECT_THAT(inverse->notes(), Contains(HasSubstr("not used: distortion of model Inverse Brown Conrady")));
    EXPECT_FALSE(
        write(R"("model": "Inverse Brown Conrady", "coeffs": [0, 0, 0, 0, 0])")->camera().color_distortion);
    EXPECT_EQ(write(R"("model": "Kannala Brandt4", "coeffs": [0.1, 0, 0, 0, 0])")->camera().color_distortion,
              (LensDistortion{LensDistortion::Model::kFisheye, {0.1, 0, 0, 0}}));
    EXPECT_THAT(test::error_of([&] { with_color_small_enough(write(R"("coeffs": [-9, 0, 0, 0, 0])")); }),
                HasSubstr("monotonic"));
}

TEST_F(LayoutTest, FilesByTheirStreamsAndStampsInMilliseconds) {
    image("shot_Depth_1600000000100.5.png", true);
    image("shot_Color_1600000000101.5.png", false);
    write_file(folder / "depth_intrinsic.json", kDepthIntrinsic);
    write_file(folder / "color_intrinsic.json", kDepthIntrinsic);
    write_file(folder / "extrinsic.json", R"({"matrix": [[1,0,0,0.015],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})");
    const auto source = open_layout(folder.path(), {});
    SensorFrame frame;
    ASSERT_EQ(source->next(frame).status, ReadResult::Status::kFrame);
    EXPECT_EQ(frame.utime, 1600000000100500);
    EXPECT_EQ(frame.color_utime, 1600000000101500);
    EXPECT_NEAR(source->camera().color_from_depth.translation().x(), 0.015, 1e-12);
}

TEST_F(LayoutTest, WhatIsMissingOrWrongIsOneLine) {
    image("depth/00001.png", true);
    image("color/00001.jpg", false);
    const auto error = [&] { return test::error_of([&] { open_layout(folder.path(), {}); }); };
    EXPECT_THAT(error(), HasSubstr("no file says what its camera is"));
    write_file(folder / "depth_intrinsic.json", R"({"width": 32, "height": 24, "fx": 30})");
    write_file(folder / "color_intrinsic.json", kDepthIntrinsic);
    EXPECT_THAT(error(), HasSubstr("give --camera camera.json")) << "nothing ties them";
    write_file(folder / "extrinsic.json",
               R"({"rotation": [1, 1, 1, 1, 1, 1, 1, 1, 1], "translation": [0, 0, 0]})");
    EXPECT_THAT(error(), HasSubstr("depth_intrinsic.json: no number \"fy\""));
    write_file(folder / "depth_intrinsic.json", kDepthIntrinsic);
    EXPECT_THAT(error(), HasSubstr("extrinsic.json: its rotation is none"));
    write_file(folder / "extrinsic.json", R"({"rotation": ["a"], "translation": [0, 0, 0]})");
    EXPECT_THAT(error(), HasSubstr("extrinsic.json: rotation holds what is no number"));
}

TEST_F(LayoutTest, AFolderInTheTumLayoutIsNone) {
    image("depth/1.png", true);
    EXPECT_TRUE(is_camera_layout(folder.path()));
    write_file(folder / "depth.txt", "1 depth/1.png\n");
    EXPECT_FALSE(is_camera_layout(folder.path()));
    EXPECT_FALSE(is_camera_layout(folder / "none"));
}

}  // namespace
}  // namespace planemap::convert
