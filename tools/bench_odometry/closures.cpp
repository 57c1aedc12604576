// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/closures.hpp"

#include "core/geometry/angle.hpp"

namespace planemap::bench_odometry {

namespace {
/// Truth is recorded at 25 to 100 Hz; a second without is a gap.
constexpr std::int64_t kMaxGap_us = 1000000;
}  // namespace

std::optional<ClosureError> judge(const Trajectory& truth, const Closure& closure,
                                  const ClosureTolerance& tolerance) {
    const auto from = pose_at(truth, closure.from_utime, kMaxGap_us);
    const auto to = pose_at(truth, closure.to_utime, kMaxGap_us);
    if (!from || !to) return std::nullopt;
    const Pose true_from_from_to = from->inverse() * *to;
    const Pose difference = true_from_from_to.inverse() * closure.from_from_to;
    const double allowed_m =
        tolerance.base_m + tolerance.share_of_distance * true_from_from_to.translation().norm();
    ClosureError error;
    error.metres = difference.translation().norm();
    error.degrees = degrees(rotation_angle(difference));
    error.is_false = !(error.metres <= allowed_m && error.degrees <= tolerance.angle_deg);
    return error;
}

}  // namespace planemap::bench_odometry
