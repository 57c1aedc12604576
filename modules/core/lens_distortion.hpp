// SPDX-License-Identifier: BSD-3-Clause
// Where a lens draws what a pinhole would draw elsewhere: OpenCV's models (calib3d's main page and fisheye
// module), on image coordinates in focal lengths from the principal point.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "core/validation.hpp"

namespace planemap {

/// "brown" and "fisheye", as camera.json has them.
const char* name_of(LensDistortion::Model model);
/// Nothing for a name of none.
std::optional<LensDistortion::Model> distortion_model(const std::string& name);
/// How many coefficients the model may have.
const std::vector<std::size_t>& coefficient_counts(LensDistortion::Model model);

/// Where the lens draws what a pinhole draws at `ideal`. Precondition: as many coefficients as the model has.
Eigen::Vector2d distorted(const LensDistortion& lens, const Eigen::Vector2d& ideal);
/// The inverse, to 1e-9; nothing where the lens draws nothing, or no search finds it.
std::optional<Eigen::Vector2d> undistorted(const LensDistortion& lens, const Eigen::Vector2d& drawn);

/// The pixel of the image as it arrives that shows what the pinhole's image has at `pixel`; the same one
/// without a lens.
Eigen::Vector2d sensed_pixel(const PinholeCamera& camera, const std::optional<LensDistortion>& lens,
                             const Eigen::Vector2d& pixel);

/// Adds what is wrong with `field`: a count of coefficients that the model does not have, one that is not
/// finite, an image of a single row or column, or a place of the pinhole's image where the lens folds: there
/// it draws what is further out further in (a fit's polynomial gone astray), and no image can be undone.
void check_distortion(const LensDistortion& lens, const PinholeCamera& camera, const std::string& field,
                      FieldErrors& errors);

}  // namespace planemap
