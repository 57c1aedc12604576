// SPDX-License-Identifier: BSD-3-Clause
// The part of a sensor's error that does not average out.
#pragma once

#include <cstdint>

#include "simulator/renderer.hpp"
#include "simulator/sensor_profile.hpp"

namespace planemap::simulator {

/// The bent depth of one specimen: a smooth field over the image, the same in every frame. By triangulation a
/// reading's inverse depth is off by the field, so that its error grows with the square of the range, as
/// Teichman, Miller and Thrun (RSS 2013) found it for the Kinect and the Xtion; by flight its depth is off by
/// a share, and, of phases, by a wave along the range.
class DepthBias {
  public:
    /// `relative_at_4m`: root mean square over the image of the error at 4 m as a share of 4 m.
    DepthBias(Principle principle, double relative_at_4m, const PinholeCamera& camera,
              std::uint64_t specimen);

    /// Depth that the specimen takes `depth_m` at pixel (u, v) for, without noise.
    double read(int u, int v, double depth_m) const;
    /// The same for a whole view.
    void apply(View& view) const;

  private:
    float biased(float inverse, float field) const;

    Principle principle_;
    Image<float> field_;    ///< relative error at 4 m
    float wave_m_, phase_;  ///< of phase measurement: amplitude, phase at range 0
};

/// Range after which phases of light that is modulated at 200 MHz repeat, metres.
inline constexpr double kPhaseRange_m = 0.75;

/// Adds to a view of matt surfaces what light does that comes to a surface over another one: it takes longer,
/// and corners are read too deep (Lambertian surfaces that scatter 60 %, one bounce; phases add as vectors).
/// `strength` scales that light.
void add_multipath(const World& world, View& view, double strength);

}  // namespace planemap::simulator
