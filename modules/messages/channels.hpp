// SPDX-License-Identifier: BSD-3-Clause
// The channels of the bus, upper case as the LCM world writes them.
#pragma once

#include <cstddef>

namespace planemap::messages::channels {

inline constexpr const char* kFrame = "OPENNI_FRAME";                        ///< bot_core.images_t
inline constexpr const char* kCameraInfo = "PLANEMAP_CAMERA_INFO";           ///< planemap.camera_info_t
inline constexpr const char* kAcceleration = "PLANEMAP_ACCELERATION";        ///< planemap.acceleration_t
inline constexpr const char* kRegions = "PLANEMAP_REGIONS";                  ///< planemap.planar_regions_t
inline constexpr const char* kOdometry = "PLANEMAP_ODOMETRY";                ///< planemap.odometry_t
inline constexpr const char* kPose = "POSE_BODY";                            ///< bot_core.pose_t
inline constexpr const char* kLocalFromOdom = "PLANEMAP_LOCAL_FROM_ODOM";    ///< bot_core.rigid_transform_t
inline constexpr const char* kBodyFromCamera = "PLANEMAP_BODY_FROM_CAMERA";  ///< bot_core.rigid_transform_t
inline constexpr const char* kKeyframe = "PLANEMAP_KEYFRAME";                ///< planemap.keyframe_t
inline constexpr const char* kLook = "PLANEMAP_LOOK";                        ///< planemap.look_t
inline constexpr const char* kTrajectory = "PLANEMAP_TRAJECTORY";            ///< planemap.trajectory_t
inline constexpr const char* kSurfaces = "PLANEMAP_SURFACES";                ///< planemap.surfaces_t
inline constexpr const char* kMap = "PLANEMAP_MAP";                          ///< planemap.plane_map_t
inline constexpr const char* kOtherMaps =
    "PLANEMAP_MAP_OTHERS";  ///< planemap.plane_map_t, of other components
inline constexpr const char* kSeenSpace =
    "PLANEMAP_SEEN_SPACE";  ///< planemap.seen_space_t, beside the map in files
inline constexpr const char* kOctomapSize = "PLANEMAP_OCTOMAP_SIZE";        ///< planemap.map_size_t
inline constexpr const char* kPreviewColor = "PLANEMAP_PREVIEW_COLOR";      ///< bot_core.image_t
inline constexpr const char* kPreviewDepth = "PLANEMAP_PREVIEW_DEPTH";      ///< bot_core.image_t
inline constexpr const char* kPreviewRegions = "PLANEMAP_PREVIEW_REGIONS";  ///< bot_core.image_t
inline constexpr const char* kObjectCollection = "OBJECT_COLLECTION";       ///< vs.object_collection_t
inline constexpr const char* kPointsCollection = "POINTS_COLLECTION";       ///< vs.point3d_list_collection_t
inline constexpr const char* kStatusPrefix =
    "PLANEMAP_STATUS_";  ///< planemap.module_status_t, module in upper case

inline constexpr std::size_t kMaxChannel = 63;  ///< characters, LCM's bound
/// Of a session's prefix, which leaves 32 characters for the names above.
inline constexpr std::size_t kMaxChannelPrefix = 31;

}  // namespace planemap::messages::channels
