// SPDX-License-Identifier: BSD-3-Clause
// A camera's pose from planes alone, for motions too wide to track.
#pragma once

#include <optional>
#include <span>

#include "core/camera.hpp"
#include "core/region.hpp"

namespace planemap {

struct PlaneSearchLimits {
    double max_rotation = 0.6;     ///< from the guess, radians
    double max_translation = 0.8;  ///< from the guess, metres
};

/// The motion, among those near the guess, under which three planes of independent directions coincide and
/// most of the view's points (by the regions' counts) lie on planes of the keyframe. Returns
/// camera_from_keyframe; nothing when no three planes agree or less than half of the points are explained.
std::optional<Pose> search_planes(std::span<const PlanarRegion> keyframe_regions,
                                  std::span<const PlanarRegion> regions, const Pose& guess,
                                  const PlaneSearchLimits& limits = {});

}  // namespace planemap
