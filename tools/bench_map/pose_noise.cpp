// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/pose_noise.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "core/geometry/angle.hpp"

namespace planemap::bench_map {

namespace {

/// A smooth value about zero, RMS 1.
class Wave {
  public:
    explicit Wave(std::mt19937& random) {
        // Plain arithmetic on the engine's numbers: the library's distributions may differ between systems.
        const auto unit = [&] { return static_cast<double>(random()) / 4294967296.0; };
        for (Sine& sine : sines_) sine = {4 + 16 * unit(), 2 * std::numbers::pi * unit()};
    }
    double at(double t_s) const {
        double sum = 0;
        for (const Sine& sine : sines_)
            sum += std::sin(2 * std::numbers::pi * t_s / sine.period_s + sine.phase);
        return sum * std::sqrt(2.0 / static_cast<double>(sines_.size()));
    }

  private:
    struct Sine {
        double period_s = 1, phase = 0;
    };
    std::array<Sine, 3> sines_;
};

}  // namespace

Trajectory with_noise(Trajectory trajectory, const PoseNoise& noise, unsigned seed) {
    std::mt19937 random(seed);
    const std::array<Wave, 3> shift{Wave(random), Wave(random), Wave(random)};
    const std::array<Wave, 3> turn{Wave(random), Wave(random), Wave(random)};
    const auto at = [](const std::array<Wave, 3>& waves, double t_s) {
        return Eigen::Vector3d(waves[0].at(t_s), waves[1].at(t_s), waves[2].at(t_s));
    };
    for (StampedPose& pose : trajectory) {
        const double t_s = 1e-6 * static_cast<double>(pose.utime - trajectory.front().utime);
        const Eigen::Vector3d rotation = radians(noise.sigma_deg) * at(turn, t_s);
        const double angle = rotation.norm();
        const Eigen::Quaterniond q(angle > 0 ? Eigen::AngleAxisd(angle, rotation / angle)
                                             : Eigen::AngleAxisd::Identity());
        pose.world_from_camera = pose.world_from_camera * make_pose(noise.sigma_m * at(shift, t_s), q);
    }
    return trajectory;
}

}  // namespace planemap::bench_map
