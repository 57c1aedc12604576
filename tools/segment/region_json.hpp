// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "segmentation/segmenter.hpp"

namespace planemap {

/// The regions of a segmentation as a JSON list; metres, depth camera's frame (x right, y down, z forward):
///   label    in the label image
///   normal   [x, y, z], unit, towards the camera; d: n.p + d = 0
///   pixels   that carry the label
///   rms_m    distance of the inliers to the plane
///   box      centre [x, y, z]; axes: the directions of the box's x (longest), y and z (the normal);
///            half_extents along them
///   moments  count (the paper's N), sum [x, y, z] and scatter (3 x 3, sum of p p^T about the origin) of the
///            inliers; with ransac these are the subsampled ones
///   outline  rings of points [x, y, z] on the plane: {"hole": bool, "points": [...]}; the surface is on the
///            left of a ring seen from the camera's side, so an outer ring is counter-clockwise and a hole
///            clockwise
nlohmann::ordered_json regions_json(const segmentation::Segmentation& segmentation);

}  // namespace planemap
