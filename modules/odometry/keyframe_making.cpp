// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/keyframe_making.hpp"

#include <optional>

#include "odometry/feature_matching.hpp"
#include "odometry/features.hpp"

namespace planemap::odometry {
namespace {

/// Brings features that the colour image showed to where they were at the depth image's time, onto the
/// regions that they lie on there.
void put_at_depth_time(std::vector<Feature>& features, const PreparedFrame& frame,
                       const FrameMotion& motion) {
    const auto move = [](Feature& feature, const Twist& by) {
        const Eigen::Vector3d point = moved(by, feature.point.cast<double>());
        feature.point = point.cast<float>();
    };
    for (Feature& feature : features) move(feature, -motion.color_offset_s * motion.velocity);
    put_on_regions(features, frame);
    for (Feature& feature : features) {
        const double late = row_share(frame.camera->color, static_cast<double>(feature.pixel.y()));
        move(feature, -late * frame.readout_s * motion.velocity);
    }
}

/// A corner's point; nothing where depth is not sound. The corner is where it was at the colour image's time;
/// its depth is read where it was at the depth image's.
std::optional<TrackPoint> make_point(const OdometryOptions& options, const PreparedFrame& frame,
                                     const cv::Point2f& pixel, const Pose& depth_from_color_time,
                                     const Twist& velocity) {
    const PinholeCamera& camera = frame.camera->color;
    const auto depth_at = [&](const Eigen::Vector2d& at) {
        return sound_depth(*frame.depth, *frame.camera, at, options.max_depth_spread);
    };
    double z = depth_at({pixel.x, pixel.y});
    const Eigen::Vector3d p = depth_from_color_time * camera.unproject(pixel.x, pixel.y, z);
    if (!(p.z() > 0.05)) return std::nullopt;
    const Eigen::Vector2d depth_pixel = camera.project(p);
    z = depth_at(depth_pixel);
    if (z == 0) return std::nullopt;
    TrackPoint point;
    point.pixel = pixel;
    point.point = camera.unproject(depth_pixel.x(), depth_pixel.y(), z);
    const double sigma = frame.camera->noise.sigma(z);
    point.inverse_depth_sigma = options.depth_sigma_scale * sigma / (z * z);
    point.region = region_of(frame.regions, point.point, sigma);
    if (point.region >= 0) {
        point.point = regularised(frame.regions[static_cast<std::size_t>(point.region)].plane, point.point);
        point.inverse_depth_sigma *= 0.5;
    }
    const Twist early = -row_share(camera, depth_pixel.y()) * velocity;
    point.per_readout = early.head<3>() + early.tail<3>().cross(point.point);
    point.point = moved(frame.readout_s * early, point.point);
    return point;
}

}  // namespace

LocalKeyframe make_local_keyframe(const OdometryOptions& options, const PreparedFrame& frame,
                                  const FrameMotion& motion) {
    LocalKeyframe keyframe;
    keyframe.regions = frame.regions;
    keyframe.velocity = motion.velocity;
    keyframe.patches = PlanarPatches(*frame.depth, frame.camera->color, *frame.camera,
                                     options.surface_cell_px, frame.readout_s * motion.velocity);
    keyframe.patches.lay_on(frame.regions, frame.camera->noise);
    if (!frame.gray) return keyframe;
    const Pose depth_from_color_time = pose_from_twist(-motion.color_offset_s * motion.velocity);
    const CornerOptions corners = corner_options(options);
    for (const cv::Point2f& pixel : select_corners(*frame.gray, *frame.depth, *frame.camera, corners))
        if (const auto point = make_point(options, frame, pixel, depth_from_color_time, motion.velocity))
            keyframe.points.push_back(*point);
    keyframe.pyramid = with_derivatives(frame.pyramid, options.flow_window_px);
    return keyframe;
}

namespace {

/// make_keyframe() without features.
Keyframe make_undescribed(const PreparedFrame& frame) {
    Keyframe keyframe;
    keyframe.utime = keyframe.pose_utime = frame.utime;
    keyframe.noise = frame.camera->noise;
    keyframe.depth_min_m = frame.camera->depth_min_m;
    keyframe.depth_max_m = frame.camera->depth_max_m;
    keyframe.regions = frame.regions;
    return keyframe;
}

std::vector<Feature> make_features(const OdometryOptions& options, const PreparedFrame& frame,
                                   const FrameMotion& motion) {
    if (!frame.gray) return {};
    std::vector<Feature> features =
        describe(*frame.gray, *frame.depth, *frame.camera, options.max_descriptors, options.max_depth_spread);
    put_at_depth_time(features, frame, motion);
    return features;
}

}  // namespace

Keyframe make_keyframe(const OdometryOptions& options, const PreparedFrame& frame,
                       const FrameMotion& motion) {
    Keyframe keyframe = make_undescribed(frame);
    keyframe.features = make_features(options, frame, motion);
    return keyframe;
}

UndescribedKeyframe::UndescribedKeyframe(const PreparedFrame& frame, const FrameMotion& motion)
    : keyframe(make_undescribed(frame)), depth_(*frame.depth), camera_(*frame.camera), motion_(motion) {
    if (frame.gray) gray_ = *frame.gray;
    frame_.utime = frame.utime;
    frame_.color_offset_s = frame.color_offset_s;
    frame_.readout_s = frame.readout_s;
    frame_.gray = frame.gray ? &gray_ : nullptr;
    frame_.depth = &depth_;
    frame_.camera = &camera_;
    frame_.regions = frame.regions;
}

Keyframe UndescribedKeyframe::described(const OdometryOptions& options) const {
    Keyframe whole = keyframe;
    whole.features = make_features(options, frame_, motion_);
    return whole;
}

}  // namespace planemap::odometry
