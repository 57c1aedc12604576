// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/camera_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sensor/temporary_folder.hpp"

namespace planemap {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// The start of a camera.json.
constexpr const char* kDepth =
    R"({"depth_camera": {"width": 640, "height": 480, "fx": 585, "fy": 580, "cx": 320, "cy": 240})";
constexpr const char* kColor =
    R"("color_camera": {"width": 1280, "height": 960, "fx": 1050, "fy": 1050, "cx": 640, "cy": 480})";

CameraInfo read(const std::string& text) {
    const TemporaryFolder folder;
    return read_camera_file(folder.write("camera.json", text));
}

TEST(CameraFile, TheShortestOneIsRegistered) {
    const CameraInfo camera = read(std::string(kDepth) + R"(, "depth_units_per_metre": 5000})");
    EXPECT_TRUE(camera.registered);
    EXPECT_EQ(camera.depth, (PinholeCamera{640, 480, 585, 580, 320, 240}));
    EXPECT_EQ(camera.color, camera.depth);
    EXPECT_EQ(camera.depth_units_per_metre, 5000);
    EXPECT_EQ(camera.noise, DepthNoise{});
}

TEST(CameraFile, EveryKeyIsRead) {
    const CameraInfo camera = read(std::string(kDepth) + ", " + kColor + R"(, "registered": false,
        "color_from_depth": {"rotation_vector_rad": [0, 0, 0.1], "translation_m": [-0.025, 0.5, 1]},
        "depth_units_per_metre": 1000, "depth_range_m": [0.4, 5], "serial": "K1", "poses_of": "color_camera",
        "noise": {"base_m": 0.002, "quadratic_per_m": 0.003, "offset_m": 0.1}})");
    EXPECT_FALSE(camera.registered);
    EXPECT_EQ(camera.color.width, 1280);
    EXPECT_NEAR(rotation_angle(camera.color_from_depth), 0.1, 1e-12);
    EXPECT_EQ(camera.color_from_depth.translation(), Eigen::Vector3d(-0.025, 0.5, 1));
    EXPECT_EQ(camera.depth_min_m, 0.4);
    EXPECT_EQ(camera.depth_max_m, 5);
    EXPECT_EQ(camera.serial, "K1");
    EXPECT_EQ(camera.noise, (DepthNoise{0.002, 0.003, 0.1}));
}

TEST(CameraFile, AllBadValuesAreInOneError) {
    const std::string error = error_of([] {
        read(R"({"depth_camera": {"width": 640.5, "height": 0, "fx": -3, "fy": "big", "cx": null},
                 "depth_units_per_metre": 0, "registered": "no", "depth_range_m": [3, 1], "serial": 7,
                 "noise": {"base_m": -1}})");
    });
    for (const char* field :
         {"camera.json", "depth_camera.width is 640.5", "depth_camera.height is 0", "depth_camera.fx is -3",
          "depth_camera.fy is \"big\"", "depth_camera.cx is null", "depth_camera.cy is missing",
          "depth_units_per_metre is 0", "registered is \"no\"", "depth_range_m is [3,1]", "serial is 7",
          "noise.base_m is -1"}) {
        EXPECT_THAT(error, HasSubstr(field));
    }
    EXPECT_THAT(error, Not(HasSubstr("\n")));
}

TEST(CameraFile, ResolutionsTooFarApartAreRefusedByNameAndFile) {
    // A phone's LiDAR beside its full-size photographs.
    const std::string error = error_of([] {
        read(R"({"depth_camera": {"width": 256, "height": 192, "fx": 212, "fy": 212, "cx": 128, "cy": 96},
                 "color_camera": {"width": 1920, "height": 1440, "fx": 1590, "fy": 1590, "cx": 960, "cy": 720},
                 "depth_units_per_metre": 1000, "registered": true})");
    });
    for (const char* part :
         {"camera.json", "depth.fx / color.fx is 0.133333 (212 / 1590 pixels)", "0.3 to 4"})
        EXPECT_THAT(error, HasSubstr(part));
}

TEST(CameraFile, UnregisteredNeedsBothCamerasAndTheTransform) {
    const std::string error = error_of(
        [] { read(std::string(kDepth) + R"(, "depth_units_per_metre": 1000, "registered": false})"); });
    EXPECT_THAT(error, AllOf(HasSubstr("color_camera is missing"), HasSubstr("color_from_depth is missing")));
    const std::string lists = error_of([] {
        read(std::string(kDepth) + ", " + kColor + R"(, "depth_units_per_metre": 1000,
             "color_from_depth": {"rotation_vector_rad": [0, 0], "translation_m": [0, "x", 0]}})");
    });
    EXPECT_THAT(lists,
                AllOf(HasSubstr("rotation_vector_rad is [0,0]"), HasSubstr("translation_m is [0,\"x\",0]")));
}

TEST(CameraFile, WhatIsNotJsonIsNamedWithAnExample) {
    for (const char* text : {"", "{", "[1, 2]", "\xff\xfe", "nonsense"}) {
        EXPECT_THAT(error_of([&] { read(text); }), AllOf(HasSubstr("camera.json"), HasSubstr("depth_camera")))
            << text;
    }
}

TEST(CameraFile, TumFoldersAreKnown) {
    const TemporaryFolder folder;
    const auto desk = folder.path() / "rgbd_dataset_freiburg1_desk", other = folder.path() / "other";
    std::filesystem::create_directories(desk);
    std::filesystem::create_directories(other);
    EXPECT_EQ(camera_of_folder(desk).depth.fx, 517.3);
    EXPECT_EQ(camera_of_folder(desk / "").depth.fx, 517.3);
    EXPECT_EQ(camera_of_folder(desk).depth_units_per_metre, 5000);
    EXPECT_EQ(tum_camera("rgbd_dataset_freiburg2_xyz")->depth.cx, 325.1);
    EXPECT_EQ(tum_camera("rgbd_dataset_freiburg3_cabinet")->depth.fy, 539.2);
    EXPECT_FALSE(tum_camera("freiburg4"));
    EXPECT_THAT(error_of([&] { camera_of_folder(other); }),
                AllOf(HasSubstr("other/camera.json"), HasSubstr("\"depth_units_per_metre\": 1000")));
}

TEST(CameraFile, TheExampleOfTheErrorIsComplete) {
    const std::string error = error_of([] { camera_of_folder("/nonexistent"); });
    const auto start = error.find('{');
    ASSERT_NE(start, std::string::npos);
    EXPECT_EQ(error_of([&] { read(error.substr(start)); }), "");
}

}  // namespace
}  // namespace planemap
