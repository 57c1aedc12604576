// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/geometry/plane.hpp"

namespace planemap {

/// The sums of a set of points up to second order. They are exact under merging and rigid motion, so a plane
/// fitted to merged moments is the plane fitted to all the points.
struct Moments {
    double count = 0;                                   ///< number of points
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();      ///< sum of p, metres
    Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< sum of p p^T about the origin, square metres

    void add(const Eigen::Vector3d& p) {
        count += 1;
        sum += p;
        scatter += p * p.transpose();
    }
    Moments& operator+=(const Moments& other) {
        count += other.count;
        sum += other.sum;
        scatter += other.scatter;
        return *this;
    }
    /// Mean of the points. Precondition: count > 0.
    Eigen::Vector3d mean() const { return sum / count; }
    /// Second central moments divided by the count. Precondition: count > 0.
    Eigen::Matrix3d covariance() const;
};

/// The moments of the same points in frame b.
Moments operator*(const Pose& b_from_a, const Moments& moments_a);

/// The total-least-squares plane of a set of points.
struct PlaneFit {
    Plane plane;
    double rms = 0;                                       ///< root mean square distance to the plane, metres
    Eigen::Vector3d variances = Eigen::Vector3d::Zero();  ///< eigenvalues of the covariance, ascending
    Eigen::Matrix3d axes =
        Eigen::Matrix3d::Identity();  ///< their eigenvectors as columns; column 0 is the normal
    /// False for fewer than three points, or points on a line: the plane is then not determined.
    bool valid = false;
};

/// Fits a plane; the normal is turned so that `viewpoint` lies on its positive side.
/// In a camera frame the viewpoint is the origin, which makes d > 0.
PlaneFit fit_plane(const Moments& moments, const Eigen::Vector3d& viewpoint = Eigen::Vector3d::Zero());

}  // namespace planemap
