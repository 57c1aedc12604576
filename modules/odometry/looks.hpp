// SPDX-License-Identifier: BSD-3-Clause
// What frames between keyframes say of the place: that nothing changed, or what did.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "core/keyframe.hpp"
#include "core/look.hpp"
#include "core/sight.hpp"

namespace planemap::odometry {

/// Holds frames against what the keyframe that they were tracked against, or the last change since, showed.
/// Where one of both sees past what the other saw, something came or went. In a still place a look is said
/// until as many as count have seen it, and then nothing any more. Changes are bounded: kMostChanges in a
/// row, then one each kChangeEach_s.
class Looks {
  public:
    static constexpr double kMostChanges = 30;
    static constexpr double kChangeEach_s = 2;

    /// A frame that became a keyframe.
    void begin(const Keyframe& keyframe);
    /// Another frame with its regions (camera frame; invalid ones are ignored), tracked as the estimate says;
    /// nothing if it says nothing.
    std::optional<Look> see(const OdometryEstimate& estimate, std::span<const PlanarRegion> regions);

  private:
    /// What was seen from near a keyframe, last.
    struct Place {
        int keyframe_id = -1;
        std::int64_t keyframe_utime = 0;
        DepthNoise noise;
        int number = 0, looks = 1;
        Pose keyframe_from_camera = Pose::Identity();
        Sight sight;
        std::vector<Plane> planes;
    };
    bool may_change(std::int64_t utime);

    static constexpr std::size_t kMostPlaces = 16;
    std::deque<Place> places_;  ///< the newest keyframe last
    std::int64_t last_utime_ = 0;
    int last_keyframe_id_ = -1;  ///< that the last look said something of
    double changes_left_ = kMostChanges;
    std::int64_t changed_utime_ = 0;
};

}  // namespace planemap::odometry
