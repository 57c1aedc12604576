// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "simulator/renderer.hpp"

namespace planemap::simulator {

/// What a camera's lens does to a pinhole's view.
class Lens {
  public:
    /// A lens that draws what is further from the principal point further out than a pinhole would: a point
    /// of the image at radius r shows what belongs at r (1 - distortion (r / corner)^2), `corner` being the
    /// radius of the image's furthest corner. 0: a pinhole.
    Lens(const PinholeCamera& camera, double distortion);
    /// One of OpenCV's models. Throws std::invalid_argument for one that check_distortion() refuses, and for
    /// one that sees too wide for a pinhole's view to be drawn.
    Lens(const PinholeCamera& camera, const LensDistortion& model);

    bool is_pinhole() const { return places_.empty(); }
    /// The pinhole whose view distorted() takes: the camera, wider where the lens sees beyond its image.
    const PinholeCamera& pinhole() const { return pinhole_; }
    /// Where the pinhole draws what pixel (u, v) shows, in pixels of the camera; NaN where it shows nothing.
    Eigen::Vector2d ideal(int u, int v) const;
    /// The pinhole's view through this lens; depths are exact for each pixel's own ray.
    View distorted(const World& world, const View& pinhole) const;
    /// The pinhole's colours through this lens, bilinear.
    LaneImage distorted(const LaneImage& pinhole) const;

  private:
    void widen();

    PinholeCamera camera_, pinhole_;
    Image<Eigen::Vector2d> places_;  ///< by pixel, where the pinhole draws it, in its pixels; empty: there
};

/// "MODEL:c1,c2,...", as brown:-0.3,0.1,0,0. Throws std::invalid_argument.
LensDistortion parse_lens(const std::string& text);

}  // namespace planemap::simulator
