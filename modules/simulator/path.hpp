// SPDX-License-Identifier: BSD-3-Clause
// How a simulated camera moves.
#pragma once

#include "core/trajectory.hpp"
#include "simulator/world.hpp"

namespace planemap::simulator {

/// Gait of a hand-held camera.
struct HandOptions {
    double speed_m_s = 0.5;            ///< when it does not turn
    double turn_deg_s = 45;            ///< when it stands
    double tremor_m = 0.003;           ///< amplitude of the hand's shaking, 0.8 to 3 Hz
    double tremor_deg = 0.35;          ///< the same for its rotation
    double waypoint_scatter_m = 0.04;  ///< another seed passes each waypoint this near, and looks this far
                                       ///< off times three
};

/// A smooth walk along a world's tour, round after round: a closed cubic B-spline through the neighbourhood
/// of its waypoints, as fast as speed and turning rate together allow, with tremor. Poses every 1/120 s from
/// `start_utime` (microseconds) for at least duration_s seconds. World frame: z up.
Trajectory make_hand_path(const std::vector<Waypoint>& tour, double duration_s, std::int64_t start_utime,
                          const HandOptions& options, std::uint64_t seed);

/// A walk that goes from place to place in random order, `visits` of them and never to the same twice
/// running, and stands a moment at each: waypoints for make_hand_path(). Between two places it goes straight
/// and turns the shorter way. At least two places.
std::vector<Waypoint> wander(const std::vector<Waypoint>& places, int visits, std::uint64_t seed);

/// Seconds for one round of the tour.
double tour_duration(const std::vector<Waypoint>& tour, const HandOptions& options, std::uint64_t seed);

/// A recorded trajectory whose world y points down, turned upright and moved (level, and turned about the
/// vertical in steps of 30 deg) to where it keeps the largest distance from the world's surfaces within its
/// free box. Times are kept.
Trajectory fit_path(const Trajectory& recorded, const World& world);

/// Pose at a time: interpolated, the first or last pose outside. Precondition: not empty.
Pose pose_at(const Trajectory& trajectory, std::int64_t utime);

}  // namespace planemap::simulator
