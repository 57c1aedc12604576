// SPDX-License-Identifier: BSD-3-Clause
// Described features of a frame laid on its planes, and matched with those of an earlier one.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/keyframe.hpp"
#include "odometry/options.hpp"
#include "odometry/prepared_frame.hpp"
#include "odometry/tracker.hpp"

namespace planemap::odometry {

/// Puts the features that lie on the frame's regions onto their planes (paper section 2.2), and says which.
void put_on_regions(std::vector<Feature>& features, const PreparedFrame& frame);

/// Matches of features that were seen before with the frame's, at most max_distance bits apart. ORB is
/// coarser than flow, in the image and in depth.
std::vector<PointTerm> match_terms(std::span<const Feature> seen, std::span<const Feature> here,
                                   const PreparedFrame& frame, int max_distance);

/// The pose from matches alone, from `initial` (camera_from_keyframe, the camera that saw the features
/// before); nothing when fewer than min_inliers fit it.
std::optional<Track> align_matches(const PinholeCamera& camera, std::span<const PointTerm> matches,
                                   const Pose& initial, int min_inliers);

}  // namespace planemap::odometry
