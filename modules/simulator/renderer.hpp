// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/camera.hpp"
#include "simulator/world.hpp"

namespace planemap::simulator {

/// What each pixel of a camera sees, exact at the pixel's centre.
struct View {
    PinholeCamera camera;
    Pose world_from_camera = Pose::Identity();
    Image<float> inverse_depth;     ///< 1 / depth along the optical axis, 1/metre; 0 where nothing is seen
    Image<std::int16_t> rectangle;  ///< index into World::rectangles; -1 where nothing is seen

    /// Depth along the optical axis in metres; 0 where nothing is seen.
    float depth(int u, int v) const {
        const float inverse = inverse_depth(u, v);
        return inverse > 0 ? 1 / inverse : 0;
    }
};

/// Projects every rectangle; the nearest wins. A surface is seen from the side of its normal only, and no
/// nearer than 5 cm. At most 32767 rectangles.
View render_view(const World& world, const PinholeCamera& camera, const Pose& world_from_camera);

/// The plane of rectangle i's surface as inverse depth over pixels: 1/z = a u + b v + c.
Eigen::Vector3d inverse_depth_plane(const Plane& plane_camera, const PinholeCamera& camera);

/// A colour image with four 16-bit lanes a pixel (r, b, g, unused, from the lowest bits), so that exposures
/// can be added up.
using LaneImage = Image<std::uint64_t>;

/// Adds the view's colours to `sum`, 0 to 255 a lane: texture (trilinear) times light times `exposure`.
void shade(const World& world, const View& view, double exposure, LaneImage& sum);

}  // namespace planemap::simulator
