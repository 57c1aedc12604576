// SPDX-License-Identifier: BSD-3-Clause
// A room of landmarks, a camera in it, and odometry that drifts.
#pragma once

#include <vector>

#include "core/camera.hpp"
#include "core/keyframe.hpp"
#include "core/random_values.hpp"

namespace planemap::test {

struct Landmark {
    Eigen::Vector3d position;
    Descriptor descriptor;
};

inline Descriptor random_descriptor(Random& random) {
    Descriptor descriptor;
    for (auto& byte : descriptor) byte = static_cast<std::uint8_t>(random.integer(0, 255));
    return descriptor;
}

inline Descriptor with_flips(Descriptor descriptor, int flips, Random& random) {
    for (int i = 0; i < flips; ++i) {
        const int bit = random.integer(0, 255);
        auto& byte = descriptor[static_cast<std::size_t>(bit / 8)];
        byte = static_cast<std::uint8_t>(byte ^ (1 << (bit % 8)));
    }
    return descriptor;
}

/// Landmarks spread over the four walls of a room of the given half size about `centre`, y down from -1.5
/// to 1.5 m.
inline std::vector<Landmark> make_room(Random& random, const Eigen::Vector3d& centre, double half,
                                       int count) {
    std::vector<Landmark> landmarks;
    for (int i = 0; i < count; ++i) {
        const double along = random.uniform(-half, half), out = half + random.uniform(-0.1, 0.0);
        const double height = random.uniform(-1.5, 1.5);
        const Eigen::Vector3d wall[] = {
            {along, height, out}, {out, height, along}, {along, height, -out}, {-out, height, along}};
        landmarks.push_back({centre + wall[i % 4], random_descriptor(random)});
    }
    return landmarks;
}

/// A camera at `position` turned by `yaw` (about y, which points down): it looks along (sin yaw, 0, cos yaw).
inline Pose looking(const Eigen::Vector3d& position, double yaw) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()).toRotationMatrix();
    pose.translation() = position;
    return pose;
}

/// What the camera sees of the landmarks, with a Kinect's noise and some bits of each descriptor changed.
inline std::vector<Feature> see(const std::vector<Landmark>& landmarks, const Pose& world_from_camera,
                                Random& random, std::size_t most = 300) {
    const PinholeCamera camera{640, 480, 525, 525, 319.5, 239.5};
    const DepthNoise noise;
    std::vector<Feature> features;
    for (const Landmark& landmark : landmarks) {
        const Eigen::Vector3d p = world_from_camera.inverse() * landmark.position;
        if (p.z() < 0.5 || p.z() > 5 || !camera.sees(camera.project(p)) || features.size() >= most) continue;
        Feature feature;
        const Eigen::Vector2d pixel =
            camera.project(p) + Eigen::Vector2d(random.normal(0.7), random.normal(0.7));
        feature.pixel = pixel.cast<float>();
        feature.point =
            camera.unproject(pixel.x(), pixel.y(), p.z() + random.normal(noise.sigma(p.z()))).cast<float>();
        feature.descriptor = with_flips(landmark.descriptor, 20, random);
        features.push_back(feature);
    }
    return features;
}

/// A rectangle as a region of the camera frame: centre, half extents and pose given by frame_from_box, seen
/// from the camera's origin.
inline PlanarRegion rectangle(const Pose& frame_from_box, double half_x, double half_y) {
    PlanarRegion region;
    region.box.frame_from_box = frame_from_box;
    region.box.half_extents = {half_x, half_y, 0.005};
    region.plane = frame_from_box * Plane{};
    region.outline.rings = {{{-half_x, -half_y}, {half_x, -half_y}, {half_x, half_y}, {-half_x, half_y}}};
    for (int i = -10; i <= 10; ++i) {
        for (int j = -10; j <= 10; ++j)
            region.moments.add(frame_from_box * Eigen::Vector3d(half_x * i / 10, half_y * j / 10, 0));
    }
    return region;
}

/// A wall seen from the camera, facing it at z metres.
inline PlanarRegion wall(double z, double half = 1.0) {
    Pose box = Pose::Identity();
    box.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).toRotationMatrix();
    box.translation().z() = z;
    return rectangle(box, half, half);
}

/// Keyframes along true poses with edges that drift: each edge errs by a bias and by noise.
struct Walk {
    std::vector<Pose> world_from_camera;  ///< truth; the first is the odom frame
    std::vector<Keyframe> keyframes;
};

struct Odometry {
    Twist bias = (Twist() << 0.004, 0.002, -0.003, 0.0005, 0.003, -0.0005).finished();
    double noise_m = 0.003, noise_rad = 0.001;
};

inline Walk walk(const std::vector<Landmark>& landmarks, const std::vector<Pose>& world_from_camera,
                 Random& random, const Odometry& odometry = {}) {
    Walk walk;
    walk.world_from_camera = world_from_camera;
    for (std::size_t i = 0; i < world_from_camera.size(); ++i) {
        Keyframe keyframe;
        keyframe.id = static_cast<int>(i);
        keyframe.utime = keyframe.pose_utime = 1000000 + static_cast<std::int64_t>(i) * 300000;
        keyframe.odom_from_camera = world_from_camera[0];
        if (i > 0) {
            Twist error = odometry.bias;
            for (int k = 0; k < 6; ++k)
                error[k] += random.normal(k < 3 ? odometry.noise_m : odometry.noise_rad);
            keyframe.previous_id = keyframe.id - 1;
            keyframe.previous_from_camera =
                world_from_camera[i - 1].inverse() * world_from_camera[i] * pose_from_twist(error);
            keyframe.covariance.diagonal() << Eigen::Vector3d::Constant(2.5e-5),
                Eigen::Vector3d::Constant(1e-5);
            keyframe.odom_from_camera =
                orthonormalised(walk.keyframes.back().odom_from_camera * keyframe.previous_from_camera);
        }
        keyframe.features = see(landmarks, world_from_camera[i], random);
        walk.keyframes.push_back(std::move(keyframe));
    }
    return walk;
}

/// `laps` rounds about a square of side `side` in the middle of a room, looking outwards and turning at the
/// corners.
inline std::vector<Pose> square_loop(double side, int steps_a_side, double laps,
                                     const Eigen::Vector3d& centre = Eigen::Vector3d::Zero()) {
    std::vector<Pose> poses;
    const int count = static_cast<int>(4 * steps_a_side * laps);
    for (int i = 0; i <= count; ++i) {
        const int corner = i / steps_a_side % 4;
        const double along = static_cast<double>(i % steps_a_side) / steps_a_side;
        const Eigen::Vector3d corners[] = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
        const Eigen::Vector3d from = corners[corner], to = corners[(corner + 1) % 4];
        const double yaw = (corner + along) * M_PI / 2;
        poses.push_back(looking(centre + side / 2 * (from + along * (to - from)), yaw));
    }
    return poses;
}

}  // namespace planemap::test
