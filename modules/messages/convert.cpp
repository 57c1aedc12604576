// SPDX-License-Identifier: BSD-3-Clause
#include "messages/convert.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/geometry/packed_outline.hpp"
#include "core/stamp.hpp"
#include "core/validation.hpp"
#include "messages/checks.hpp"
#include "messages/image_codec.hpp"

namespace planemap::messages {

namespace {

transform_t to_message(const Pose& pose) {
    transform_t message;
    const Eigen::Vector3d t = pose.translation();
    Eigen::Quaterniond q(pose.linear());
    q.normalize();
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    std::copy(t.data(), t.data() + 3, message.translation);
    message.rotation[0] = q.w();
    message.rotation[1] = q.x();
    message.rotation[2] = q.y();
    message.rotation[3] = q.z();
    return message;
}

Pose from_message(const transform_t& message, const char* field) {
    const Eigen::Vector3d t(message.translation);
    const Eigen::Quaterniond q(message.rotation[0], message.rotation[1], message.rotation[2],
                               message.rotation[3]);
    require(t.allFinite(), field, "has a translation that is not finite");
    require(q.coeffs().allFinite() && std::abs(q.norm() - 1.0) < 1e-3, field,
            "has a rotation that is not a unit quaternion");
    return make_pose(t, q);
}

camera_intrinsics_t to_message(const PinholeCamera& camera) {
    camera_intrinsics_t message;
    message.width = camera.width;
    message.height = camera.height;
    message.fx = camera.fx;
    message.fy = camera.fy;
    message.cx = camera.cx;
    message.cy = camera.cy;
    return message;
}

PinholeCamera from_message(const camera_intrinsics_t& m) {
    return {m.width, m.height, m.fx, m.fy, m.cx, m.cy};
}

constexpr std::pair<LensDistortion::Model, std::int8_t> kModels[] = {
    {LensDistortion::Model::kBrown, lens_distortion_t::BROWN},
    {LensDistortion::Model::kFisheye, lens_distortion_t::FISHEYE}};

lens_distortion_t to_message(const std::optional<LensDistortion>& lens) {
    lens_distortion_t message{};
    if (!lens) return message;
    for (const auto& [model, number] : kModels)
        if (model == lens->model) message.model = number;
    message.coefficients = lens->coefficients;
    message.n_coefficients = count32(lens->coefficients.size());
    return message;
}

std::optional<LensDistortion> from_message(const lens_distortion_t& message, const char* field) {
    if (message.model == lens_distortion_t::NONE) return std::nullopt;
    for (const auto& [model, number] : kModels)
        if (number == message.model) return LensDistortion{model, message.coefficients};
    fail(field, "is of model " + std::to_string(message.model) + ", which is not known");
}

planar_region_t to_message(const PlanarRegion& region) {
    planar_region_t message;
    for (int i = 0; i < 3; ++i) {
        message.normal[i] = region.plane.normal[i];
        message.sum[i] = region.moments.sum[i];
        message.half_extents[i] = static_cast<float>(region.box.half_extents[i]);
    }
    message.d = region.plane.d;
    message.count = region.moments.count;
    const Eigen::Matrix3d& s = region.moments.scatter;
    const double scatter[6] = {s(0, 0), s(0, 1), s(0, 2), s(1, 1), s(1, 2), s(2, 2)};
    std::copy(scatter, scatter + 6, message.scatter);
    message.frame_from_box = to_message(region.box.frame_from_box);
    message.rms = static_cast<float>(region.rms);
    message.n_rings = count32(region.outline.rings.size());
    for (const Ring& ring : region.outline.rings) {
        message.ring_sizes.push_back(count32(ring.size()));
        for (const auto& v : ring)
            message.vertices.push_back({static_cast<float>(v.x()), static_cast<float>(v.y())});
    }
    message.n_vertices = count32(message.vertices.size());
    return message;
}

/// Splits vertices into rings; `vertex(i)` gives the i-th.
template <typename Sizes, typename Vertex>
Outline rings_from(const Sizes& sizes, std::size_t vertices, const Vertex& vertex) {
    Outline outline;
    std::size_t at = 0;
    for (const auto size : sizes) {
        require(size >= 3 && static_cast<std::size_t>(size) <= vertices - at, "ring_sizes",
                "does not fit n_vertices");
        require(static_cast<std::size_t>(size) <= kMaxRingVertices, "ring_sizes",
                "has a ring of more than 32767 vertices");
        Ring ring;
        for (int i = 0; i < size; ++i) ring.push_back(vertex(at++));
        outline.rings.push_back(std::move(ring));
    }
    require(at == vertices, "ring_sizes", "does not fit n_vertices");
    return outline;
}

PlanarRegion from_message(const planar_region_t& message) {
    PlanarRegion region;
    region.plane.normal = Eigen::Vector3d(message.normal);
    region.plane.d = message.d;
    region.moments.count = message.count;
    region.moments.sum = Eigen::Vector3d(message.sum);
    const double* s = message.scatter;
    region.moments.scatter << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
    region.box.frame_from_box = from_message(message.frame_from_box, "region.frame_from_box");
    region.box.half_extents = Eigen::Vector3f(message.half_extents).cast<double>();
    region.rms = message.rms;
    region.outline = rings_from(message.ring_sizes, message.vertices.size(), [&](std::size_t i) {
        return Eigen::Vector2d(message.vertices[i][0], message.vertices[i][1]);
    });
    require(is_valid(region), "region",
            "has a plane, moments, box or outline that is not finite or not consistent");
    return region;
}

std::vector<PlanarRegion> from_messages(const std::vector<planar_region_t>& messages) {
    std::vector<PlanarRegion> regions;
    regions.reserve(messages.size());
    for (const auto& message : messages) regions.push_back(from_message(message));
    return regions;
}

std::vector<planar_region_t> to_messages(const std::vector<PlanarRegion>& regions) {
    std::vector<planar_region_t> messages;
    messages.reserve(regions.size());
    for (const auto& region : regions) messages.push_back(to_message(region));
    return messages;
}

void copy_covariance(const Matrix6d& covariance, double* out) {
    for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < 6; ++c) *out++ = covariance(r, c);
    }
}

