// SPDX-License-Identifier: BSD-3-Clause
// Loop closures against the true poses.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/trajectory.hpp"

namespace planemap::bench_odometry {

/// Two moments that a method says it knows the relative pose of.
struct Closure {
    std::int64_t from_utime = 0, to_utime = 0;  ///< moments of the two poses, microseconds
    Pose from_from_to = Pose::Identity();       ///< the later camera in the earlier camera's frame
};

/// How far a closure's relative pose may be from the true one.
struct ClosureTolerance {
    double base_m = 0.10;
    double share_of_distance = 0.02;  ///< on top, times the true distance between the two poses
    double angle_deg = 5;
};

struct ClosureCount {
    int right = 0, wrong = 0;
    int unjudged = 0;  ///< no true pose near one of its moments
    friend bool operator==(const ClosureCount&, const ClosureCount&) = default;
};

/// The pose of a trajectory at a moment, interpolated between neighbours that are at most max_gap_us apart;
/// nothing in a wider gap or outside. The trajectory is sorted by time.
std::optional<Pose> pose_between(const Trajectory& trajectory, std::int64_t utime, std::int64_t max_gap_us);

/// Counts closures whose relative pose is true and false, see ClosureTolerance.
ClosureCount count_closures(const Trajectory& truth, const std::vector<Closure>& closures,
                            const ClosureTolerance& tolerance = {});

}  // namespace planemap::bench_odometry
