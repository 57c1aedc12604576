// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "odometry/keyframe_making.hpp"
#include "odometry/prepared_frame.hpp"
#include "room.hpp"

namespace planemap::odometry {

/// A rendered frame as the odometry's parts get it, with the images that it refers to.
class SeenFrame {
  public:
    explicit SeenFrame(const Pose& room_from_camera, std::int64_t utime = 0, bool textured = true,
                       const std::vector<Plane>& planes = room_planes())
        : SeenFrame(render_room(room_camera(), room_from_camera, textured, planes), utime) {}
    explicit SeenFrame(RenderedFrame images, std::int64_t utime = 0, std::vector<PlanarRegion> regions = {})
        : images_(std::move(images)) {
        frame = prepare(options, {utime, utime, &images_.gray, &images_.depth, &camera_, regions}, 0);
    }
    SeenFrame(const SeenFrame&) = delete;
    SeenFrame& operator=(const SeenFrame&) = delete;

    /// As a keyframe at rest.
    LocalKeyframe keyframe(int id = 0, const Pose& odom_from_keyframe = Pose::Identity()) const {
        LocalKeyframe local = make_local_keyframe(options, frame, {});
        local.id = id;
        local.odom_from_keyframe = odom_from_keyframe;
        return local;
    }
    void forget_color() {
        frame.gray = nullptr;
        frame.pyramid = {};
    }

    OdometryOptions options;
    PreparedFrame frame;

  private:
    CameraInfo camera_ = room_camera();
    RenderedFrame images_;
};

inline RenderedFrame black_frame() {
    return {GrayImage(320, 240, 0), DepthImage(320, 240, 0)};
}

/// A motion of a few centimetres and degrees; others for other seeds.
inline Pose small_motion(int seed, double scale = 1) {
    Twist twist;
    for (int i = 0; i < 6; ++i) twist[i] = 0.02 * scale * std::sin(1.0 + 2.3 * i + 1.7 * seed);
    return pose_from_twist(twist);
}

inline double pose_error(const Pose& a, const Pose& b) {
    return twist_from_pose(a * b.inverse()).norm();
}

}  // namespace planemap::odometry