Matrix6d covariance_from(const double* in, const char* field) {
    Matrix6d covariance;
    for (int r = 0; r < 6; ++r) {
        for (int c = 0; c < 6; ++c) covariance(r, c) = *in++;
    }
    require(covariance.allFinite(), field, "is not finite");
    return covariance;
}

}  // namespace

std::int64_t checked_utime(std::int64_t utime, const char* field) {
    if (utime < -kFarthestUtime || utime > kFarthestUtime)
        fail(field, "is " + std::to_string(utime) + " us, beyond 2^60");
    return utime;
}

camera_info_t to_message(const CameraInfo& camera, std::int64_t utime, std::int32_t seq,
                         std::int64_t session) {
    camera_info_t message;
    message.session = session;
    message.utime = utime;
    message.seq = seq;
    message.serial = camera.serial;
    message.depth = to_message(camera.depth);
    message.color = to_message(camera.color);
    message.registered = camera.registered ? 1 : 0;
    message.color_from_depth = to_message(camera.color_from_depth);
    message.depth_units_per_metre = camera.depth_units_per_metre;
    message.depth_min_m = camera.depth_min_m;
    message.depth_max_m = camera.depth_max_m;
    message.noise_base_m = camera.noise.base_m;
    message.noise_quadratic_per_m = camera.noise.quadratic_per_m;
    message.noise_offset_m = camera.noise.offset_m;
    message.body_known = camera.body_from_camera ? 1 : 0;
    message.body_from_camera = to_message(camera.body_from_camera.value_or(Pose::Identity()));
    message.depth_distortion = to_message(camera.depth_distortion);
    message.color_distortion = to_message(camera.color_distortion);
    return message;
}

acceleration_t to_message(const Acceleration& reading) {
    acceleration_t message;
    message.utime = reading.utime;
    for (int i = 0; i < 3; ++i) message.acceleration[i] = reading.acceleration_camera[i];
    return message;
}

