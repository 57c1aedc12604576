// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/pose.hpp"

#include <cmath>

namespace planemap {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
    Eigen::Matrix3d m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& rotation_vector) {
    const double angle = rotation_vector.norm();
    if (angle < 1e-8) {
        const Eigen::Matrix3d k = skew(rotation_vector);
        return Eigen::Matrix3d::Identity() + k + 0.5 * k * k;
    }
    return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation) {
    Eigen::Quaterniond q(rotation);
    q.normalize();
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    const double sine = q.vec().norm();
    if (sine < 1e-9) return 2.0 * q.vec();
    return q.vec() * (2.0 * std::atan2(sine, q.w()) / sine);
}

Pose pose_from_twist(const Twist& twist) {
    Pose pose = Pose::Identity();
    pose.linear() = so3_exp(twist.tail<3>());
    pose.translation() = twist.head<3>();
    return pose;
}

Twist twist_from_pose(const Pose& pose) {
    Twist twist;
    twist.head<3>() = pose.translation();
    twist.tail<3>() = so3_log(pose.linear());
    return twist;
}

Eigen::Vector3d moved(const Twist& twist, const Eigen::Vector3d& p) {
    const Eigen::Vector3d rotation = twist.tail<3>(), turn = rotation.cross(p);
    return p + twist.head<3>() + turn + 0.5 * rotation.cross(turn);
}

double rotation_angle(const Pose& pose) {
    return so3_log(pose.linear()).norm();
}

Pose make_pose(const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation) {
    Pose pose = Pose::Identity();
    pose.linear() = rotation.normalized().toRotationMatrix();
    pose.translation() = translation;
    return pose;
}

bool is_valid(const Pose& pose) {
    if (!pose.matrix().allFinite()) return false;
    const Eigen::Matrix3d r = pose.linear();
    return (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-6 &&
           r.determinant() > 0;
}

Pose orthonormalised(const Pose& pose) {
    return make_pose(pose.translation(), Eigen::Quaterniond(pose.linear()));
}

Pose interpolate(const Pose& a, const Pose& b, double fraction) {
    const Eigen::Vector3d step = so3_log(a.linear().transpose() * b.linear());
    Pose pose = Pose::Identity();
    pose.linear() = a.linear() * so3_exp(fraction * step);
    pose.translation() = a.translation() + fraction * (b.translation() - a.translation());
    return pose;
}

}  // namespace planemap
