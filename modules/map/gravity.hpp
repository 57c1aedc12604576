// SPDX-License-Identifier: BSD-3-Clause
// Which way is up: told by the sensor's mount or an accelerometer, or found from planes and motion.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/geometry/pose.hpp"
#include "core/plane_map.hpp"

namespace planemap::map {

struct GravityRules {
    double tolerance_deg = 10;  ///< a plane this near to level or upright speaks for an up direction
    double rival_deg = 30;      ///< directions further apart than this are different answers
    double margin = 2;          ///< by which the best answer must lead the next, in nats: odds of 7 to 1
    double scatter_deg = 20;  ///< directions that were told agree when they scatter by less about their mean
};

/// What is known of up.
struct Up {
    std::optional<Eigen::Vector3d> direction;  ///< unit, world, against gravity
    std::string why;                           ///< where it is from, or why it is not known: a clause
};

/// Up from what the sensor's mount or an accelerometer said at several keyframes: unit vectors, each turned
/// into the world. Their mean, made exact by the planes that are level or upright about it. Not known if
/// there are none, or if they scatter: a mount that is not fixed, an accelerometer in other axes.
Up up_as_told(std::span<const Eigen::Vector3d> up_world, std::span<const MapPlane> planes,
              const std::string& by, const GravityRules& rules = {});

/// Up from planes and from how the camera was held and moved. Not known without planes, without poses, or
/// when two answers are about as likely.
///
/// The answers compared are both normals of the large planes, both directions square to two of them, and what
/// was up, down or sideways in the image on average, as it is and made square to one of them. Each is judged
/// by the logarithm of its odds:
/// - planes: + 10 times the share of them that is level or upright about it;
/// - held: how likely a camera is held that way. Most are upright, some on a side or upside down (1 to 30);
///   most look ahead or a little down, some straight down, few up;
/// - turned: - 4 times the share of the camera's turning that is not about it, once it turned by much: who
///   looks around in a room turns about up, whichever way the camera is held;
/// - moved: - 5 times the share of the camera's motion along it, once it moved by much: people and robots
///   move on the level;
/// - seen: + 2 times the surplus of level planes that face up, the lowest one left out, over those that face
///   down, the highest one left out: tables and shelves are seen from above;
/// - stands: - 3 times the share of upright planes with something behind them that is seen further down: what
///   stands in a room hides what is behind it down to the floor; + 2 times the surplus of things in the lower
///   half of what was seen over those in the upper one.
/// Planes weigh by the square root of their area and by how often they were seen (support.hpp).
///
/// The best answer is refined by weighted least squares over all planes level or upright about it, with
/// weights that fall to zero at the tolerance, so that no single plane decides.
/// Poses that are not finite and planes with a normal, centre or area that is not are left out.
Up find_up(std::span<const MapPlane> planes, std::span<const Pose> world_from_camera,
           const GravityRules& rules = {});

}  // namespace planemap::map