Acceleration from_message(const acceleration_t& message) {
    constexpr double kMost = 1000;  // m/s2: 100 g
    Acceleration reading;
    reading.utime = checked_utime(message.utime, "acceleration.utime");
    for (int i = 0; i < 3; ++i) reading.acceleration_camera[i] = message.acceleration[i];
    require(reading.acceleration_camera.norm() <= kMost, "acceleration.acceleration", "is none");  // nor NaN
    return reading;
}

CameraInfo from_message(const camera_info_t& message) {
    checked_utime(message.utime, "camera_info.utime");
    CameraInfo camera;
    camera.serial = message.serial;
    camera.depth = from_message(message.depth);
    camera.color = from_message(message.color);
    camera.registered = message.registered != 0;
    camera.color_from_depth = from_message(message.color_from_depth, "camera_info.color_from_depth");
    camera.depth_units_per_metre = message.depth_units_per_metre;
    camera.depth_min_m = message.depth_min_m;
    camera.depth_max_m = message.depth_max_m;
    camera.noise = {message.noise_base_m, message.noise_quadratic_per_m, message.noise_offset_m};
    if (message.body_known != 0)
        camera.body_from_camera = from_message(message.body_from_camera, "camera_info.body_from_camera");
    camera.depth_distortion = from_message(message.depth_distortion, "camera_info.depth_distortion");
    camera.color_distortion = from_message(message.color_distortion, "camera_info.color_distortion");
    try {
        camera.validate();
    } catch (const std::invalid_argument& error) {
        throw MessageError(error.what());
    }
    return camera;
}

planar_regions_t to_message(const FrameRegions& regions, std::int32_t seq, std::int64_t session) {
    planar_regions_t message;
    message.session = session;
    message.utime = regions.utime;
    message.seq = seq;
    message.regions = to_messages(regions.regions);
    message.n_regions = count32(message.regions.size());
    return message;
}

FrameRegions from_message(const planar_regions_t& message) {
    return {checked_utime(message.utime, "planar_regions.utime"), from_messages(message.regions)};
}

odometry_t to_message(const OdometryEstimate& estimate, std::int32_t seq, std::int64_t session) {
    odometry_t message;
    message.session = session;
    message.utime = estimate.utime;
    message.pose_utime = estimate.pose_utime;
    message.seq = seq;
    message.status = static_cast<std::int8_t>(estimate.status);
    message.odom_from_camera = to_message(estimate.odom_from_camera);
    message.keyframe_id = estimate.keyframe_id;
    message.keyframe_from_camera = to_message(estimate.keyframe_from_camera);
    copy_covariance(estimate.covariance, message.covariance);
    message.n_features = estimate.features;
    message.n_inliers = estimate.inliers;
    message.residual_px = static_cast<float>(estimate.residual_px);
    return message;
}

OdometryEstimate from_message(const odometry_t& message) {
    OdometryEstimate estimate;
    estimate.utime = checked_utime(message.utime, "odometry.utime");
    estimate.pose_utime = checked_utime(message.pose_utime, "odometry.pose_utime");
    require(message.status >= 0 && message.status <= 3, "odometry.status", "is unknown");
    estimate.status = static_cast<TrackingStatus>(message.status);
    estimate.odom_from_camera = from_message(message.odom_from_camera, "odometry.odom_from_camera");
    estimate.keyframe_id = message.keyframe_id;
    estimate.keyframe_from_camera =
        from_message(message.keyframe_from_camera, "odometry.keyframe_from_camera");
    estimate.covariance = covariance_from(message.covariance, "odometry.covariance");
    estimate.features = message.n_features;
    estimate.inliers = message.n_inliers;
    estimate.residual_px = message.residual_px;
    return estimate;
}

bot_core::pose_t to_message(const BodyMotion& motion, std::int64_t utime) {
    bot_core::pose_t message{};
    message.utime = utime;
    const transform_t pose = to_message(motion.local_from_body);
    std::copy(pose.translation, pose.translation + 3, message.pos);
    std::copy(pose.rotation, pose.rotation + 4, message.orientation);
    std::copy(motion.velocity_local.data(), motion.velocity_local.data() + 3, message.vel);
    std::copy(motion.rotation_rate_body.data(), motion.rotation_rate_body.data() + 3, message.rotation_rate);
    return message;
}

