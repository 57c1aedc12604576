// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/alignment.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace planemap {
namespace {

constexpr double kNearest = 0.05;  // metres; nothing nearer to the camera is measured

using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Vector7d = Eigen::Matrix<double, 7, 1>;

/// Normal equations in (x, time offset).
struct Normal {
    Matrix7d information = Matrix7d::Zero();
    Vector7d gradient = Vector7d::Zero();
};

double heavy_tail_weight(double squared_sigmas, double scale) {
    return 1 / (1 + squared_sigmas / (scale * scale));
}

/// Adds one scalar residual; its derivative by the time offset is row * velocity.
void add_row(const Eigen::Matrix<double, 1, 6>& row, double time_derivative, double residual, double weight,
             Normal& normal) {
    Vector7d j;
    j << row.transpose(), time_derivative;
    normal.information.noalias() += (weight * j) * j.transpose();
    normal.gradient.noalias() += (weight * residual) * j;
}

void add_points(const Alignment& a, const Pose& camera_from_keyframe, double offset, Normal& normal) {
    const Pose color_from_keyframe = pose_from_twist(offset * a.velocity) * camera_from_keyframe;
    for (const PointTerm& term : a.points) {
        Eigen::Vector3d r, r_depth;
        Eigen::Matrix<double, 3, 6> j, j_depth;
        if (!point_residual(a.camera, term, color_from_keyframe, r, &j) ||
            !point_residual(a.camera, term, camera_from_keyframe, r_depth, &j_depth))
            continue;
        const double weight = heavy_tail_weight(r.head<2>().squaredNorm(), a.loss_scale);
        add_row(j.row(0), j.row(0).dot(a.velocity), r.x(), weight, normal);
        add_row(j.row(1), j.row(1).dot(a.velocity), r.y(), weight, normal);
        if (term.inverse_depth > 0)
            add_row(j_depth.row(2), 0, r_depth.z(),
                    heavy_tail_weight(r_depth.z() * r_depth.z(), a.loss_scale), normal);
    }
}

void add_quadratics(const Alignment& a, const Pose& camera_from_keyframe, Normal& normal) {
    for (const QuadraticTerm& term : a.quadratics) {
        const Twist x = twist_from_pose(camera_from_keyframe * term.at.inverse());
        normal.information.topLeftCorner<6, 6>() += term.information;
        normal.gradient.head<6>() += term.gradient + term.information * x;
    }
}

void mark_inliers(const Alignment& a, AlignmentResult& result) {
    const Pose color_from_keyframe =
        pose_from_twist(result.color_offset_s * a.velocity) * result.camera_from_keyframe;
    double squared_px = 0;
    result.inlier.assign(a.points.size(), 0);
    for (std::size_t i = 0; i < a.points.size(); ++i) {
        Eigen::Vector3d r, r_depth;
        if (!point_residual(a.camera, a.points[i], color_from_keyframe, r) ||
            !point_residual(a.camera, a.points[i], result.camera_from_keyframe, r_depth))
            continue;
        if (!(r.head<2>().norm() < a.inlier_sigmas && std::abs(r_depth.z()) < 2 * a.inlier_sigmas)) continue;
        result.inlier[i] = 1;
        ++result.inliers;
        squared_px += r.head<2>().squaredNorm() * a.points[i].pixel_sigma * a.points[i].pixel_sigma;
    }
    if (result.inliers > 0) result.residual_px = std::sqrt(squared_px / result.inliers);
}

}  // namespace

bool point_residual(const PinholeCamera& camera, const PointTerm& term, const Pose& camera_from_keyframe,
                    Eigen::Vector3d& residual, Eigen::Matrix<double, 3, 6>* jacobian) {
    const Eigen::Vector3d p = camera_from_keyframe * term.point;
    if (!(p.z() > kNearest)) return false;
    const double inverse = 1 / p.z(), x = p.x() * inverse, y = p.y() * inverse;
    const double u_scale = camera.fx / term.pixel_sigma, v_scale = camera.fy / term.pixel_sigma;
    residual.x() = (camera.fx * x + camera.cx - term.pixel.x()) / term.pixel_sigma;
    residual.y() = (camera.fy * y + camera.cy - term.pixel.y()) / term.pixel_sigma;
    const bool has_depth = term.inverse_depth > 0;
    residual.z() = has_depth ? (inverse - term.inverse_depth) / term.inverse_depth_sigma : 0;
    if (jacobian) {
        const double w_scale = has_depth ? -inverse / term.inverse_depth_sigma : 0;
        jacobian->row(0) << u_scale * inverse, 0, -u_scale * x * inverse, -u_scale * x * y,
            u_scale * (1 + x * x), -u_scale * y;
        jacobian->row(1) << 0, v_scale * inverse, -v_scale * y * inverse, -v_scale * (1 + y * y),
            v_scale * x * y, v_scale * x;
        jacobian->row(2) << 0, 0, w_scale * inverse, w_scale * y, -w_scale * x, 0;
    }
    return true;
}

AlignmentResult align(const Alignment& a, const Pose& initial, int max_iterations) {
    AlignmentResult result;
    result.camera_from_keyframe = initial;
    result.color_offset_s = a.color_offset_s;
    const double offset_information = 1 / (a.color_offset_sigma_s * a.color_offset_sigma_s);
    Normal normal;
    for (int i = 0; i < max_iterations && !result.converged; ++i) {
        normal = Normal{};
        add_points(a, result.camera_from_keyframe, result.color_offset_s, normal);
        add_quadratics(a, result.camera_from_keyframe, normal);
        normal.information(6, 6) += offset_information;
        normal.gradient(6) += offset_information * (result.color_offset_s - a.color_offset_s);
        const Eigen::LDLT<Matrix7d> solver(normal.information);
        const Vector7d step = -solver.solve(normal.gradient);
        if (!step.allFinite()) return result;
        result.camera_from_keyframe = pose_from_twist(step.head<6>()) * result.camera_from_keyframe;
        result.color_offset_s += step(6);
        result.converged = step.head<6>().norm() < 1e-4;
    }
    result.camera_from_keyframe = orthonormalised(result.camera_from_keyframe);
    // The time offset is marginalised out.
    result.information = normal.information.topLeftCorner<6, 6>();
    if (normal.information(6, 6) > 0) {
        const Twist coupling = normal.information.topRightCorner<6, 1>();
        result.information -= coupling * coupling.transpose() / normal.information(6, 6);
    }
    mark_inliers(a, result);
    return result;
}

}  // namespace planemap
