// SPDX-License-Identifier: BSD-3-Clause
// A segmentation as a picture for people.
#pragma once

#include "segmentation/segmenter.hpp"

namespace planemap {

/// The depth image shaded as if lit from the camera (black: no reading), each region in a colour of its own,
/// its outline projected to the image in white, and its label's number on it. Precondition: the label image
/// has the depth image's size.
RgbImage draw_overlay(const DepthImage& depth, const CameraInfo& camera,
                      const segmentation::Segmentation& segmentation);

}  // namespace planemap