bot_core::rigid_transform_t to_rigid_transform(const Pose& pose, std::int64_t utime) {
    bot_core::rigid_transform_t message{};
    message.utime = utime;
    const transform_t transform = to_message(pose);
    std::copy(transform.translation, transform.translation + 3, message.trans);
    std::copy(transform.rotation, transform.rotation + 4, message.quat);
    return message;
}

Pose from_message(const bot_core::rigid_transform_t& message) {
    transform_t transform;
    std::copy(message.trans, message.trans + 3, transform.translation);
    std::copy(message.quat, message.quat + 4, transform.rotation);
    return from_message(transform, "rigid_transform");
}

keyframe_t to_message(const Keyframe& keyframe, std::int32_t seq, std::int64_t session) {
    keyframe_t message;
    message.session = session;
    message.utime = keyframe.utime;
    message.pose_utime = keyframe.pose_utime;
    message.seq = seq;
    message.id = keyframe.id;
    message.odom_from_camera = to_message(keyframe.odom_from_camera);
    message.chain = keyframe.chain;
    message.previous_id = keyframe.previous_id;
    message.previous_from_camera = to_message(keyframe.previous_from_camera);
    copy_covariance(keyframe.covariance, message.covariance);
    message.n_features = count32(keyframe.features.size());
    for (const Feature& feature : keyframe.features) {
        message.pixels.push_back({feature.pixel.x(), feature.pixel.y()});
        message.points.push_back({feature.point.x(), feature.point.y(), feature.point.z()});
        message.regions_of.push_back(static_cast<std::int16_t>(feature.region));
        message.descriptors.insert(message.descriptors.end(), feature.descriptor.begin(),
                                   feature.descriptor.end());
    }
    message.n_descriptor_bytes = count32(message.descriptors.size());
    message.regions = to_messages(keyframe.regions);
    message.n_regions = count32(message.regions.size());
    message.noise_base_m = keyframe.noise.base_m;
    message.noise_quadratic_per_m = keyframe.noise.quadratic_per_m;
    message.noise_offset_m = keyframe.noise.offset_m;
    message.depth_min_m = keyframe.depth_min_m;
    message.depth_max_m = keyframe.depth_max_m;
    return message;
}

namespace {

void read_depth(const keyframe_t& message, Keyframe& keyframe) {
    keyframe.noise = {message.noise_base_m, message.noise_quadratic_per_m, message.noise_offset_m};
    keyframe.depth_min_m = message.depth_min_m;
    keyframe.depth_max_m = message.depth_max_m;
    FieldErrors errors("keyframe");
    check_depth(keyframe.noise, keyframe.depth_min_m, keyframe.depth_max_m, errors);
    try {
        errors.throw_if_any();
    } catch (const std::invalid_argument& error) {
        throw MessageError(error.what());
    }
}

}  // namespace

Keyframe from_message(const keyframe_t& message) {
    Keyframe keyframe;
    keyframe.utime = checked_utime(message.utime, "keyframe.utime");
    keyframe.pose_utime = checked_utime(message.pose_utime, "keyframe.pose_utime");
    keyframe.id = message.id;
    require(message.id >= 0, "keyframe.id", "is negative");
    require(message.previous_id >= -1 && message.previous_id < message.id, "keyframe.previous_id",
            "is not an earlier keyframe");
    keyframe.previous_id = message.previous_id;
    require(message.chain >= -1 && message.chain <= message.id, "keyframe.chain",
            "is not an earlier keyframe");
    keyframe.chain = message.chain;
    keyframe.odom_from_camera = from_message(message.odom_from_camera, "keyframe.odom_from_camera");
    keyframe.previous_from_camera =
        from_message(message.previous_from_camera, "keyframe.previous_from_camera");
    keyframe.covariance = covariance_from(message.covariance, "keyframe.covariance");
    keyframe.regions = from_messages(message.regions);
    read_depth(message, keyframe);
    constexpr std::size_t kBytes = std::tuple_size_v<Descriptor>;
    const auto features = static_cast<std::size_t>(message.n_features);
    require(message.descriptors.size() == features * kBytes, "keyframe.n_descriptor_bytes",
            "is not 32 n_features");
    keyframe.features.resize(features);
    for (std::size_t i = 0; i < features; ++i) {
        Feature& feature = keyframe.features[i];
        feature.pixel = {message.pixels[i][0], message.pixels[i][1]};
        feature.point = {message.points[i][0], message.points[i][1], message.points[i][2]};
        feature.region = message.regions_of[i];
        require(feature.pixel.allFinite() && feature.point.allFinite(), "keyframe.points", "are not finite");
        require(feature.region >= -1 && feature.region < message.n_regions, "keyframe.regions_of",
                "is out of range");
        std::copy_n(message.descriptors.begin() + static_cast<std::ptrdiff_t>(i * kBytes), kBytes,
                    feature.descriptor.begin());
    }
    return keyframe;
}

