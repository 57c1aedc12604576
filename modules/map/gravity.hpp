// SPDX-License-Identifier: BSD-3-Clause
// Which way is up, from the planes and from how the camera was held and moved.
#pragma once

#include <optional>
#include <span>

#include "core/geometry/pose.hpp"
#include "core/plane_map.hpp"

namespace planemap::map {

struct GravityRules {
    double tolerance_deg = 10;  ///< a plane this near to level or upright speaks for an up direction
    double held_deg = 55;       ///< up is at most this far from the cameras' average up (against image rows)
    double rival_deg = 30;      ///< directions further apart than this are different answers
    double margin = 0.15;       ///< by which the best answer must lead the next; see find_up()
};

/// Up in the world, a unit vector against gravity; nothing without planes, without poses, or when two answers
/// are about as likely.
///
/// The answers compared are the normals of the large planes, the common horizontals' normals of pairs of
/// them, and the cameras' average up made upright to one of them. An answer u scores the share (0 to 1) of
/// planes level or upright about it, weighted by the square root of their area, plus how well it fits the
/// cameras: + u . average up, - the mean of (u . image row)^2, as cameras do not roll much, - up to half the
/// share of the cameras' motion along u, as walkers and robots move on the level. So a camera that looks
/// down at 45 degrees and only ever looked one way gives no answer until it moved by some metres or turned.
///
/// The best answer is refined by weighted least squares over all planes level or upright about it, with
/// weights that fall to zero at the tolerance, so that no single plane decides.
/// Poses that are not finite and planes with a normal, centre or area that is not are left out.
std::optional<Eigen::Vector3d> find_up(std::span<const MapPlane> planes,
                                       std::span<const Pose> world_from_camera,
                                       const GravityRules& rules = {});

}  // namespace planemap::map
