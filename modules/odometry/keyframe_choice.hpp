// SPDX-License-Identifier: BSD-3-Clause
// When a frame becomes a keyframe.
#pragma once

#include <optional>

#include "odometry/local_keyframes.hpp"
#include "odometry/options.hpp"
#include "odometry/tracker.hpp"

namespace planemap::odometry {

/// Whether frames can be tracked against it: by so many corners, or by its depth.
bool can_be_tracked_against(const LocalKeyframe& keyframe, int min_points);

/// Whether the camera is far from the keyframe that the frame was located against.
bool has_moved(const OdometryOptions& options, const Located& located);

/// Whether too little of the keyframe is seen again, of its corners or, where depth alone leads, its surface.
bool has_lost_overlap(const OdometryOptions& options, const LocalKeyframe& keyframe,
                      const PreparedFrame& frame, const Track& track);

/// Whether `candidate`, made of the frame, would do what the present keyframe does not. Where features do not
/// hold, those of the same view would not hold either, unless they are many more, as when the light goes on.
bool is_worth_it(const OdometryOptions& options, const LocalKeyframe& keyframe, const PreparedFrame& frame,
                 const Located& located, const LocalKeyframe& candidate);

/// A keyframe that tracking returns to.
struct Return {
    int id = -1;
    Track track;  ///< of the frame against it
};

/// Another local keyframe that sees more of the frame than the present one, with the frame tracked against
/// it. `velocity` is the camera's, see Alignment.
std::optional<Return> find_other_keyframe(const OdometryOptions& options, const LocalKeyframes& keyframes,
                                          const PreparedFrame& frame, const Located& located,
                                          const Twist& velocity);

}  // namespace planemap::odometry