look_t to_message(const Look& look, std::int32_t seq, std::int64_t session) {
    look_t message;
    message.session = session;
    message.utime = look.utime;
    message.seq = seq;
    message.keyframe_id = look.keyframe_id;
    message.keyframe_utime = look.keyframe_utime;
    message.number = look.number;
    message.looks = look.looks;
    message.keyframe_from_camera = to_message(look.keyframe_from_camera);
    message.regions = to_messages(look.regions);
    message.n_regions = count32(message.regions.size());
    return message;
}

Look from_message(const look_t& message) {
    Look look;
    look.utime = checked_utime(message.utime, "look.utime");
    look.keyframe_utime = checked_utime(message.keyframe_utime, "look.keyframe_utime");
    require(message.keyframe_id >= 0, "look.keyframe_id", "is negative");
    require(message.number >= 0, "look.number", "is negative");
    require(message.looks >= 1, "look.looks", "is not positive");
    look.keyframe_id = message.keyframe_id;
    look.number = message.number;
    look.looks = message.looks;
    look.keyframe_from_camera = from_message(message.keyframe_from_camera, "look.keyframe_from_camera");
    look.regions = from_messages(message.regions);
    return look;
}

trajectory_t to_message(const KeyframeTrajectory& trajectory, std::int32_t seq, std::int64_t session) {
    trajectory_t message;
    message.session = session;
    message.utime = trajectory.utime;
    message.seq = seq;
    message.revision = trajectory.revision;
    message.n_loop_closures = trajectory.loop_closures;
    message.world_from_odom = to_message(trajectory.world_from_odom);
    message.n_keyframes = count32(trajectory.keyframes.size());
    for (const KeyframePose& keyframe : trajectory.keyframes) {
        message.ids.push_back(keyframe.id);
        message.utimes.push_back(keyframe.utime);
        message.world_from_camera.push_back(to_message(keyframe.world_from_camera));
        message.components.push_back(keyframe.component);
    }
    message.n_components = message.n_keyframes;
    return message;
}

KeyframeTrajectory from_message(const trajectory_t& message) {
    KeyframeTrajectory trajectory;
    trajectory.utime = checked_utime(message.utime, "trajectory.utime");
    trajectory.revision = message.revision;
    trajectory.loop_closures = message.n_loop_closures;
    trajectory.world_from_odom = from_message(message.world_from_odom, "trajectory.world_from_odom");
    const auto count = static_cast<std::size_t>(message.n_keyframes);
    require(message.n_components == 0 || message.n_components == message.n_keyframes,
            "trajectory.n_components", "is neither 0 nor n_keyframes");
    for (std::size_t i = 0; i < count; ++i) {
        require(message.ids[i] >= 0 && (i == 0 || message.ids[i] > message.ids[i - 1]), "trajectory.ids",
                "do not ascend");
        const int component = message.n_components == 0 ? message.ids[0] : message.components[i];
        require(component >= 0 && component <= message.ids[i], "trajectory.components",
                "is not an earlier keyframe");
        trajectory.keyframes.push_back(
            {message.ids[i], checked_utime(message.utimes[i], "trajectory.utimes"),
             from_message(message.world_from_camera[i], "trajectory.world_from_camera"), component});
    }
    return trajectory;
}

