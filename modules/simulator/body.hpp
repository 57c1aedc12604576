// SPDX-License-Identifier: BSD-3-Clause
// What moves, appears or vanishes in a simulated world.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/geometry/pose.hpp"

namespace planemap::simulator {

/// Something of one piece. Times are seconds after the world's change (SimulatorOptions::change_s); before it
/// they are negative.
struct Body {
    static constexpr double kAlways = std::numeric_limits<double>::infinity();

    /// Where it is at a time, in the world frame. Two keys at one time are a jump: the later one holds.
    struct Key {
        double seconds = 0;
        Pose world_from_rest = Pose::Identity();
    };
    /// A time in which it is there and stands still.
    struct Stay {
        double from_s = -kAlways, until_s = kAlways;  ///< until_s is no longer part of it
        Pose world_from_rest = Pose::Identity();
    };

    std::string name;
    double from_s = -kAlways, until_s = kAlways;  ///< when it is there; until_s is no longer part of it
    std::vector<Key> path = {};  ///< by time; before the first and after the last it stands; none: at rest

    bool is_there(double seconds) const { return seconds >= from_s && seconds < until_s; }
    /// Interpolated between keys.
    Pose pose_at(double seconds) const;
    /// All its stays, in order: at least `least_s` long.
    std::vector<Stay> stays(double least_s) const;
};

}  // namespace planemap::simulator
