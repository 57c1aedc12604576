// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/pose_judge.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <set>

#include "core/geometry/angle.hpp"
#include "core/geometry/covariance.hpp"

namespace planemap::bench_odometry {

namespace {

/// The covariance of a small motion in frame a, of the same motion in frame b.
Matrix6d carried(const Pose& b_from_a, const Matrix6d& covariance) {
    Matrix6d carry = Matrix6d::Zero();
    carry.topLeftCorner<3, 3>() = carry.bottomRightCorner<3, 3>() = b_from_a.linear();
    carry.topRightCorner<3, 3>() = skew(b_from_a.translation()) * b_from_a.linear();
    return carry * covariance * carry.transpose();
}

bool is_marked(TrackingStatus status) {
    return status == TrackingStatus::kDegenerate || status == TrackingStatus::kStale;
}

bool is_near(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance, double sigmas) {
    const Eigen::LDLT<Eigen::Matrix3d> solver(covariance);
    if (!solver.isPositive() || !(solver.vectorD().minCoeff() > 0)) return error.isZero();
    return error.dot(solver.solve(error)) <= sigmas * sigmas;
}

}  // namespace

Spread spread_of(const Matrix6d& covariance) {
    return {largest_sigma(covariance.topLeftCorner<3, 3>()),
            degrees(largest_sigma(covariance.bottomRightCorner<3, 3>()))};
}

bool is_unknown(const Matrix6d& covariance, const JudgeLimits& limits) {
    if (!covariance.allFinite()) return true;
    const Spread spread = spread_of(covariance);
    return spread.metres > limits.unknown_m || spread.degrees > limits.unknown_deg;
}

bool is_within(const Twist& error, const Matrix6d& covariance, double sigmas) {
    return is_near(error.head<3>(), covariance.topLeftCorner<3, 3>(), sigmas) &&
           is_near(error.tail<3>(), covariance.bottomRightCorner<3, 3>(), sigmas);
}

Twist pose_error(const Pose& estimate, const Pose& truth) {
    return twist_from_pose(truth.inverse() * estimate);
}

std::optional<double> nees_of(const Twist& error, const Matrix6d& covariance) {
    const Eigen::LDLT<Matrix6d> solver(covariance);
    if (!covariance.allFinite() || !solver.isPositive() || !(solver.vectorD().minCoeff() > 0))
        return std::nullopt;
    return error.dot(solver.solve(error));
}

PoseJudge::PoseJudge(std::span<const ToldFrame> frames, std::span<const ToldKeyframe> keyframes,
                     std::size_t first, const JudgeLimits& limits)
    : frames_(frames), first_(first), limits_(limits) {
    for (const ToldKeyframe& keyframe : keyframes) keyframes_[keyframe.id] = keyframe;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
        const OdometryEstimate& estimate = frames_[i].estimate;
        if (estimate.status != TrackingStatus::kTracked || !frames_[i].truth) continue;
        if (is_unknown(estimate.covariance, limits_)) continue;
        const auto [reference, is_new] = references_.try_emplace(part_of(estimate.keyframe_id), i);
        if (!is_new && i < first_) reference->second = i;
    }
}

bool PoseJudge::joins(const ToldKeyframe& keyframe) const {
    return keyframe.previous_id >= 0 && keyframes_.contains(keyframe.previous_id) &&
           !is_unknown(keyframe.covariance, limits_);
}

int PoseJudge::part_of(int id) const {
    for (auto keyframe = keyframes_.find(id); keyframe != keyframes_.end() && joins(keyframe->second);
         keyframe = keyframes_.find(id))
        id = keyframe->second.previous_id;
    return id;
}

/// Of `to` in `from`'s camera, in the camera frame of `to`. Precondition: both are of one part.
Matrix6d PoseJudge::covariance(const OdometryEstimate& from, const OdometryEstimate& to, bool& marked) const {
    std::set<int> way;  // keyframes whose edges to the one before lie between the two
    const auto climb = [&](int id) {
        for (auto keyframe = keyframes_.find(id); keyframe != keyframes_.end() && joins(keyframe->second);
             keyframe = keyframes_.find(keyframe->second.previous_id)) {
            // An edge that both ways go is not between them.
            if (const auto [place, is_new] = way.insert(keyframe->first); !is_new) way.erase(place);
        }
    };
    climb(from.keyframe_id);
    climb(to.keyframe_id);
    const Pose to_from_odom = to.odom_from_camera.inverse();
    Matrix6d sum = to.covariance + carried(to_from_odom * from.odom_from_camera, from.covariance);
    for (const int id : way) {
        const ToldKeyframe& keyframe = keyframes_.at(id);
        sum += carried(to_from_odom * keyframe.odom_from_camera, keyframe.covariance);
        marked =
            marked || (keyframe.frame < frames_.size() && is_marked(frames_[keyframe.frame].estimate.status));
    }
    return sum;
}

Judgement PoseJudge::judge(std::size_t frame) const {
    using Verdict = Judgement::Verdict;
    const ToldFrame& told = frames_[frame];
    Judgement judgement;
    judgement.verdict = Verdict::kNoPose;
    if (told.estimate.status == TrackingStatus::kLost || is_unknown(told.estimate.covariance, limits_))
        return judgement;
    judgement.part = part_of(told.estimate.keyframe_id);
    const auto reference = references_.find(judgement.part);
    judgement.verdict = Verdict::kUnknown;
    if (reference == references_.end() || !told.truth) return judgement;
    const ToldFrame& from = frames_[reference->second];
    bool marked = is_marked(told.estimate.status);
    const Matrix6d spread = covariance(from.estimate, told.estimate, marked);
    if (is_unknown(spread, limits_)) {
        judgement.verdict = Verdict::kNoPose;
        return judgement;
    }
    const Twist error = pose_error(from.estimate.odom_from_camera.inverse() * told.estimate.odom_from_camera,
                                   from.truth->inverse() * *told.truth);
    judgement.metres = error.head<3>().norm();
    judgement.degrees = degrees(error.tail<3>().norm());
    const bool is_small = judgement.metres <= limits_.wrong_m && judgement.degrees <= limits_.wrong_deg;
    const bool is_admitted = marked && is_within(error, spread, limits_.sigmas);
    judgement.verdict = is_small ? Verdict::kRight : is_admitted ? Verdict::kAdmitted : Verdict::kWrong;
    return judgement;
}

int PoseJudge::parts_begun() const {
    return static_cast<int>(std::count_if(keyframes_.begin(), keyframes_.end(), [&](const auto& entry) {
        return entry.second.frame >= first_ && !joins(entry.second);
    }));
}

}  // namespace planemap::bench_odometry
