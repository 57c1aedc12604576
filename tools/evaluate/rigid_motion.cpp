// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/rigid_motion.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace planemap {

Pose rigid_motion(const Eigen::Matrix3d& correlation, const Eigen::Vector3d& to_mean,
                  const Eigen::Vector3d& from_mean) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d signs = Eigen::Vector3d::Ones();
    if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
    Pose to_from_from = Pose::Identity();
    to_from_from.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    to_from_from.translation() = to_mean - to_from_from.linear() * from_mean;
    return to_from_from;
}

}  // namespace planemap
