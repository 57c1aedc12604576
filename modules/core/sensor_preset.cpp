// SPDX-License-Identifier: BSD-3-Clause
#include "core/sensor_preset.hpp"

#include <algorithm>

namespace planemap {

namespace {

/// sigma(z) = a + b z + c z^2, as papers give it, in the form of DepthNoise: the square completed.
DepthNoise from_polynomial(double a, double b, double c) {
    const double offset = -b / (2 * c);
    return {a - c * offset * offset, c, offset};
}

/// sigma(z) = base + quadratic z^2 through two points of a data sheet.
DepthNoise through(double near_m, double near_sigma_m, double far_m, double far_sigma_m) {
    const double quadratic = (far_sigma_m - near_sigma_m) / (far_m * far_m - near_m * near_m);
    return {near_sigma_m - quadratic * near_m * near_m, quadratic, 0};
}

std::vector<SensorPreset> make_presets() {
    // The Kinect v1 and the Xtion are both built on PrimeSense's reference design.
    const DepthNoise primesense{0.0012, 0.0019, 0.4};
    // 1.5 - 0.5 z + 0.3 z^2 millimetres, seen from the front.
    const DepthNoise kinect2 = from_polynomial(0.0015, -0.0005, 0.0003);
    return {
        {"kinect1", "Microsoft Kinect v1 (Xbox 360)", 0.5, 5.0, primesense,
         "range: Khoshelham and Elberink, Accuracy and Resolution of Kinect Depth Data, Sensors 12(2), 2012; "
         "noise: Nguyen, Izadi and Lovell, Modeling Kinect Sensor Noise, 3DIMPVT 2012"},
        {"xtion", "ASUS Xtion PRO LIVE", 0.8, 3.5, primesense,
         "range: ASUS, Xtion PRO LIVE specification; noise: Nguyen et al. 2012, measured on the Kinect v1, "
         "which shares its PrimeSense design (Guidi, Gonizzi and Micoli, 3D Capturing Performances of "
         "Low-Cost "
         "Range Sensors, ISPRS Archives XLI-B5, 2016)"},
        {"kinect2", "Microsoft Kinect v2 (Xbox One)", 0.5, 4.5, kinect2,
         "range: Microsoft, Kinect for Windows SDK 2.0; noise: Fankhauser et al., Kinect v2 for Mobile Robot "
         "Navigation: Evaluation and Modeling, ICAR 2015, at a frontal view"},
        {"azure_kinect", "Microsoft Azure Kinect DK, NFOV unbinned", 0.5, 3.86, kinect2,
         "range: Microsoft, Azure Kinect DK hardware specifications; noise: an upper bound, the Kinect v2's: "
         "no worse at any distance (Kurillo et al., Evaluating the Accuracy of the Azure Kinect and Kinect "
         "v2, Sensors 22(7), 2022)"},
        {"d435", "Intel RealSense D435, D435i", 0.3, 3.0, from_polynomial(0.001063, 0.0007278, 0.003949),
         "range: Intel, D435 product page, the ideal range; noise: Ahn et al., Analysis and Noise Modeling "
         "of "
         "the Intel RealSense D435 for Mobile Robots, UR 2019 (Intel's own rule, z^2 subpixel / (focal "
         "baseline) with 0.08 px, 424 px, 50 mm, is 0.0038 z^2)"},
        {"l515", "Intel RealSense LiDAR Camera L515", 0.25, 9.0, through(1, 0.0025, 9, 0.0155),
         "Intel, RealSense LiDAR Camera L515 data sheet, revision 003, 2021: range, and standard deviation "
         "at 1 m and 9 m"},
        {"lidar_phone", "Apple iPhone and iPad with LiDAR", 0.3, 5.0, through(0, 0.003, 3, 0.010),
         "range: Luetzenburg, Kroon and Bjork, Evaluation of the Apple iPhone 12 Pro LiDAR, Scientific "
         "Reports "
         "11, 2021 (5 m); noise: no model of single readings is published that we know of; 1 cm of error "
         "(there, and Teo and Yang, Developments in the Built Environment 14, 2023) is taken to be at 3 m"},
    };
}

}  // namespace

const std::vector<SensorPreset>& sensor_presets() {
    static const std::vector<SensorPreset> kPresets = make_presets();
    return kPresets;
}

const SensorPreset* find_sensor_preset(std::string_view name) {
    const auto& presets = sensor_presets();
    const auto found =
        std::find_if(presets.begin(), presets.end(), [&](const auto& preset) { return preset.name == name; });
    return found == presets.end() ? nullptr : &*found;
}

std::vector<std::string> sensor_preset_names() {
    std::vector<std::string> names;
    for (const SensorPreset& preset : sensor_presets()) names.push_back(preset.name);
    return names;
}

}  // namespace planemap
