// SPDX-License-Identifier: BSD-3-Clause
#include "core/camera_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/sensor_preset.hpp"
#include "data_folder.hpp"
#include "temporary_folder.hpp"

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
    const test::TemporaryFolder folder;
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
    const std::string error = test::error_of([] {
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
    const std::string error = test::error_of([] {
        read(R"({"depth_camera": {"width": 256, "height": 192, "fx": 212, "fy": 212, "cx": 128, "cy": 96},
                 "color_camera": {"width": 1920, "height": 1440, "fx": 1590, "fy": 1590, "cx": 960, "cy": 720},
                 "depth_units_per_metre": 1000, "registered": true})");
    });
    for (const char* part :
         {"camera.json", "depth.fx / color.fx is 0.133333 (212 / 1590 pixels)", "0.3 to 4"})
        EXPECT_THAT(error, HasSubstr(part));
}

TEST(CameraFile, UnregisteredNeedsBothCamerasAndTheTransform) {
    const std::string error = test::error_of(
        [] { read(std::string(kDepth) + R"(, "depth_units_per_metre": 1000, "registered": false})"); });
    EXPECT_THAT(error, AllOf(HasSubstr("color_camera is missing"), HasSubstr("color_from_depth is missing")));
    const std::string lists = test::error_of([] {
        read(std::string(kDepth) + ", " + kColor + R"(, "depth_units_per_metre": 1000,
             "color_from_depth": {"rotation_vector_rad": [0, 0], "translation_m": [0, "x", 0]}})");
    });
    EXPECT_THAT(lists,
                AllOf(HasSubstr("rotation_vector_rad is [0,0]"), HasSubstr("translation_m is [0,\"x\",0]")));
}

TEST(CameraFile, WhatIsNotJsonIsNamedWithAnExample) {
    for (const char* text : {"", "{", "[1, 2]", "\xfe", "nonsense"}) {
        EXPECT_THAT(test::error_of([&] { read(text); }),
                    AllOf(HasSubstr("camera.json"), HasSubstr("depth_camera")))
            << text;
    }
}

/// A file that is right, with something added before its end.
std::string with(const std::string& more) {
    return std::string(kDepth) + ", \"depth_units_per_metre\": 1000" + (more.empty() ? "" : ", ") + more +
           "}";
}

TEST(CameraFile, UnknownKeysAreErrorsWithTheNearestOne) {
    const std::string error = test::error_of([] {
        read(R"({"depth_camera": {"width": 640, "height": 480, "fx": 585, "fy": 580, "cx": 320, "cz": 240},
                 "colour_camera": {}, "depth_units_per_meter": 1000, "zzz": 1, "noise": {"base": 0.001}})");
    });
    EXPECT_THAT(
        error, AllOf(HasSubstr("colour_camera is not a known key, must be color_camera;"),
                     HasSubstr("depth_units_per_meter is not a known key, must be depth_units_per_metre;"),
                     HasSubstr("depth_camera.cz is not a known key, must be one of width, height, fx"),
                     HasSubstr("noise.base is not a known key, must be base_m"),
                     HasSubstr("zzz is not a known key, must be one of sensor, serial"),
                     HasSubstr("depth_units_per_metre is missing"), HasSubstr("depth_camera.cy is missing")));
    EXPECT_THAT(test::error_of([] {
                    read(with(R"("color_from_depth": {"rotation_vector_rad": [0, 0, 0],
                                            "translation": [0, 0, 0]}, "registered": true)"));
                }),
                AllOf(HasSubstr("color_from_depth.translation is not a known key, must be translation_m"),
                      HasSubstr("color_from_depth.translation_m is missing")));
    std::string many = "\"\\u001b[2J\": 1";
    for (int i = 0; i < 1000; ++i) many += ", \"key" + std::to_string(i) + "\": 1";
    const std::string bounded = test::error_of([&] { read(with(many)); });
    EXPECT_THAT(bounded, AllOf(HasSubstr("993 more unknown keys"), Not(HasSubstr("\x1b"))));
    EXPECT_LT(bounded.size(), 3000u);
}

