// SPDX-License-Identifier: BSD-3-Clause
// Between messages and the core's values. Towards values everything is checked (finite, sizes that agree,
// indices in range): a message that does not make sense throws MessageError naming type and field.
#pragma once

#include <bot_core/images_t.hpp>
#include <bot_core/pose_t.hpp>
#include <bot_core/rigid_transform_t.hpp>
#include <planemap/acceleration_t.hpp>
#include <planemap/camera_info_t.hpp>
#include <planemap/earlier_plane_map_t.hpp>
#include <planemap/keyframe_t.hpp>
#include <planemap/look_t.hpp>
#include <planemap/odometry_t.hpp>
#include <planemap/planar_regions_t.hpp>
#include <planemap/plane_map_t.hpp>
#include <planemap/seen_space_t.hpp>
#include <planemap/surfaces_t.hpp>
#include <planemap/trajectory_t.hpp>
#include <span>
#include <vector>

#include "core/acceleration.hpp"
#include "core/body_motion.hpp"
#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/keyframe.hpp"
#include "core/look.hpp"
#include "core/plane_map.hpp"
#include "core/region.hpp"
#include "core/seen_space.hpp"
#include "core/surfaces.hpp"
#include "messages/error.hpp"

namespace planemap::messages {

/// A message as the bytes that are sent.
template <typename T>
std::vector<std::uint8_t> to_bytes(const T& message) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    return bytes;
}

/// The stamp of a message; throws MessageError naming the field if it is beyond kFarthestUtime.
std::int64_t checked_utime(std::int64_t utime, const char* field);

camera_info_t to_message(const CameraInfo& camera, std::int64_t utime, std::int32_t seq,
                         std::int64_t session = 0);
CameraInfo from_message(const camera_info_t& message);

acceleration_t to_message(const Acceleration& reading);
Acceleration from_message(const acceleration_t& message);

/// The planar regions of one depth image, camera frame.
struct FrameRegions {
    std::int64_t utime = 0;  ///< of the depth image
    std::vector<PlanarRegion> regions;
};
planar_regions_t to_message(const FrameRegions& regions, std::int32_t seq, std::int64_t session = 0);
FrameRegions from_message(const planar_regions_t& message);

odometry_t to_message(const OdometryEstimate& estimate, std::int32_t seq, std::int64_t session = 0);
OdometryEstimate from_message(const odometry_t& message);
/// For viewers and robots that know bot_core only.
bot_core::pose_t to_message(const BodyMotion& motion, std::int64_t utime);
bot_core::rigid_transform_t to_rigid_transform(const Pose& pose, std::int64_t utime);
Pose from_message(const bot_core::rigid_transform_t& message);

keyframe_t to_message(const Keyframe& keyframe, std::int32_t seq, std::int64_t session = 0);
Keyframe from_message(const keyframe_t& message);

look_t to_message(const Look& look, std::int32_t seq, std::int64_t session = 0);
Look from_message(const look_t& message);

trajectory_t to_message(const KeyframeTrajectory& trajectory, std::int32_t seq, std::int64_t session = 0);
KeyframeTrajectory from_message(const trajectory_t& message);
surfaces_t to_message(const Surfaces& surfaces, std::int32_t seq, std::int64_t session = 0);
Surfaces from_message(const surfaces_t& message);
seen_space_t to_message(const SeenSpace& seen, std::int64_t utime, std::int32_t seq,
                        std::int64_t session = 0);
SeenSpace from_message(const seen_space_t& message);

/// The map packed: outlines and lines in steps of 5 mm, so that no vertex is further than 5 mm from where it
/// was (up to 80 m from the middle of its plane), inliers to 0.2 %, and what follows from these left out; see
/// packed_map.hpp. Throws std::length_error if the map is too large for a message.
plane_map_t to_message(const PlaneMap& map, std::int32_t seq, std::int64_t session = 0);
PlaneMap from_message(const plane_map_t& message);
/// As it was sent before it was packed, in steps of 1 mm: nothing is lost.
PlaneMap from_message(const earlier_plane_map_t& message);
/// The map in the bytes of a message of today's format or an earlier one. Throws MessageError as decode() and
/// from_message() do.
PlaneMap plane_map_from(std::span<const std::uint8_t> bytes);

/// How the images of a frame are sent.
enum class ColorEncoding { kRaw, kJpeg };
enum class DepthEncoding { kRaw, kZipped };

/// One image each; metadata "seq" (4 bytes, little-endian) lets a receiver count the frames it missed.
bot_core::image_t depth_image_message(const DepthImage& depth, std::int64_t utime, DepthEncoding encoding);
/// Depth that is a zlib stream of its rows already.
bot_core::image_t zipped_depth_message(std::span<const std::uint8_t> zipped, int width, int height,
                                       std::int64_t utime);
bot_core::image_t color_image_message(const RgbImage& color, std::int64_t utime, ColorEncoding encoding,
                                      int jpeg_quality);
bot_core::image_t jpeg_image_message(std::span<const std::uint8_t> jpeg, int width, int height,
                                     std::int64_t utime);

}  // namespace planemap::messages
