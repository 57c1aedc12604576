// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/motion_filter.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::odometry {
namespace {

constexpr double kLeastLogIndex = -3, kMostLogIndex = 4;  // alpha 0.2 to 1
constexpr double kLearning = 0.1;  // change of the log index for innovations that all point one way
constexpr double kMemory = 0.05;   // share of the newest innovation in the mean square
constexpr int kSettled = 3;        // updates before which the velocity is still being found

}  // namespace

double MotionFilter::Part::alpha() const {
    const double index = std::exp(log_index);
    const double r = (4 + index - std::sqrt(8 * index + index * index)) / 4;
    return 1 - r * r;
}

double MotionFilter::Part::beta() const {
    const double a = alpha();
    return 2 * (2 - a) - 4 * std::sqrt(1 - a);
}

void MotionFilter::Part::learn(const Eigen::Vector3d& innovation) {
    const double square = innovation.squaredNorm();
    mean_square =
        mean_square > 0 ? (1 - kMemory) * mean_square + kMemory * std::min(square, 9 * mean_square) : square;
    if (mean_square > 0) {
        const double correlation = std::clamp(innovation.dot(last) / mean_square, -1.0, 1.0);
        log_index = std::clamp(log_index + kLearning * correlation, kLeastLogIndex, kMostLogIndex);
    }
    last = innovation;
}

void MotionFilter::start(const Pose& odom_from_camera) {
    odom_from_camera_ = odom_from_camera;
    velocity_.setZero();
    updates_ = 0;
    translation_.last.setZero();
    rotation_.last.setZero();
}

Twist MotionFilter::velocity_gain(double elapsed_s) const {
    Twist gain;
    const bool is_settled = updates_ >= kSettled;
    const double t = is_settled ? translation_.beta() : 1, r = is_settled ? rotation_.beta() : 1;
    gain << Eigen::Vector3d::Constant(t / elapsed_s), Eigen::Vector3d::Constant(r / elapsed_s);
    return gain;
}

Twist MotionFilter::jitter() const {
    const double t = translation_.alpha(), r = rotation_.alpha();
    Twist shares;
    shares << Eigen::Vector3d::Constant(t * (1 - t)), Eigen::Vector3d::Constant(1 - r);
    return shares.cwiseProduct(surprise());
}

Twist MotionFilter::surprise() const {
    Twist variances;
    variances << Eigen::Vector3d::Constant(translation_.mean_square / 3),
        Eigen::Vector3d::Constant(rotation_.mean_square / 3);
    return variances;
}

Pose MotionFilter::update(const Pose& odom_from_camera, double elapsed_s) {
    const Pose camera_from_odom = odom_from_camera.inverse();
    if (elapsed_s > longest_step_s_) {
        velocity_ = twist_from_pose(camera_from_odom * odom_from_camera_) / elapsed_s;
        odom_from_camera_ = odom_from_camera;
        updates_ = 0;
        return odom_from_camera_;
    }
    const Pose predicted = pose_from_twist(elapsed_s * velocity_) * odom_from_camera_.inverse();
    const Twist innovation = twist_from_pose(camera_from_odom * predicted.inverse());
    velocity_ += velocity_gain(elapsed_s).cwiseProduct(innovation);
    Twist kept = innovation;
    if (updates_ >= kSettled) {
        kept.head<3>() *= translation_.alpha();
        translation_.learn(innovation.head<3>());
        rotation_.learn(innovation.tail<3>());
    }
    ++updates_;
    odom_from_camera_ = orthonormalised((pose_from_twist(kept) * predicted).inverse());
    return odom_from_camera_;
}

}  // namespace planemap::odometry
