// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "core/camera.hpp"

namespace planemap {

/// From the depth camera's pixels to the colour camera's. A reading of inverse depth w (1/metres) at pixel
/// p = (u, v, 1) has q = m p + t w; its colour pixel is (q.x, q.y) / q.z and its inverse depth along the
/// colour camera's axis w / q.z. It is in front of the colour camera when q.z > 0.
struct Reprojection {
    Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
    Eigen::Vector3d t = Eigen::Vector3d::Zero();

    explicit Reprojection(const CameraInfo& camera) {
        const PinholeCamera &from = camera.depth, &to = camera.color;
        Eigen::Matrix3d k_color, k_depth_inverse;
        k_color << to.fx, 0, to.cx, 0, to.fy, to.cy, 0, 0, 1;
        k_depth_inverse << 1 / from.fx, 0, -from.cx / from.fx, 0, 1 / from.fy, -from.cy / from.fy, 0, 0, 1;
        const Pose color_from_depth = camera.registered ? Pose::Identity() : camera.color_from_depth;
        m = k_color * color_from_depth.linear() * k_depth_inverse;
        t = k_color * color_from_depth.translation();
    }

    /// What a step of one depth pixel right (first column) and down is in colour pixels, for a far surface in
    /// the middle of the colour image.
    Eigen::Matrix2d steps(const PinholeCamera& color) const {
        const Eigen::Vector3d middle(0.5 * (color.width - 1), 0.5 * (color.height - 1), 1);
        const Eigen::Vector3d p = m.inverse() * middle;
        const Eigen::Matrix2d at_infinity =
            m.topLeftCorner<2, 2>() - middle.head<2>() * m.bottomLeftCorner<1, 2>();
        return at_infinity * p.z();  // q.z of p / p.z is 1 / p.z
    }
};

}  // namespace planemap