TEST(CameraFile, AbsurdValuesAreRefusedWithWhatIsAllowed) {
    const std::pair<const char*, const char*> cases[] = {
        {R"("color_from_depth": {"rotation_vector_rad": [0, 0, 0], "translation_m": [1e6, 0, 0]})",
         "color_from_depth.translation_m is [1000000.0,0,0], must be a list of 3, each a number from -2 to "
         "2 m"},
        {R"("color_from_depth": {"rotation_vector_rad": [90, 0, 0], "translation_m": [0, 0, 0]})",
         "color_from_depth.rotation_vector_rad is [90,0,0]"},
        {R"("noise": {"base_m": 1e300})", "noise.base_m is 1e+300, must be a number from 0 to 1 m"},
        {R"("noise": {"quadratic_per_m": 2})",
         "noise.quadratic_per_m is 2, must be a number from 0 to 1 per m"},
        {R"("noise": {"offset_m": -1e9})", "noise.offset_m is -1000000000.0"},
        {R"("depth_range_m": [0.3, 1e9])", "depth_range_m is [0.3,1000000000.0]"},
        {R"("depth_range_m": [0, 0])", "depth_range_m is [0,0]"},
        {R"("depth_range_m": [70, 80])",
         "depth_units_per_metre is 1000, must be such that 16 bits reach beyond"},
        {R"("noise": {"base_m": 0, "quadratic_per_m": 0, "offset_m": 0})",
         "camera.json: camera info: noise at 0.3 m is 0, must be at least 1e-06 m"},
        {R"("noise": {"base_m": 0})", "noise at 0.4 m is 0, must be"},
        {R"("noise": {"quadratic_per_m": 0.9, "offset_m": -9})", "must be at most its far end, 8 m"},
        {R"("poses_of": "depth_camera")", "poses_of is \"depth_camera\", must be color_camera"},
        {R"("noise": {"base_m": "NaN"})", "noise.base_m is \"NaN\""},
    };
    for (const auto& [more, expected] : cases) {
        EXPECT_THAT(test::error_of([&text = more] { read(with(text)); }), HasSubstr(expected)) << more;
    }
    const std::string camera = test::error_of([] {
        read(R"({"depth_camera": {"width": 640, "height": 480, "fx": 1e9, "fy": 1e-3, "cx": 1e5, "cy": -1e5},
                 "depth_units_per_metre": 1e-9})");
    });
    for (const char* expected :
         {"depth_camera.fx is 1000000000.0, must be a number from 128 to 6400 pixels",
          "depth_camera.fy is 0.001", "depth_camera.cx is 100000.0, must be a number from -320 to 960 pixels",
          "depth_camera.cy is -100000.0",
          "depth_units_per_metre is 1e-09, must be a number from 100 to 100000"}) {
        EXPECT_THAT(camera, HasSubstr(expected));
    }
}

TEST(CameraFile, MistypedFocalLengthsAreRefused) {
    const auto with_focal = [](const char* fx, const char* fy) {
        return error_of([&] {
            read(R"({"depth_camera": {"width": 640, "height": 480, "fx": )" + std::string(fx) +
                 R"(, "fy": )" + fy + R"(, "cx": 320, "cy": 240}, "depth_units_per_metre": 1000})");
        });
    };
    EXPECT_THAT(with_focal("52", "5250"),
                HasSubstr("depth_camera.fx is 52, must be a number from 128 to 6400"));
    EXPECT_THAT(
        with_focal("200", "525"),
        AllOf(HasSubstr("camera.json"), HasSubstr("depth.fx / depth.fy is 0.380952 (200 / 525 pixels), must "
                                                  "be 0.5 to 2")));
    EXPECT_THAT(with_focal("0.525", "0.525"), HasSubstr("depth_camera.fy is 0.525"));
}

TEST(CameraFile, SyntaxErrorsHaveLineAndColumn) {
    EXPECT_THAT(test::error_of([] { read("{\n \"depth_camera\": {,}\n}"); }),
                HasSubstr("camera.json: line 2, column 19: syntax error"));
    EXPECT_THAT(test::error_of([] { read(with("\"depth_units_per_metre\": 5000")); }),
                HasSubstr("stands twice"));
}

