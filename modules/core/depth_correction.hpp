// SPDX-License-Identifier: BSD-3-Clause
// What a depth sensor's readings are off by, smoothly over the image, and growing with the square of the
// range.
#pragma once

#include <array>
#include <cstddef>

#include "core/camera.hpp"
#include "core/image.hpp"

namespace planemap {

/// Weights of the four nodes around a place in the image; they add up to 1.
struct FieldWeights {
    std::array<std::size_t, 4> nodes{};
    std::array<double, 4> weights{};
};

/// The nodes around pixel (u, v) of the depth image; outside of it, of the nearest place in it.
FieldWeights field_weights(const PinholeCamera& depth, double u, double v);

/// The nodes around the reading that a pixel of the pinhole's image has: nodes lie in the image as it
/// arrives, as the lens draws it.
FieldWeights field_weights(const CameraInfo& sensed, double u, double v);

/// What both together correct: inverse depths add up. The certainty is the second one's, which was learnt
/// with the first one in place.
DepthCorrection composed(const DepthCorrection& first, const DepthCorrection& second);

/// Corrects the readings of a depth image, raw units of `camera`, by its correction; nothing without one.
/// What leaves 1 to 65534 is no reading any more.
void correct_depth(DepthImage& depth, const CameraInfo& camera);

}  // namespace planemap
