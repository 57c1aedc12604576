// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/rigid_fit.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace planemap {

Pose rigid_fit(const Eigen::Matrix3d& correlation, const Eigen::Vector3d& mean_a,
               const Eigen::Vector3d& mean_b) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    Pose a_from_b = Pose::Identity();
    a_from_b.linear() = svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
    a_from_b.translation() = mean_a - a_from_b.linear() * mean_b;
    return a_from_b;
}

}  // namespace planemap
