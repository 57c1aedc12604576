// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simulator/renderer.hpp"

namespace planemap::simulator {

/// A lens that draws what is further from the principal point further out than a pinhole would: a point of
/// the image at radius r shows what belongs at r (1 - distortion (r / corner)^2), `corner` being the radius
/// of the image's furthest corner. 0: a pinhole.
class Lens {
  public:
    Lens(const PinholeCamera& camera, double distortion);

    bool is_pinhole() const { return distortion_ == 0; }
    /// Where a pinhole would draw what pixel (u, v) shows.
    Eigen::Vector2d ideal(double u, double v) const;
    /// A pinhole's view through this lens; depths are exact for each pixel's own ray.
    View distorted(const World& world, const View& pinhole) const;
    /// A pinhole's colours through this lens, bilinear.
    LaneImage distorted(const LaneImage& pinhole) const;

  private:
    PinholeCamera camera_;
    double distortion_, squared_corner_;
};

}  // namespace planemap::simulator
