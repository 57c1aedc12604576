// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/pose_covariance.hpp"

#include "core/geometry/covariance.hpp"

namespace planemap::odometry {

bool says_where(const Matrix6d& covariance) {
    constexpr double kFar_m = 0.1, kFar_rad = 0.0873, kSigmas = 3;
    return kSigmas * largest_sigma(covariance.topLeftCorner<3, 3>()) < kFar_m &&
           kSigmas * largest_sigma(covariance.bottomRightCorner<3, 3>()) < kFar_rad;
}

void PoseCovariance::start() {
    measured_.setZero();
    unseen_steps_ = 0;
}

void PoseCovariance::follow(const Located& located, const Guess& predicted, bool goes_on) {
    unseen_steps_ = located.track.degenerate && !located.track.by_prior ? unseen_steps_ + 1 : 0;
    const Matrix6d before = goes_on ? measured_ : Matrix6d::Zero();
    measured_ = located.covariance();
    if (unseen_steps_ == 0) return;
    const double steps2 = static_cast<double>(unseen_steps_) * unseen_steps_;
    const auto inverse = [](const Matrix6d& matrix) -> Matrix6d {
        return matrix.ldlt().solve(Matrix6d::Identity());
    };
    const Matrix6d& information = located.track.alignment.information;
    const Matrix6d from_last = inverse(steps2 * inverse(predicted.information) + before);
    const Matrix6d surer = inverse(information),
                   unsurer = inverse(information - predicted.information + from_last);
    measured_ = measured_ + 0.5 * (unsurer + unsurer.transpose()) - 0.5 * (surer + surer.transpose());
}

}  // namespace planemap::odometry
