// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/depth_correction.hpp"

namespace planemap::test {

/// What a correction adds to the inverse depth at a pixel of the depth image, 1/metres.
inline double offset_at(const DepthCorrection& correction, const PinholeCamera& depth, double u, double v) {
    const FieldWeights field = field_weights(depth, u, v);
    double offset = 0;
    for (std::size_t i = 0; i < 4; ++i) offset += field.weights[i] * correction.offsets[field.nodes[i]];
    return offset;
}

}  // namespace planemap::test
