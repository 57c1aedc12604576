// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/camera.hpp"

namespace planemap::convert {

/// What others say of a lens. Of a model that is not ours `note` says why it is not used, to follow the name
/// of what said it; else it is empty.
struct SaidLens {
    std::optional<LensDistortion> lens;  ///< none: a pinhole, or not used
    std::string note;
};

/// By the name that ROS (plumb_bob, rational_polynomial, equidistant), RealSense's SDK (Brown Conrady,
/// Kannala Brandt4) or Azure Kinect's (CALIBRATION_LensDistortionModelBrownConrady) has for the model;
/// without a name brown. Coefficients of zero are a pinhole, whatever the model.
SaidLens lens_of(const std::string& model, std::vector<double> coefficients);

}  // namespace planemap::convert
