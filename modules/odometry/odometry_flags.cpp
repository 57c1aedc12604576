// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odometry_shell.hpp"

namespace planemap::odometry {

void add_flags(Flags& flags, OdometryOptions& options, const std::string& prefix) {
    flags.section("Odometry", prefix);
    flags.add("method", options.method,
              "'planar': features tracked against keyframes, refined together with depth surfaces and "
              "planes. 'paper': planar feature points only, matched frame to frame (paper section 2)");
    flags.add("max-points", options.max_points, "corners tracked per keyframe");
    flags.add("cell-px", options.cell_px, "one corner at most in each square of this side");
    flags.add("corner-threshold", options.corner_threshold,
              "FAST threshold; a dim image is tried again at a third of it");
    flags.add("flow-window-px", options.flow_window_px, "Lucas-Kanade window");
    flags.add("flow-levels", options.flow_levels, "pyramid levels when the prediction is good");
    flags.add("flow-wide-levels", options.flow_wide_levels, "pyramid levels of the second chance");
    flags.add("flow-iterations", options.flow_iterations, "Lucas-Kanade steps a level");
    flags.add("pixel-sigma-px", options.pixel_sigma_px, "of a tracked feature");
    flags.add("depth-sigma-scale", options.depth_sigma_scale,
              "depth noise of a feature, in units of the sensor's noise model");
    flags.add("loss-scale", options.loss_scale,
              "sigmas at which the heavy-tailed loss halves a residual's weight");
    flags.add("inlier-sigmas", options.inlier_sigmas, "a feature with a larger residual is an outlier");
    flags.add("min-inliers", options.min_inliers, "fewer features, and the pose does not rest on features");
    flags.add("min-inlier-share", options.min_inlier_share, "of the tracked features");
    flags.add("surface-cell-px", options.surface_cell_px,
              "side of the depth cells a keyframe's surface is made of");
    flags.add("surface-stride-px", options.surface_stride_px, "spacing of the depth samples of a frame");
    flags.add("surface-gate-m", options.surface_gate_m,
              "samples further from the surface than this (and 3 sigma) are left out");
    flags.add("surface-weight", options.surface_weight,
              "information of one sample relative to an independent one");
    flags.add("plane-points", options.plane_points,
              "independent points that a plane seen again counts as, at most");
    flags.add("min-surface-share", options.min_surface_share,
              "of the samples, for a pose that rests on depth alone");
    flags.add("color-jitter-s", options.color_jitter_s, "sigma of the colour image's time against its stamp");
    flags.add("acceleration", options.acceleration,
              "of the camera, m/s^2: how far a pose may be from its prediction");
    flags.add("angular-acceleration", options.angular_acceleration, "of the camera, rad/s^2");
    flags.add("max-prediction-s", options.max_prediction_s,
              "the motion of the last frames is not carried on for longer");
    flags.add("min-tracked-share", options.min_tracked_share,
              "fewer of a keyframe's points tracked: a new keyframe");
    flags.add("max-translation-m", options.max_translation_m, "from the keyframe: a new keyframe");
    flags.add("max-rotation-rad", options.max_rotation_rad, "from the keyframe: a new keyframe");
    flags.add("local-keyframes", options.local_keyframes,
              "recent keyframes that tracking may return to; 0: never");
    flags.add("max-descriptors", options.max_descriptors, "features a keyframe hands to loop closure");
    flags.add("max-known-keyframes", options.max_known_keyframes, "keyframes kept for relocalisation");
    flags.add("relocalisation-tries", options.relocalisation_tries, "keyframes matched in one lost frame");
    flags.add("max-descriptor-distance", options.max_descriptor_distance,
              "bits in which matched descriptors may differ");
    flags.add("max-lost-frames", options.max_lost_frames,
              "then a new keyframe begins, without an edge to the others");
    flags.add("seed", options.seed, "of RANSAC");
}

}  // namespace planemap::odometry
