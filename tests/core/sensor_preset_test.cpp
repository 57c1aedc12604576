// SPDX-License-Identifier: BSD-3-Clause
#include "core/sensor_preset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "core/files.hpp"

namespace planemap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const SensorPreset& preset(const char* name) {
    const SensorPreset* found = find_sensor_preset(name);
    if (found == nullptr) throw std::runtime_error(name);
    return *found;
}

TEST(SensorPreset, TheNamesAreThese) {
    EXPECT_THAT(sensor_preset_names(),
                ElementsAre("kinect1", "xtion", "kinect2", "azure_kinect", "d435", "l515", "lidar_phone"));
    EXPECT_EQ(find_sensor_preset("kinect"), nullptr);
    EXPECT_EQ(find_sensor_preset(""), nullptr);
    EXPECT_EQ(find_sensor_preset("Kinect1"), nullptr);
}

TEST(SensorPreset, EachIsACameraThatCanBeUsed) {
    for (const SensorPreset& preset : sensor_presets()) {
        CameraInfo camera;
        camera.depth = camera.color = {640, 480, 525, 525, 319.5, 239.5};
        camera.depth_min_m = preset.depth_min_m;
        camera.depth_max_m = preset.depth_max_m;
        camera.noise = preset.noise;
        EXPECT_NO_THROW(camera.validate()) << preset.name;
        EXPECT_FALSE(preset.source.empty()) << preset.name;
        EXPECT_FALSE(preset.title.empty()) << preset.name;
        for (double z = preset.depth_min_m; z <= preset.depth_max_m; z += 0.1) {
            EXPECT_GT(preset.noise.sigma(z), 0.0005) << preset.name << " at " << z;
            EXPECT_LT(preset.noise.sigma(z), 0.02 * z + 0.001) << preset.name << " at " << z;
        }
    }
}

TEST(SensorPreset, TheNoiseIsWhatWasPublished) {
    EXPECT_EQ(preset("kinect1").noise, DepthNoise{}) << "the default is Nguyen's model of the Kinect";
    for (double z = 0.5; z < 4.5; z += 0.25) {
        EXPECT_NEAR(preset("kinect2").noise.sigma(z), (1.5 - 0.5 * z + 0.3 * z * z) * 1e-3, 1e-9);
        EXPECT_NEAR(preset("d435").noise.sigma(z), 0.001063 + 0.0007278 * z + 0.003949 * z * z, 1e-9);
    }
    EXPECT_NEAR(preset("l515").noise.sigma(1), 0.0025, 1e-9);
    EXPECT_NEAR(preset("l515").noise.sigma(9), 0.0155, 1e-9);
    EXPECT_LT(preset("azure_kinect").noise.sigma(3.86), 0.017) << "Microsoft's bound";
    EXPECT_NEAR(preset("lidar_phone").noise.sigma(3), 0.010, 1e-9);
}

TEST(SensorPreset, TheDocumentsShowTheSameTable) {
    for (const char* document : {"README.md", "docs/sensors.md"}) {
        const std::string text = read_file(std::string(PLANEMAP_SOURCE) + "/" + document);
        for (const SensorPreset& preset : sensor_presets()) {
            char row[100];
            std::snprintf(row, sizeof(row), "| `%s` | %g to %g m |", preset.name.c_str(), preset.depth_min_m,
                          preset.depth_max_m);
            EXPECT_THAT(text, HasSubstr(row)) << document;
        }
    }
}

}  // namespace
}  // namespace planemap
