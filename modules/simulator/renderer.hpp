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
    Image<std::int16_t> rectangle;  ///< index into World::rectangles; -1 where nothing is seen, or a mirror
    /// Of worlds with mirrors or glass only, else empty: the mirror that is looked into and the rectangle
    /// whose image it shows (`inverse_depth` is the image's), and the pane that is looked through; -1: none.
    Image<std::int16_t> mirror, mirrored, pane;

    /// Depth along the optical axis in metres; 0 where nothing is seen.
    float depth(int u, int v) const {
        const float inverse = inverse_depth(u, v);
        return inverse > 0 ? 1 / inverse : 0;
    }
};

/// Projects every rectangle; the nearest wins. A surface is seen from the side of its normal only, and no
/// nearer than 5 cm. At most 32767 rectangles. A mirror shows the world as seen from the other side, but no
/// panes, and other mirrors as if they were matt.
View render_view(const World& world, const PinholeCamera& camera, const Pose& world_from_camera);

/// The plane of rectangle i's surface as inverse depth over pixels: 1/z = a u + b v + c.
Eigen::Vector3d inverse_depth_plane(const Plane& plane_camera, const PinholeCamera& camera);

/// The camera's image in a mirror: what the mirror shows is seen from there. Improper: right is left.
Pose mirrored_camera(const Plane& mirror, const Pose& world_from_camera);

/// A colour image with four 16-bit lanes a pixel (r, b, g, unused, from the lowest bits), so that exposures
/// can be added up.
using LaneImage = Image<std::uint64_t>;

/// Adds the view's colours to `sum`, 0 to 255 a lane: texture (trilinear) times light times `exposure`. Glass
/// is not seen; a mirror is a little darker than what it shows.
void shade(const World& world, const View& view, double exposure, LaneImage& sum);

}  // namespace planemap::simulator