TEST(CameraFile, APresetGivesRangeAndNoise) {
    for (const SensorPreset& preset : sensor_presets()) {
        const CameraInfo camera = read(with("\"sensor\": \"" + preset.name + "\""));
        EXPECT_EQ(camera.depth_min_m, preset.depth_min_m) << preset.name;
        EXPECT_EQ(camera.depth_max_m, preset.depth_max_m) << preset.name;
        EXPECT_EQ(camera.noise, preset.noise) << preset.name;
    }
    EXPECT_EQ(read(with("")).depth_min_m, 0.3) << "without one, the default";
    EXPECT_EQ(read(with("")).depth_max_m, 8.0);
}

TEST(CameraFile, WhatTheFileSaysOverridesThePreset) {
    const SensorPreset& preset = *find_sensor_preset("d435");
    const CameraInfo camera =
        read(with(R"("sensor": "d435", "depth_range_m": [0.2, 6], "noise": {"base_m": 0.004})"));
    EXPECT_EQ(camera.depth_min_m, 0.2);
    EXPECT_EQ(camera.depth_max_m, 6);
    EXPECT_EQ(camera.noise, (DepthNoise{0.004, preset.noise.quadratic_per_m, preset.noise.offset_m}));
}

TEST(CameraFile, AnUnknownPresetListsAllAndTheNearest) {
    EXPECT_THAT(
        test::error_of([] { read(with(R"("sensor": "kinect_v2")")); }),
        HasSubstr(
            "sensor is \"kinect_v2\", must be one of kinect1, xtion, kinect2, azure_kinect, d435, l515, "
            "lidar_phone; the nearest is kinect2"));
    EXPECT_THAT(test::error_of([] { read(with(R"("sensor": "zed")")); }), Not(HasSubstr("nearest")));
    EXPECT_THAT(test::error_of([] { read(with(R"("sensor": "")")); }), HasSubstr("must be one of kinect1"));
    EXPECT_THAT(test::error_of([] { read(with(R"("sensor": 1)")); }), HasSubstr("sensor is 1"));
}

TEST(CameraFile, SaysHowTheCameraIsMounted) {
    EXPECT_FALSE(read(with("\"note\": \"none\"")).body_from_camera);
    const CameraInfo camera = read(with(
        R"("body_from_camera": {"rotation_vector_rad": [-1.2092, 1.2092, -1.2092], "translation_m": [0.3, 0, 1]})"));
    ASSERT_TRUE(camera.body_from_camera);
    const Eigen::Vector3d ahead = *camera.body_from_camera * Eigen::Vector3d(0, 0, 2);
    EXPECT_NEAR((ahead - Eigen::Vector3d(2.3, 0, 1)).norm(), 0, 1e-4);
    EXPECT_THAT(test::error_of([] { read(with(R"("body_from_camera": {})")); }),
                AllOf(HasSubstr("camera.json: body_from_camera.rotation_vector_rad is missing"),
                      HasSubstr("body_from_camera.translation_m is missing")));
    EXPECT_THAT(test::error_of([] { read(with(R"("body_from_camera": true)")); }),
                HasSubstr("body_from_camera is true, must be an object"));
    EXPECT_THAT(
        test::error_of([] {
            read(with(
                R"("body_from_camera": {"rotation_vector_rad": [0, 0, 0], "translation_m": [0, 0, 300]})"));
        }),
        HasSubstr(
            "body_from_camera.translation_m is [0,0,300], must be a list of 3, each a number from -20"));
}

TEST(CameraFile, WhatIsKnownButNotUsedIsNoted) {
    const test::TemporaryFolder folder;
    std::vector<std::string> notes;
    const auto file = folder.write("camera.json", with(R"("note": "hello", "poses_of": "color_camera")"));
    read_camera_file(file, &notes);
    EXPECT_TRUE(notes.empty());
    folder.write("camera.json", with(R"("registered": true,
        "color_camera": {"width": 640, "height": 480, "fx": 585, "fy": 580, "cx": 320, "cy": 240},
        "color_from_depth": {"rotation_vector_rad": [0, 0, 0], "translation_m": [0, 0, 0]})"));
    read_camera_file(file, &notes);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_THAT(notes[0],
                HasSubstr("camera.json: known, but not used: color_from_depth (registered is true)"));
    EXPECT_NO_THROW(read_camera_file(file));
}

/// The start of a camera.json with `distortion` in its depth camera.
std::string bent(const std::string& distortion, const std::string& more = "") {
    return R"({"depth_camera": {"width": 640, "height": 480, "fx": 517.3, "fy": 516.5, "cx": 318.6, "cy": 255.3,
               "distortion": )" +
           distortion + R"(}, "depth_units_per_metre": 5000)" + more + "}";
}

