// SPDX-License-Identifier: BSD-3-Clause
// How a camera was held and moved, and what that says about up.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/geometry/pose.hpp"

namespace planemap::map {

/// What the poses of a camera say about which way is up.
class Handling {
  public:
    /// Nothing without a finite pose. Of a long trajectory some poses are taken, evenly.
    static std::optional<Handling> of(std::span<const Pose> world_from_camera);

    /// Logarithms of the odds for an up direction (unit, world), up to a constant, as find_up() says.
    static constexpr double kMostHeld = 0.2;  ///< log_held() is less
    double log_held(const Eigen::Vector3d& up_world) const;
    double log_turned(const Eigen::Vector3d& up_world) const;
    double log_moved(const Eigen::Vector3d& up_world) const;

    /// The mean of the image's y axis, and x axis, in the world; short where the camera turned about.
    const Eigen::Vector3d& image_down() const { return image_down_; }
    const Eigen::Vector3d& image_right() const { return image_right_; }
    /// Where the camera was on average, world.
    const Eigen::Vector3d& middle() const { return middle_; }

  private:
    std::vector<Eigen::Matrix3d> camera_from_world_;  ///< rotations
    Eigen::Vector3d image_down_ = Eigen::Vector3d::Zero(), image_right_ = Eigen::Vector3d::Zero();
    Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
    Eigen::Matrix3d turned_ = Eigen::Matrix3d::Zero();  ///< u' turned u: variance of u in the camera
    Eigen::Matrix3d moved_ = Eigen::Matrix3d::Zero();   ///< covariance of the positions, square metres
    double most_turned_ = 0;                            ///< the largest variance of any direction
};

}  // namespace planemap::map
