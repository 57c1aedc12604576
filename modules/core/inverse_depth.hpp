// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/camera.hpp"
#include "core/image.hpp"

namespace planemap {

/// Standard deviation of a reading's inverse depth w (1/metres), rounding to raw units added.
struct InverseDepthNoise {
    float base, quadratic, offset, unit;

    explicit InverseDepthNoise(const CameraInfo& camera)
        : base(static_cast<float>(camera.noise.base_m)),
          quadratic(static_cast<float>(camera.noise.quadratic_per_m)),
          offset(static_cast<float>(camera.noise.offset_m)),
          unit(static_cast<float>(0.5 / camera.depth_units_per_metre)) {}

    /// sigma(z) of depth is sigma(z) / z^2 of inverse depth w = 1 / z.
    float sigma(float w) const {
        const float off = 1 - offset * w;
        return (base + unit) * w * w + quadratic * off * off;
    }
};

/// A depth image as inverse depth, in which every plane is linear, and how each reading's surface slopes.
/// All images have a border without readings around the depth image's.
struct InverseDepth {
    int border = 2;
    Image<float> value;    ///< 1 / metres; 0: no reading
    Image<float> along_u;  ///< change of the value a pixel to the right, on the reading's own surface
    Image<float> along_v;  ///< change a pixel down

    /// Slopes are taken between readings `reach` pixels apart: further is less noise, and less of small
    /// things.
    InverseDepth(const DepthImage& depth, double units_per_metre, int reach = 1);
};

/// Whether neighbouring readings lie on one surface: both, carried on by their slopes, agree halfway between
/// them within the noise.
struct Joints {
    Image<std::uint8_t> right, below;  ///< with the pixel there; same layout as InverseDepth

    Joints(const InverseDepth& depth, const CameraInfo& camera);
};

}  // namespace planemap