surfaces_t to_message(const Surfaces& surfaces, std::int32_t seq, std::int64_t session) {
    surfaces_t message;
    message.session = session;
    message.utime = surfaces.utime;
    message.seq = seq;
    message.n_keyframes = count32(surfaces.keyframes.size());
    for (const KeyframeSurfaces& keyframe : surfaces.keyframes) {
        message.ids.push_back(keyframe.id);
        message.region_counts.push_back(static_cast<std::int16_t>(count32(keyframe.planes.size())));
        message.planes.insert(message.planes.end(), keyframe.planes.begin(), keyframe.planes.end());
    }
    message.n_regions = count32(message.planes.size());
    return message;
}

Surfaces from_message(const surfaces_t& message) {
    Surfaces surfaces;
    surfaces.utime = checked_utime(message.utime, "surfaces.utime");
    const auto count = static_cast<std::size_t>(message.n_keyframes);
    std::size_t first = 0;
    for (std::size_t i = 0; i < count; ++i) {
        require(message.ids[i] >= 0 && (i == 0 || message.ids[i] > message.ids[i - 1]), "surfaces.ids",
                "do not ascend");
        const auto regions = static_cast<std::size_t>(message.region_counts[i]);
        require(message.region_counts[i] >= 0 && first + regions <= message.planes.size(),
                "surfaces.region_counts", "do not sum up to n_regions");
        const auto from = message.planes.begin() + static_cast<std::ptrdiff_t>(first);
        surfaces.keyframes.push_back({message.ids[i], {from, from + message.region_counts[i]}});
        first += regions;
    }
    require(first == message.planes.size(), "surfaces.region_counts", "do not sum up to n_regions");
    return surfaces;
}

namespace {

bot_core::image_t image_message(int width, int height, int stride, std::int32_t format, std::int64_t utime) {
    bot_core::image_t message;
    message.utime = utime;
    message.width = width;
    message.height = height;
    message.row_stride = stride;
    message.pixelformat = format;
    message.nmetadata = 0;
    return message;
}

}  // namespace

bot_core::image_t depth_image_message(const DepthImage& depth, std::int64_t utime, DepthEncoding encoding) {
    if (encoding == DepthEncoding::kZipped)
        return zipped_depth_message(encode_zipped_depth(depth), depth.width, depth.height, utime);
    auto message = image_message(depth.width, depth.height, 2 * depth.width,
                                 bot_core::image_t::PIXEL_FORMAT_LE_GRAY16, utime);
    message.data.resize(2 * depth.pixels.size());
    if (!depth.pixels.empty()) std::memcpy(message.data.data(), depth.pixels.data(), message.data.size());
    message.size = count32(message.data.size());
    return message;
}

bot_core::image_t zipped_depth_message(std::span<const std::uint8_t> zipped, int width, int height,
                                       std::int64_t utime) {
    auto message = image_message(width, height, 0, bot_core::image_t::PIXEL_FORMAT_INVALID, utime);
    message.data.assign(zipped.begin(), zipped.end());
    message.size = count32(message.data.size());
    return message;
}

bot_core::image_t color_image_message(const RgbImage& color, std::int64_t utime, ColorEncoding encoding,
                                      int jpeg_quality) {
    if (encoding == ColorEncoding::kJpeg) {
        return jpeg_image_message(encode_jpeg(color, jpeg_quality), color.width, color.height, utime);
    }
    auto message =
        image_message(color.width, color.height, 3 * color.width, bot_core::image_t::PIXEL_FORMAT_RGB, utime);
    message.data.resize(3 * color.pixels.size());
    if (!color.pixels.empty()) std::memcpy(message.data.data(), color.pixels.data(), message.data.size());
    message.size = count32(message.data.size());
    return message;
}

bot_core::image_t jpeg_image_message(std::span<const std::uint8_t> jpeg, int width, int height,
                                     std::int64_t utime) {
    auto message = image_message(width, height, 0, bot_core::image_t::PIXEL_FORMAT_MJPEG, utime);
    message.data.assign(jpeg.begin(), jpeg.end());
    message.size = count32(message.data.size());
    return message;
}

}  // namespace planemap::messages
