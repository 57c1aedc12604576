// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/closures.hpp"

#include <algorithm>
#include <numbers>

namespace planemap::bench_odometry {

namespace {
/// Truth is recorded at 25 to 100 Hz; a second without is a gap.
constexpr std::int64_t kMaxGap_us = 1000000;
}  // namespace

std::optional<Pose> pose_between(const Trajectory& trajectory, std::int64_t utime, std::int64_t max_gap_us) {
    const auto next =
        std::lower_bound(trajectory.begin(), trajectory.end(), utime,
                         [](const StampedPose& pose, std::int64_t t) { return pose.utime < t; });
    if (next == trajectory.end()) return std::nullopt;
    if (next->utime == utime) return next->world_from_camera;
    if (next == trajectory.begin()) return std::nullopt;
    const StampedPose& before = *(next - 1);
    if (next->utime - before.utime > max_gap_us) return std::nullopt;
    const double fraction =
        static_cast<double>(utime - before.utime) / static_cast<double>(next->utime - before.utime);
    return interpolate(before.world_from_camera, next->world_from_camera, fraction);
}

std::optional<ClosureError> judge(const Trajectory& truth, const Closure& closure,
                                  const ClosureTolerance& tolerance) {
    const auto from = pose_between(truth, closure.from_utime, kMaxGap_us);
    const auto to = pose_between(truth, closure.to_utime, kMaxGap_us);
    if (!from || !to) return std::nullopt;
    const Pose true_from_from_to = from->inverse() * *to;
    const Pose difference = true_from_from_to.inverse() * closure.from_from_to;
    const double allowed_m =
        tolerance.base_m + tolerance.share_of_distance * true_from_from_to.translation().norm();
    ClosureError error;
    error.metres = difference.translation().norm();
    error.degrees = rotation_angle(difference) * 180 / std::numbers::pi;
    error.is_false = !(error.metres <= allowed_m && error.degrees <= tolerance.angle_deg);
    return error;
}

}  // namespace planemap::bench_odometry
