// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/closure_judge.hpp"

#include "core/geometry/angle.hpp"

namespace planemap::evaluation {

namespace {
/// Truth is recorded at 25 to 100 Hz; a second without is a gap.
constexpr std::int64_t kMaxClosureGap_us = 1000000;
}  // namespace

ClosureError closure_error(const Pose& estimate, const Pose& truth, const ClosureTolerance& tolerance) {
    const Pose difference = truth.inverse() * estimate;
    const double allowed_m = tolerance.base_m + tolerance.share_of_distance * truth.translation().norm();
    ClosureError error;
    error.metres = difference.translation().norm();
    error.degrees = degrees(rotation_angle(difference));
    error.is_false = !(error.metres <= allowed_m && error.degrees <= tolerance.angle_deg);
    return error;
}

std::optional<ClosureError> judge_closure(const Trajectory& truth, const Closure& closure,
                                          const ClosureTolerance& tolerance) {
    const auto from = pose_at(truth, closure.from_utime, kMaxClosureGap_us);
    const auto to = pose_at(truth, closure.to_utime, kMaxClosureGap_us);
    if (!from || !to) return std::nullopt;
    return closure_error(closure.from_from_to, from->inverse() * *to, tolerance);
}

}  // namespace planemap::evaluation
