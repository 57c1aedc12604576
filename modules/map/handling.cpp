// SPDX-License-Identifier: BSD-3-Clause
#include "map/handling.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"

namespace planemap::map {

namespace {

constexpr std::size_t kPosesUsed = 64;
constexpr std::size_t kHeldUsed = 24;  ///< of these, for what costs more

// How cameras are held, before anything was seen of the room.
constexpr double kUsualPitch_deg = 20, kPitchSpread_deg = 30;   // downwards
constexpr double kFromAboveSpread_deg = 15, kFromAbove = 0.15;  // straight down: from a ceiling, a shelf
constexpr double kAnyPitch = 0.02, kRollSpread_deg = 15, kAnyRoll = 0.03;
// How much a camera must have turned (variance of a unit vector: 22 deg) and moved for that to count half.
constexpr double kTurned2 = 0.15 * 0.15, kMoved2_m2 = 0.25;
constexpr double kTurnedOdds = 4, kMovedOdds = 5;

double bell(double x, double sigma) {
    return std::exp(-0.5 * std::pow(x / sigma, 2));
}

/// Log odds that a camera is held so that this is up; unit, camera frame.
double held(const Eigen::Vector3d& up_camera) {
    const double down_deg = -degrees(std::asin(std::clamp(up_camera.z(), -1.0, 1.0)));
    const double pitch = bell(down_deg - kUsualPitch_deg, kPitchSpread_deg) +
                         kFromAbove * bell(down_deg - 90, kFromAboveSpread_deg) + kAnyPitch;
    // Of a camera that looks straight up or down, roll is none; from 30 deg off that it counts in full.
    const double rolls = std::min(1.0, 4 * up_camera.head<2>().squaredNorm());
    const double roll_deg = degrees(std::atan2(up_camera.x(), -up_camera.y()));
    return std::log(pitch) + rolls * std::log(bell(roll_deg, kRollSpread_deg) + kAnyRoll);
}

}  // namespace

std::optional<Handling> Handling::of(std::span<const Pose> world_from_camera) {
    Handling handling;
    Eigen::Vector3d origin = Eigen::Vector3d::Zero(), mean = origin;
    Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero(), squares = rotations;
    const std::size_t step = world_from_camera.size() / kPosesUsed + 1;
    for (std::size_t i = 0; i < world_from_camera.size(); i += step) {
        const Pose& pose = world_from_camera[i];
        if (!pose.matrix().allFinite()) continue;
        if (handling.camera_from_world_.empty()) origin = pose.translation();
        const Eigen::Vector3d p = pose.translation() - origin;
        handling.camera_from_world_.push_back(pose.linear().transpose());
        rotations += pose.linear();
        mean += p;
        squares += p * p.transpose();
    }
    if (handling.camera_from_world_.empty()) return std::nullopt;
    const auto count = static_cast<double>(handling.camera_from_world_.size());
    rotations /= count;
    mean /= count;
    handling.image_right_ = rotations.col(0);
    handling.image_down_ = rotations.col(1);
    handling.middle_ = origin + mean;
    handling.moved_ = squares / count - mean * mean.transpose();
    // The variance of R' u over the poses is 1 - |mean R' u|^2.
    handling.turned_ = Eigen::Matrix3d::Identity() - rotations * rotations.transpose();
    handling.most_turned_ =
        std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(handling.turned_, Eigen::EigenvaluesOnly)
                          .eigenvalues()[2]);
    return handling;
}

double Handling::log_held(const Eigen::Vector3d& up_world) const {
    const std::size_t step = camera_from_world_.size() / kHeldUsed + 1;
    double odds = 0, count = 0;
    for (std::size_t i = 0; i < camera_from_world_.size(); i += step) {
        odds += held(camera_from_world_[i] * up_world);
        count += 1;
    }
    return odds / count;
}

double Handling::log_turned(const Eigen::Vector3d& up_world) const {
    if (most_turned_ < 1e-9) return 0;
    const double turned = most_turned_ * most_turned_;
    return -kTurnedOdds * turned / (turned + kTurned2) * up_world.dot(turned_ * up_world) / most_turned_;
}

double Handling::log_moved(const Eigen::Vector3d& up_world) const {
    return -kMovedOdds * up_world.dot(moved_ * up_world) / (moved_.trace() + kMoved2_m2);
}

}  // namespace planemap::map
