// SPDX-License-Identifier: BSD-3-Clause
#include "graph/residuals.hpp"

#include <cmath>
#include <numbers>

namespace planemap::graph {

namespace {

/// J with exp(w + x) = exp(w) exp(J x) for small x.
Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& w) {
    const double angle = w.norm();
    const Eigen::Matrix3d s = skew(w);
    if (angle < 1e-4) return Eigen::Matrix3d::Identity() - 0.5 * s + s * s / 6;
    return Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / (angle * angle) * s +
           (angle - std::sin(angle)) / (angle * angle * angle) * s * s;
}

}  // namespace

void Node::update() {
    const Eigen::Map<const Twist> x(change.data());
    rotation = start.linear() * so3_exp(x.tail<3>());
    translation = start.translation() + x.head<3>();
    turn = so3_right_jacobian(x.tail<3>());
}

Pose Node::pose() const {
    Pose pose = Pose::Identity();
    pose.linear() = rotation;
    pose.translation() = translation;
    return orthonormalised(pose);
}

PlaneNode::PlaneNode(const Landmark& landmark)
    : point(landmark.plane.project(landmark.box.frame_from_box.translation())),
      normal(landmark.plane.normal) {
    const Eigen::Matrix3d axes = plane_axes(normal, landmark.box.frame_from_box.linear().col(0));
    u = axes.col(0);
    v = axes.col(1);
}

Plane PlaneNode::plane() const {
    const Eigen::Vector3d n = (normal + change[0] * u + change[1] * v).normalized();
    return {n, -n.dot(point) - change[2]};
}

Eigen::Matrix<double, 3, 2> PlaneNode::normal_jacobian() const {
    const Eigen::Vector3d sum = normal + change[0] * u + change[1] * v;
    const Eigen::Vector3d n = sum.normalized();
    Eigen::Matrix<double, 3, 2> jacobian;
    jacobian << u - n * n.dot(u), v - n * n.dot(v);
    return jacobian / sum.norm();
}

RawError::RawError(const Pose& measured, const Eigen::Matrix3d& r_from, const Eigen::Vector3d& t_from,
                   const Eigen::Matrix3d& r_to, const Eigen::Vector3d& t_to)
    : offset(r_from.transpose() * (t_to - t_from)),
      from_from_to(r_from.transpose() * r_to),
      q(Eigen::Matrix3d(measured.linear().transpose() * from_from_to)) {
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    error << measured.linear().transpose() * (offset - measured.translation()), 2 * q.vec();
}

bool EdgeCost::Evaluate(double const* const* /*changes*/, double* residuals, double** jacobians) const {
    const RawError raw(edge_.from_from_to, from_.rotation, from_.translation, to_.rotation, to_.translation);
    Eigen::Map<Twist>{residuals} = edge_.sqrt_information * raw.error;
    if (jacobians == nullptr) return true;
    const Eigen::Matrix3d to_measured = edge_.from_from_to.linear().transpose();
    const Eigen::Matrix3d by_world = to_measured * from_.rotation.transpose();
    const Eigen::Matrix3d by_turn = raw.q.w() * Eigen::Matrix3d::Identity() + skew(raw.q.vec());
    using Jacobian = Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>;
    Matrix6d jacobian = Matrix6d::Zero();
    if (jacobians[0] != nullptr) {
        jacobian.topLeftCorner<3, 3>() = -by_world;
        jacobian.topRightCorner<3, 3>() = to_measured * skew(raw.offset) * from_.turn;
        jacobian.bottomRightCorner<3, 3>() = -by_turn * raw.from_from_to.transpose() * from_.turn;
        Jacobian{jacobians[0]} = edge_.sqrt_information * jacobian;
    }
    if (jacobians[1] != nullptr) {
        jacobian.topLeftCorner<3, 3>() = by_world;
        jacobian.topRightCorner<3, 3>().setZero();
        jacobian.bottomRightCorner<3, 3>() = by_turn * to_.turn;
        Jacobian{jacobians[1]} = edge_.sqrt_information * jacobian;
    }
    return true;
}

SightingTerms::SightingTerms(const Sighting& sighting) : weight(2 * sighting.sqrt_weight) {
    constexpr double kHalf = 0.5, kAxis = std::numbers::sqrt2 / 2;
    by_point << kHalf, kAxis, 0,  //
        kHalf, 0, kAxis,          //
        kHalf, -kAxis, 0,         //
        kHalf, 0, -kAxis;
    by_point *= sighting.sqrt_weight;
    terms.setZero();
    for (int i = 0; i < 4; ++i)
        terms += sighting.points_camera[static_cast<std::size_t>(i)] * by_point.row(i);
}

void evaluate_sighting(const Eigen::Matrix3d& terms, double weight, const Node& node,
                       const PlaneNode& plane_node, double* residuals, double* by_node, double* by_plane) {
    const Plane plane = plane_node.plane();
    const Eigen::Vector3d normal_camera = node.rotation.transpose() * plane.normal;
    Eigen::Map<Eigen::Vector3d> error(residuals);
    error = terms.transpose() * normal_camera;
    error[0] += weight * (plane.normal.dot(node.translation) + plane.d);
    if (by_node != nullptr) {
        Eigen::Map<Eigen::Matrix<double, 3, 6, Eigen::RowMajor>> jacobian(by_node);
        jacobian.setZero();
        jacobian.topLeftCorner<1, 3>() = weight * plane.normal.transpose();
        for (int i = 0; i < 3; ++i)
            jacobian.block<1, 3>(i, 3) = terms.col(i).cross(normal_camera).transpose() * node.turn;
    }
    if (by_plane != nullptr) {
        Eigen::Map<Eigen::Matrix3d> transposed(by_plane);
        Eigen::Matrix3d points_world = node.rotation * terms;
        points_world.col(0) += weight * (node.translation - plane_node.point);
        transposed.topRows<2>() = plane_node.normal_jacobian().transpose() * points_world;
        transposed.row(2) << -weight, 0, 0;
    }
}

bool SightingCost::Evaluate(double const* const* /*changes*/, double* residuals, double** jacobians) const {
    evaluate_sighting(sighting_.terms, sighting_.weight, node_, plane_, residuals,
                      jacobians == nullptr ? nullptr : jacobians[0],
                      jacobians == nullptr ? nullptr : jacobians[1]);
    return true;
}

void UpdateNodes::PrepareForEvaluation(bool /*jacobians*/, bool moved) {
    if (!moved) return;
    for (Node& node : nodes_) node.update();
}

}  // namespace planemap::graph
