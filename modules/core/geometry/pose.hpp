// SPDX-License-Identifier: BSD-3-Clause
// Rigid transforms. `b_from_a` maps coordinates of frame a to coordinates of frame b, so frames cancel by
// eye: p_world = world_from_camera * p_camera. Metres, radians.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace planemap {

/// A rigid transform; name variables `to_from_from`, e.g. world_from_camera.
using Pose = Eigen::Isometry3d;
/// Tangent of SE(3): translation first (metres), then rotation (radians).
using Twist = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// [v]x with [v]x w = v x w.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Exponential of SO(3): rotation vector (radians) to rotation matrix; exact near zero.
Eigen::Matrix3d so3_exp(const Eigen::Vector3d& rotation_vector);

/// Logarithm of SO(3): rotation vector with norm at most pi.
Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation);

/// The transform with translation twist.head<3>() and rotation so3_exp(twist.tail<3>()).
/// (The retraction the optimisers use, not the matrix exponential: translation is not coupled to rotation.)
Pose pose_from_twist(const Twist& twist);

/// Inverse of pose_from_twist().
Twist twist_from_pose(const Pose& pose);

/// pose_from_twist(twist) * p to second order in the rotation: for small motions, without trigonometry.
Eigen::Vector3d moved(const Twist& twist, const Eigen::Vector3d& p);

/// Rotation angle of a transform in radians, in [0, pi].
double rotation_angle(const Pose& pose);

/// A transform from translation and quaternion (w, x, y, z); the quaternion is normalised.
/// Precondition: finite values and a quaternion of non-zero norm, see is_valid_quaternion().
Pose make_pose(const Eigen::Vector3d& translation, const Eigen::Quaterniond& rotation);

/// True when all entries are finite and the rotation is orthonormal within 1e-6.
bool is_valid(const Pose& pose);

/// Brings the rotation back to orthonormal after a long product of transforms.
Pose orthonormalised(const Pose& pose);

/// a pose at a time: microseconds since the epoch, or since an arbitrary start for data without a clock.
struct StampedPose {
    std::int64_t utime = 0;
    Pose world_from_camera = Pose::Identity();
};

/// Interpolates translation linearly and rotation by slerp; fraction 0 gives a, 1 gives b (not clamped).
Pose interpolate(const Pose& a, const Pose& b, double fraction);

}  // namespace planemap
