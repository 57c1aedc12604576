// SPDX-License-Identifier: BSD-3-Clause
// Seeded random values for property tests.
#pragma once

#include <random>

#include "core/geometry/pose.hpp"

namespace planemap::test {

class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    double uniform(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine_);
    }
    int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
    double normal(double sigma) { return std::normal_distribution<double>(0.0, sigma)(engine_); }
    Eigen::Vector3d vector(double size) {
        return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
    }
    Eigen::Vector3d direction() {
        Eigen::Vector3d v;
        do v = vector(1.0);
        while (v.norm() < 0.1 || v.norm() > 1.0);
        return v.normalized();
    }
    /// A pose anywhere: translations up to `size` metres, any rotation.
    Pose pose(double size = 3.0, double angle = 3.0) {
        Twist twist;
        twist << vector(size), direction() * uniform(0.0, angle);
        return pose_from_twist(twist);
    }

  private:
    std::mt19937_64 engine_;
};

}  // namespace planemap::test
