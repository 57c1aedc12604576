// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/moments.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace planemap {

Eigen::Matrix3d Moments::covariance() const {
    const Eigen::Vector3d m = mean();
    return scatter / count - m * m.transpose();
}

Moments operator*(const Pose& b_from_a, const Moments& moments_a) {
    const Eigen::Matrix3d r = b_from_a.linear();
    const Eigen::Vector3d t = b_from_a.translation();
    const Eigen::Vector3d rotated_sum = r * moments_a.sum;
    Moments b;
    b.count = moments_a.count;
    b.sum = rotated_sum + moments_a.count * t;
    b.scatter = r * moments_a.scatter * r.transpose() + rotated_sum * t.transpose() +
                t * rotated_sum.transpose() + moments_a.count * t * t.transpose();
    return b;
}

PlaneFit fit_plane(const Moments& moments, const Eigen::Vector3d& viewpoint) {
    PlaneFit fit;
    if (moments.count < 3) return fit;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments.covariance());
    if (solver.info() != Eigen::Success) return fit;
    fit.variances = solver.eigenvalues().cwiseMax(0.0);
    fit.axes = solver.eigenvectors();
    fit.plane.normal = fit.axes.col(0).normalized();
    fit.plane.d = -fit.plane.normal.dot(moments.mean());
    if (fit.plane.signed_distance(viewpoint) < 0) fit.plane = fit.plane.flipped();
    fit.rms = std::sqrt(fit.variances[0]);
    fit.valid = std::isfinite(fit.plane.d) && fit.variances[1] > 1e-12 * std::max(1.0, fit.variances[2]) &&
                fit.variances[1] > fit.variances[0];
    return fit;
}

}  // namespace planemap
