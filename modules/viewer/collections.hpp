// SPDX-License-Identifier: BSD-3-Clause
// The map and the trajectory as the collections that Director and libbot's viewers draw.
#pragma once

#include <vs/object_collection_t.hpp>
#include <vs/point3d_list_collection_t.hpp>

#include "core/keyframe.hpp"
#include "core/plane_map.hpp"

namespace planemap::viewer {

/// Ids of the collections that a viewer gets from us.
enum Collection : std::int32_t { kLocalFrame = 7100, kKeyframes = 7101, kPlanes = 7102 };

/// The origin of the local frame, which the points are attached to.
vs::object_collection_t local_frame_collection();

/// The keyframes' poses as those of the body, ids as in the trajectory.
vs::object_collection_t keyframe_collection(const KeyframeTrajectory& trajectory,
                                            const Pose& local_from_world, const Pose& body_from_camera);

/// The outlines' rings as closed lines, each plane in the colour of its id.
vs::point3d_list_collection_t plane_collection(const PlaneMap& map, const Pose& local_from_world);

}  // namespace planemap::viewer
