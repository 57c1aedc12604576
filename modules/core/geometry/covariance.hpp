// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>

namespace planemap {

/// The standard deviation in the worst direction; NaN for what is no number.
inline double largest_sigma(const Eigen::Matrix3d& covariance) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
    const double variance = solver.eigenvalues()(2);
    return variance < 0 ? 0 : std::sqrt(variance);  // rounding
}

}  // namespace planemap
