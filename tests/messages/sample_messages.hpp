// SPDX-License-Identifier: BSD-3-Clause
// Values and messages that the tests of this folder share.
#pragma once

#include <cstdint>
#include <vector>

#include "messages/convert.hpp"

namespace planemap::test {

inline PlanarRegion sample_region(double offset = 0) {
    PlanarRegion region;
    for (int i = 0; i < 20; ++i) {
        for (int j = 0; j < 10; ++j) region.moments.add({0.1 * i - 1, 0.1 * j - 0.5, 2.0 + offset});
    }
    const PlaneFit fit = fit_plane(region.moments);
    region.plane = fit.plane;
    region.rms = fit.rms;
    region.box.frame_from_box.linear() = principal_axes(fit.plane, region.moments);
    region.box.frame_from_box.translation() = region.moments.mean();
    region.box.half_extents = {0.95, 0.45, 0};
    region.outline.rings = {{{-0.9, -0.4}, {0.9, -0.4}, {0.9, 0.4}, {-0.9, 0.4}},
                            {{-0.1, -0.1}, {-0.1, 0.1}, {0.1, 0.1}}};
    return region;
}

inline CameraInfo sample_camera(int width = 64, int height = 48) {
    CameraInfo camera;
    camera.serial = "test";
    camera.depth = camera.color = {width, height, 50, 50, width / 2.0, height / 2.0};
    return camera;
}

inline Keyframe sample_keyframe() {
    Keyframe keyframe;
    keyframe.utime = 1234567;
    keyframe.pose_utime = 1234560;
    keyframe.id = 3;
    keyframe.previous_id = 2;
    keyframe.odom_from_camera = make_pose({1, 2, 3}, Eigen::Quaterniond(0.9, 0.1, 0.2, 0.3));
    keyframe.previous_from_camera = make_pose({0.1, 0, 0}, Eigen::Quaterniond(1, 0.01, 0, 0));
    keyframe.covariance = Matrix6d::Identity() * 1e-4;
    keyframe.noise = {0.002, 0.003, 0.5};
    keyframe.depth_min_m = 0.5;
    keyframe.depth_max_m = 4;
    for (int i = 0; i < 5; ++i) {
        Feature feature;
        feature.pixel = {10.0f * static_cast<float>(i), 20};
        feature.point = {0.1f, 0.2f, 1.0f + static_cast<float>(i)};
        feature.region = i % 3 - 1;
        feature.descriptor.fill(static_cast<std::uint8_t>(i));
        keyframe.features.push_back(feature);
    }
    keyframe.regions = {sample_region(), sample_region(1)};
    return keyframe;
}

inline PlaneMap sample_map() {
    PlaneMap map;
    for (int id : {1, 4, 9}) {
        const Pose pose = make_pose({0, 0, 0}, Eigen::Quaterniond(1, 0.1 * id, 0.03 * id * id, 0));
        map.planes.emplace_back(id, pose * sample_region(), 1);
    }
    map.lines.push_back({1, 4, {0, 0, 0}, {1, 0, 0}});
    map.points.push_back({{1, 4, 9}, {0, 0, 1}});
    map.inferred.push_back({4, MapOutline(Outline{{{{0, 0}, {1, 0}, {1, 0.5}}}})});
    return map;
}

/// A map as it was sent before it was packed: two planes of a square metre that meet, one of them with an
/// inferred part.
inline earlier_plane_map_t sample_earlier_map() {
    earlier_plane_map_t map{};
    map.utime = 5;
    map.revision = 6;
    map.up[2] = 1;
    for (int i = 0; i < 2; ++i) {
        earlier_map_plane_t plane{};
        plane.id = 3 * i + 1;
        plane.label = plane_map_t::LABEL_WALL;
        plane.normal[i] = 1;
        plane.d = -2;
        plane.center[i] = 2;
        plane.half_extents[0] = plane.half_extents[1] = 0.5f;
        plane.rms = 0.01f;
        plane.inliers = 1000;
        plane.area = 1;
        plane.n_keyframes = 3;
        plane.unit = 0.001f;
        plane.ring_sizes = {4};
        plane.n_rings = 1;
        plane.vertices = {{-500, -500}, {500, -500}, {500, 500}, {-500, 500}};
        plane.n_vertices = 4;
        map.planes.push_back(plane);
    }
    map.n_planes = 2;
    earlier_map_line_t line{};
    line.plane_b = 1;
    line.start = -0.5f;
    line.stop = 0.25f;
    map.lines = {line};
    map.n_lines = 1;
    earlier_inferred_rings_t inferred{};
    inferred.plane = 1;
    inferred.unit = 0.001f;
    inferred.ring_sizes = {3};
    inferred.n_rings = 1;
    inferred.vertices = {{500, -500}, {700, -500}, {700, 500}};
    inferred.n_vertices = 3;
    map.inferred = {inferred};
    map.n_inferred = 1;
    return map;
}

inline KeyframeTrajectory sample_trajectory() {
    KeyframeTrajectory trajectory;
    for (int id = 0; id < 4; ++id) trajectory.keyframes.push_back({id, 100 * id, Pose::Identity()});
    return trajectory;
}

inline Look sample_look() {
    Look look;
    look.utime = 2234567;
    look.keyframe_id = 3;
    look.keyframe_utime = 1234567;
    look.number = 2;
    look.keyframe_from_camera = make_pose({0.1, 0, 0}, Eigen::Quaterniond(1, 0.01, 0, 0));
    look.regions = {sample_region(), sample_region(1)};
    return look;
}

/// Of a keyframe without regions, too.
inline Surfaces sample_surfaces() {
    return {400, {{0, {3, -1, 5}}, {2, {}}, {7, {5}}}};
}

/// Two blocks, one of them full.
inline SeenSpace sample_seen_space() {
    SeenSpace::Block a{{-1, 300, 7}, {}}, b{{2, 0, -9}, {}};
    for (std::size_t i = 0; i < a.free.size(); ++i) a.free[i] = 0x8001 * i;
    b.free.fill(~std::uint64_t{0});
    return SeenSpace({a, b});
}

template <typename T>
std::vector<std::uint8_t> encoded(const T& message) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, message.getEncodedSize());
    return bytes;
}

}  // namespace planemap::test
