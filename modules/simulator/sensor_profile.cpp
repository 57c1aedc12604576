// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/sensor_profile.hpp"

#include <algorithm>

#include "core/geometry/angle.hpp"
#include "simulator/random.hpp"

namespace planemap::simulator {

namespace {

PinholeCamera centred(int width, int height, double focal_px) {
    return {width, height, focal_px, focal_px, 0.5 * (width - 1), 0.5 * (height - 1)};
}

Pose shifted(double x_m, double tilt_deg) {
    Twist twist = Twist::Zero();
    twist[0] = x_m;
    twist[3] = radians(tilt_deg);
    return pose_from_twist(twist);
}

/// PrimeSense's design: the Kinect v1 and the Xtion.
SensorProfile primesense(const std::string& name, double distortion) {
    SensorProfile profile;
    profile.name = name;
    profile.depth = centred(640, 480, 580);
    profile.color = centred(640, 480, 525);
    profile.color_from_depth = shifted(-0.025, 0);
    profile.bias = 0.02;
    profile.focal_error = 0.01;
    profile.mount_error_deg = 0.3;
    profile.distortion = distortion;
    return profile;
}

SensorProfile azure_kinect() {
    SensorProfile profile;
    profile.name = "azure_kinect";
    profile.principle = Principle::kTimeOfFlight;
    profile.depth = centred(640, 576, 504);
    profile.color = centred(1280, 720, 607);
    profile.registered = false;
    profile.color_from_depth = shifted(-0.032, 6);
    profile.bias = 0.004;
    profile.focal_error = 0.002;
    profile.mount_error_deg = 0.1;
    profile.multipath = 1;
    return profile;
}

SensorProfile d435() {
    SensorProfile profile;
    profile.name = "d435";
    profile.principle = Principle::kStereo;
    profile.depth = centred(848, 480, 424);
    profile.color = centred(848, 480, 617);
    profile.registered = false;
    profile.color_from_depth = shifted(0.015, 0);
    profile.baseline_m = 0.05;
    profile.bias = 0.02;
    profile.focal_error = 0.003;
    profile.mount_error_deg = 0.2;
    return profile;
}

SensorProfile lidar_phone() {
    SensorProfile profile;
    profile.name = "lidar_phone";
    profile.principle = Principle::kLidar;
    profile.depth = centred(256, 192, 212);
    profile.color = centred(640, 480, 530);
    profile.registered = false;
    profile.bias = 0.004;
    profile.focal_error = 0.002;
    profile.mount_error_deg = 0.1;
    return profile;
}

}  // namespace

const std::vector<SensorProfile>& sensor_profiles() {
    static const std::vector<SensorProfile> kProfiles{primesense("kinect1", 0.01), primesense("xtion", 0.005),
                                                      azure_kinect(), d435(), lidar_phone()};
    return kProfiles;
}

const SensorProfile* find_sensor_profile(const std::string& name) {
    const auto& profiles = sensor_profiles();
    const auto found =
        std::find_if(profiles.begin(), profiles.end(), [&](const auto& p) { return p.name == name; });
    return found == profiles.end() ? nullptr : &*found;
}

TrueCameras true_cameras(const CameraInfo& nominal, double focal_error, double mount_error_deg,
                         std::uint64_t specimen) {
    constexpr double kMetresADegree = 0.005;
    const auto sign = [&](std::uint64_t k) { return (mix(specimen, 73, k) & 1) != 0 ? 1.0 : -1.0; };
    const auto direction = [&](std::uint64_t k) {
        Eigen::Vector3d v;
        for (std::uint64_t i = 0; i < 3; ++i)
            v[static_cast<Eigen::Index>(i)] = uniform(mix(specimen, 79, k, i), -1, 1);
        return Eigen::Vector3d(v.normalized());
    };
    TrueCameras cameras{nominal.depth, nominal.color, nominal.color_from_depth};
    cameras.color.fx *= 1 + sign(0) * focal_error;
    cameras.color.fy *= 1 + sign(0) * focal_error;
    // Registered depth lies in the colour camera's image.
    const double depth_sign = nominal.registered ? sign(0) : sign(1);
    cameras.depth.fx *= 1 + depth_sign * focal_error;
    cameras.depth.fy *= 1 + depth_sign * focal_error;
    if (mount_error_deg > 0) {
        Twist error;
        error << kMetresADegree * mount_error_deg * direction(0), radians(mount_error_deg) * direction(1);
        cameras.color_from_depth = nominal.color_from_depth * pose_from_twist(error);
    }
    return cameras;
}

}  // namespace planemap::simulator
