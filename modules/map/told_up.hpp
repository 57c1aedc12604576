// SPDX-License-Identifier: BSD-3-Clause
// Which way is up by what the sensor's mount and an accelerometer say, for those cameras that have one.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>

#include "core/acceleration.hpp"
#include "map/gravity.hpp"

namespace planemap::map {

class ToldUp {
  public:
    /// How the camera is mounted on a robot, which is taken to stand level on average.
    void hear_mount(const Pose& body_from_camera);
    /// A reading of the accelerometer; of those of the last seconds, 1024 are kept. One that is not finite,
    /// or less than a half or more than twice what gravity gives, says nothing of up and is left out.
    void hear(const Acceleration& reading);
    /// A keyframe came: what the accelerometer read about then is what it says of up there.
    void came(int keyframe_id, std::int64_t utime);

    /// By the accelerometer, or, if it did not say, by the mount; up_as_told() of all keyframes. `poses` are
    /// world_from_camera of keyframes, by id. Its direction is not known if neither said; why is empty then,
    /// unless one contradicts itself.
    Up find(const std::map<int, Pose>& poses, std::span<const MapPlane> planes,
            const GravityRules& rules) const;

    /// Counts what was said.
    int revision() const { return revision_; }

  private:
    std::optional<Eigen::Vector3d> mount_camera_;  ///< up in the camera, unit
    std::deque<Acceleration> recent_;              ///< in order of arrival
    std::map<int, Eigen::Vector3f> read_camera_;   ///< up in the camera, unit, by keyframe
    int revision_ = 0;
};

}  // namespace planemap::map
