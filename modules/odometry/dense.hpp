// SPDX-License-Identifier: BSD-3-Clause
// Coarse whole-image alignment, for what blur and fast rotation leave of an image.
#pragma once

#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "odometry/alignment.hpp"
#include "odometry/flow.hpp"

namespace planemap::odometry {

/// Pixels of a coarse pyramid level with gradient and depth.
struct DenseLevel {
    int level = 0;                        ///< of the pyramid; a pixel is 2^level pixels of the image
    std::vector<Eigen::Vector3f> points;  ///< camera frame, metres
    std::vector<float> values;            ///< luma
};

/// A frame that later ones are aligned to, coarsest level first.
struct DenseReference {
    std::vector<DenseLevel> levels;
};

/// Levels 4 and 3 (or as coarse as the pyramid goes).
DenseReference make_dense_reference(const FlowPyramid& pyramid, const DepthImage& depth,
                                    const CameraInfo& camera);

/// Brightness differences of the reference's pixels in the image at camera_from_reference, their common
/// offset (exposure) taken out, as a cost in the camera's small motion. `at` is left to the caller.
QuadraticTerm photometric_term(const DenseLevel& reference, const FlowPyramid& pyramid,
                               const PinholeCamera& camera, const Pose& camera_from_reference);

}  // namespace planemap::odometry