TEST(CameraFile, LensesAreReadAndWritten) {
    constexpr const char* kFreiburg1 =
        R"({"model": "brown", "coefficients": [0.2624, -0.9531, -0.0054, 0.0026, 1.1633]})";
    const LensDistortion brown{LensDistortion::Model::kBrown, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
    const CameraInfo one = read(bent(kFreiburg1));
    EXPECT_EQ(one.depth_distortion, brown);
    EXPECT_EQ(one.color_distortion, brown) << "the same camera";
    EXPECT_EQ(read(camera_file_text(one)), one);
    const CameraInfo two = read(bent(kFreiburg1, R"(, "registered": true, "color_camera":
        {"width": 640, "height": 480, "fx": 517.3, "fy": 516.5, "cx": 318.6, "cy": 255.3})"));
    EXPECT_EQ(two.depth_distortion, brown);
    EXPECT_FALSE(two.color_distortion) << "each camera its own";
    EXPECT_EQ(read(camera_file_text(two)), two);
    const CameraInfo fisheye = read(bent(R"({"model": "fisheye", "coefficients": [0, 0.1, 0, 0]})"));
    EXPECT_EQ(fisheye.depth_distortion, (LensDistortion{LensDistortion::Model::kFisheye, {0, 0.1, 0, 0}}));
    EXPECT_FALSE(read(with("")).depth_distortion);
}

TEST(CameraFile, BadLensesAreNamedWithFileFieldAndReason) {
    const auto error = [](const std::string& distortion) {
        const std::string text = test::error_of([&] { read(bent(distortion)); });
        EXPECT_THAT(text, AllOf(HasSubstr("camera.json: "), Not(HasSubstr("\n"))));
        return text;
    };
    EXPECT_THAT(error("[0.1, 0.2]"), HasSubstr("depth_camera.distortion is [0.1,0.2], must be an object"));
    EXPECT_THAT(error("{}"), HasSubstr("depth_camera.distortion.model is missing, must be brown or fisheye"));
    EXPECT_THAT(error(R"({"model": "plumb_bob", "coefficients": []})"),
                HasSubstr("depth_camera.distortion.model is \"plumb_bob\", must be brown or fisheye"));
    EXPECT_THAT(error(R"({"model": "brown"})"),
                HasSubstr("distortion.coefficients is missing, must be a list "
                          "of 4 or 5 or 8 for brown, each a number"));
    EXPECT_THAT(error(R"({"model": "brown", "coefficients": [1, 2, 3]})"),
                HasSubstr("depth_camera.distortion.coefficients is [1,2,3], must be a list of 4 or 5 or 8"));
    EXPECT_THAT(error(R"({"model": "fisheye", "coefficients": [0, 0, 0, 0, 0]})"),
                HasSubstr("must be a list of 4 for fisheye"));
    EXPECT_THAT(error(R"({"model": "brown", "coefficients": [0, "x", 0, 0]})"),
                HasSubstr("depth_camera.distortion.coefficients is [0,\"x\",0,0]"));
    EXPECT_THAT(error(R"({"model": "brown", "coefficients": [0, 1e300, 0, 0]})"), HasSubstr("1e+300"));
    EXPECT_THAT(error(R"({"model": "brown", "coeficients": [0, 0, 0, 0]})"),
                HasSubstr("coeficients is not a known key, must be coefficients"));
    EXPECT_THAT(
        error(R"({"model": "brown", "coefficients": [-0.9, 0, 0, 0]})"),
        HasSubstr("depth.distortion is brown [-0.9, 0, 0, 0], must be monotonic over the whole image"));
    EXPECT_THAT(test::error_of([] { read(with(R"("distortion": [0.1])")); }),
                HasSubstr("camera.json: distortion is [0.1], must be within depth_camera or color_camera"));
}

TEST(CameraFile, EveryOneOfTheSharedDataIsRead) {
    PLANEMAP_NEEDS_DATA("");
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(test::data_folder(""))) {
        if (entry.path().filename() != "camera.json") continue;
        std::vector<std::string> notes;
        EXPECT_NO_THROW(read_camera_file(entry.path(), &notes)) << entry.path();
        EXPECT_TRUE(notes.empty()) << entry.path();
        ++files;
    }
    EXPECT_GT(files, 10);
}

TEST(CameraFile, TumFoldersAreKnown) {
    const test::TemporaryFolder folder;
    const auto desk = folder.path() / "rgbd_dataset_freiburg1_desk", other = folder.path() / "other";
    std::filesystem::create_directories(desk);
    std::filesystem::create_directories(other);
    EXPECT_EQ(camera_of_folder(desk).depth.fx, 517.3);
    EXPECT_EQ(camera_of_folder(desk / "").depth.fx, 517.3);
    EXPECT_EQ(camera_of_folder(desk).depth_units_per_metre, 5000);
    EXPECT_EQ(tum_camera("rgbd_dataset_freiburg2_xyz")->depth.cx, 325.1);
    EXPECT_EQ(tum_camera("rgbd_dataset_freiburg3_cabinet")->depth.fy, 539.2);
    EXPECT_FALSE(tum_camera("freiburg4"));
    EXPECT_THAT(test::error_of([&] { camera_of_folder(other); }),
                AllOf(HasSubstr("other/camera.json"), HasSubstr("\"depth_units_per_metre\": 1000")));
}

TEST(CameraFile, TheExampleOfTheErrorIsComplete) {
    const std::string error = test::error_of([] { camera_of_folder("/nonexistent"); });
    const auto start = error.find('{');
    ASSERT_NE(start, std::string::npos);
    EXPECT_EQ(test::error_of([&] { read(error.substr(start)); }), "");
}

TEST(CameraFile, ACorrectionIsReadWrittenAndChecked) {
    const auto with = [](const std::string& correction) {
        return std::string(kDepth) + R"(, "depth_units_per_metre": 1000, "depth_correction": )" + correction +
               "}";
    };
    std::string numbers = "0.011";
    for (int i = 1; i < 20; ++i) numbers += ", " + std::to_string(0.0001 * i);
    const CameraInfo camera = read(with(R"({"offsets_per_m": [)" + numbers + "]}"));
    ASSERT_TRUE(camera.depth_correction);
    EXPECT_EQ(camera.depth_correction->offsets[0], 0.011);
    EXPECT_EQ(camera.depth_correction->offsets[19], 0.0019);
    EXPECT_EQ(read(camera_file_text(camera)), camera);
    for (const char* bad : {"3", "{}", R"({"offsets_per_m": [1, 2]})", R"({"offsets": [0]})"})
        EXPECT_THAT(test::error_of([&] { read(with(bad)); }), HasSubstr("depth_correction")) << bad;
    EXPECT_THAT(test::error_of([&] { read(with(R"({"offsets_per_m": [9, )" + numbers.substr(7) + "]}")); }),
                HasSubstr("offsets_per_m"));
}

TEST(CameraFile, ACorrectionComesIntoAFileAsItIs) {
    const test::TemporaryFolder folder;
    const auto file = folder.write("camera.json", std::string(kDepth) + R"(, "depth_units_per_metre": 1000,
        "note": "of the lab", "sensor": "kinect1"})");
    DepthCorrection correction;
    correction.offsets[3] = 0.002;
    const CameraInfo camera = read(with_depth_correction(file, correction));
    EXPECT_EQ(camera.depth_correction, correction);
    EXPECT_EQ(camera.noise, read_camera_file(file).noise);
    EXPECT_THAT(with_depth_correction(file, correction), HasSubstr("of the lab"));
}

}  // namespace
}  // namespace planemap
