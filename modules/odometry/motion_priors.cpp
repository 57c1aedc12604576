// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/motion_priors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace planemap::odometry {
namespace {

constexpr std::int64_t kRemembered_us = 120000000;
constexpr std::size_t kMostHeard = 50000;
constexpr double kLeast_m = 0.003, kLeast_rad = 0.003;  // sigma of a prior of no motion
// A contradiction weighs as much as ten frames that agree; one is forgiven.
constexpr int kContradiction = 10, kForgiven = 10, kMostDistrust = 40;

/// 99.9 % of a chi-squared distribution of so many degrees of freedom.
constexpr std::array<double, 7> kChiSquared{0, 10.83, 13.82, 16.27, 18.47, 20.52, 22.46};

Pose between(const Pose& a, const Pose& b, double share) {
    return a * pose_from_twist(share * twist_from_pose(a.inverse() * b));
}

/// Directions in scaled coordinates, seen ones and others, and what the camera knows along each.
struct Directions {
    Twist scale;  ///< metres and radians of a unit
    Matrix6d vectors;
    Twist information;  ///< ascending
    int weak = 0;       ///< the first so many are known by the prediction alone

    explicit Directions(const Track& track) {
        scale = track.guess_information.diagonal().cwiseSqrt().cwiseInverse();
        const Matrix6d data =
            scale.asDiagonal() * (track.alignment.information - track.guess_information) * scale.asDiagonal();
        const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(data);
        vectors = eigen.eigenvectors();
        information = eigen.eigenvalues();
        while (weak < 6 && !(information[weak] > kWeakDirection)) ++weak;
    }
};

/// How far the prior is from the camera where the camera sees, against what both allow.
bool contradicts(const Directions& directions, const Twist& off, const Matrix6d& prior_covariance) {
    const int seen = 6 - directions.weak;
    if (seen == 0) return false;
    const Eigen::MatrixXd along =
        directions.vectors.rightCols(seen).transpose() * directions.scale.cwiseInverse().asDiagonal();
    Eigen::MatrixXd covariance = along * prior_covariance * along.transpose();
    covariance.diagonal() += directions.information.tail(seen).cwiseInverse();
    const Eigen::VectorXd e = along * off;
    return !(e.dot(covariance.ldlt().solve(e)) < kChiSquared[static_cast<std::size_t>(seen)]);
}

/// Puts the prior in the place of the prediction, in the directions that the camera does not see.
void fill(const Directions& directions, const Twist& off, const Matrix6d& prior_information, Track& track) {
    const int weak = directions.weak;
    const Eigen::MatrixXd from_weak = directions.scale.asDiagonal() * directions.vectors.leftCols(weak);
    const Eigen::MatrixXd to_weak =
        directions.vectors.leftCols(weak).transpose() * directions.scale.cwiseInverse().asDiagonal();
    const Eigen::MatrixXd prior = from_weak.transpose() * prior_information * from_weak;
    Eigen::MatrixXd known = prior;
    known.diagonal() += directions.information.head(weak).cwiseMax(0);
    const Eigen::VectorXd step = known.ldlt().solve(prior * (to_weak * off));
    AlignmentResult& pose = track.alignment;
    pose.camera_from_keyframe =
        orthonormalised(pose_from_twist(Twist(from_weak * step)) * pose.camera_from_keyframe);
    const Eigen::MatrixXd prediction = from_weak.transpose() * track.guess_information * from_weak;
    pose.information += to_weak.transpose() * (prior - prediction) * to_weak;
    track.by_prior = true;
}

}  // namespace

bool MotionPriors::hear(const MotionPrior& prior) {
    if (!is_valid(prior.local_from_body)) return false;
    Heard heard{prior};
    if (!heard_.empty()) {
        const Heard& last = heard_.back();
        if (prior.utime == last.prior.utime) return false;
        if (prior.utime < last.prior.utime) {
            heard_.clear();
        } else {
            const Pose step = last.prior.local_from_body.inverse() * prior.local_from_body;
            heard.path_m = last.path_m + step.translation().norm();
            heard.path_rad = last.path_rad + rotation_angle(step);
        }
    }
    heard_.push_back(heard);
    while (heard_.size() > kMostHeard || prior.utime - heard_.front().prior.utime > kRemembered_us)
        heard_.pop_front();
    return true;
}

/// Between two that were heard; for at most max_age_s after the last one as those before it lead on.
std::optional<MotionPriors::Heard> MotionPriors::at(std::int64_t utime) const {
    const auto max_age_us = static_cast<std::int64_t>(1e6 * options_.max_age_s);
    auto after = std::lower_bound(heard_.begin(), heard_.end(), utime,
                                  [](const Heard& heard, std::int64_t t) { return heard.prior.utime < t; });
    if (after != heard_.end() && after->prior.utime == utime) return *after;
    if (after == heard_.end()) {
        if (heard_.size() < 2 || utime - heard_.back().prior.utime > max_age_us) return std::nullopt;
        --after;
    }
    if (after == heard_.begin()) return std::nullopt;
    const Heard &a = *(after - 1), &b = *after;
    if (b.prior.utime - a.prior.utime > max_age_us) return std::nullopt;  // a gap
    const double share = double(utime - a.prior.utime) / double(b.prior.utime - a.prior.utime);
    Heard heard;
    heard.prior = {utime, between(a.prior.local_from_body, b.prior.local_from_body, share)};
    heard.path_m = a.path_m + share * (b.path_m - a.path_m);
    heard.path_rad = a.path_rad + share * (b.path_rad - a.path_rad);
    return heard;
}

PriorUse MotionPriors::apply(Track& track, std::int64_t keyframe_utime, std::int64_t utime,
                             const std::optional<Pose>& body_from_camera) {
    if (heard_.empty() || !(track.guess_information.diagonal().minCoeff() > 0)) return PriorUse::kNone;
    if (!body_from_camera) return PriorUse::kNoMount;
    const std::optional<Heard> from = at(keyframe_utime), to = at(utime);
    if (!from || !to) return PriorUse::kStale;
    const Pose body_then_from_now = from->prior.local_from_body.inverse() * to->prior.local_from_body;
    const Pose camera_from_keyframe =
        (body_from_camera->inverse() * body_then_from_now * *body_from_camera).inverse();
    const double sigma_rad =
        kLeast_rad + options_.sigma_rad_per_rad * std::abs(to->path_rad - from->path_rad);
    const double sigma_m = std::hypot(
        kLeast_m + options_.sigma_m_per_m * std::abs(to->path_m - from->path_m),
        sigma_rad * (body_from_camera->translation().norm() + body_then_from_now.translation().norm()));
    Twist variance;
    variance << Eigen::Vector3d::Constant(sigma_m * sigma_m),
        Eigen::Vector3d::Constant(sigma_rad * sigma_rad);

    const Twist off = twist_from_pose(camera_from_keyframe * track.alignment.camera_from_keyframe.inverse());
    const Directions directions(track);
    if (contradicts(directions, off, variance.asDiagonal())) {
        distrust_ = std::min(distrust_ + kContradiction, kMostDistrust);
        return PriorUse::kContradictory;
    }
    if (directions.weak == 0) distrust_ = std::max(0, distrust_ - 1);
    if (distrust_ > kForgiven) return PriorUse::kDistrusted;
    if (directions.weak == 0) return PriorUse::kNotNeeded;
    fill(directions, off, Matrix6d(variance.cwiseInverse().asDiagonal()), track);
    return PriorUse::kFilled;
}

}  // namespace planemap::odometry
