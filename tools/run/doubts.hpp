// SPDX-License-Identifier: BSD-3-Clause
// What makes one doubt what a run was given: a line each, empty where nothing does.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/keyframe.hpp"
#include "core/plane_map.hpp"
#include "core/trajectory.hpp"

namespace planemap {

/// What the depth images of a run hold.
struct DepthCount {
    std::int64_t images = 0;
    std::int64_t empty = 0;     ///< images without a reading
    std::int64_t readings = 0;  ///< on every 8th pixel of every 8th row
    std::int64_t outside = 0;   ///< of these, those that are not in the sensor's range

    void add(const DepthImage& depth, const CameraInfo& camera);
};

/// Images without a reading, and readings that are mostly out of range, as they are where the units of depth
/// are not what camera.json says.
std::vector<std::string> doubts_of_depth(const DepthCount& count);

/// Poses that were given, and that move otherwise than the camera was seen to.
std::string doubt_of_given_poses(const Trajectory& given, const std::vector<OdometryEstimate>& seen);

/// A map that was started from, none of whose planes was seen again.
std::string doubt_of_start(const PlaneMap& start, const PlaneMap& map);

}  // namespace planemap
