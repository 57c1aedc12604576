// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/geometry/pose.hpp"

namespace planemap {

/// The motion a_from_b that moves mean_b to mean_a with the rotation R of the largest trace of
/// R^T correlation: where correlation is the sum of a_i b_i^T over pairs of vectors, that is the rotation
/// with the least sum of |a_i - R b_i|^2 (Arun et al. 1987), never a reflection (Umeyama 1991). Where the
/// pairs leave it open (all on a line, or none), it is one of those that fit. Precondition: finite values.
Pose rigid_fit(const Eigen::Matrix3d& correlation, const Eigen::Vector3d& mean_a,
               const Eigen::Vector3d& mean_b);

/// The motion a_from_b with the least sum of squared distances between a's points and b's moved ones. Points
/// are the columns of both, as many and in the same order, at least one, finite.
template <typename PointsA, typename PointsB>
Pose rigid_fit(const Eigen::MatrixBase<PointsA>& a, const Eigen::MatrixBase<PointsB>& b) {
    const Eigen::Vector3d mean_a = a.rowwise().mean(), mean_b = b.rowwise().mean();
    return rigid_fit((a.colwise() - mean_a) * (b.colwise() - mean_b).transpose(), mean_a, mean_b);
}

}  // namespace planemap
