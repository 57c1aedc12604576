// SPDX-License-Identifier: BSD-3-Clause
#include "messages/flags.hpp"
#include "odometry/odometry_shell.hpp"

namespace planemap {

void add_flags(CLI::App& app, OdometryOptions& options, const std::string& prefix) {
    FlagAdder add(app, prefix, "Odometry");
    add("method", options.method,
        "'planar': features tracked against keyframes, refined together with depth surfaces and planes. "
        "'paper': planar feature points only, matched frame to frame (paper section 2)");
    add("max-points", options.max_points, "corners tracked per keyframe");
    add("cell-px", options.cell_px, "one corner at most in each square of this side");
    add("corner-threshold", options.corner_threshold,
        "FAST threshold; a dim image is tried again at a third of it");
    add("flow-window-px", options.flow_window_px, "Lucas-Kanade window");
    add("flow-levels", options.flow_levels, "pyramid levels when the prediction is good");
    add("flow-wide-levels", options.flow_wide_levels, "pyramid levels of the second chance");
    add("flow-iterations", options.flow_iterations, "Lucas-Kanade steps a level");
    add("pixel-sigma-px", options.pixel_sigma_px, "of a tracked feature");
    add("depth-sigma-scale", options.depth_sigma_scale,
        "depth noise of a feature, in units of the sensor's noise model");
    add("loss-scale", options.loss_scale, "sigmas at which the heavy-tailed loss halves a residual's weight");
    add("inlier-sigmas", options.inlier_sigmas, "a feature with a larger residual is an outlier");
    add("min-inliers", options.min_inliers, "fewer features, and the pose does not rest on features");
    add("min-inlier-share", options.min_inlier_share, "of the tracked features");
    add("surface-cell-px", options.surface_cell_px,
        "side of the depth cells a keyframe's surface is made of");
    add("surface-stride-px", options.surface_stride_px, "spacing of the depth samples of a frame");
    add("surface-gate-m", options.surface_gate_m,
        "samples further from the surface than this (and 3 sigma) are left out");
    add("surface-weight", options.surface_weight, "information of one sample relative to an independent one");
    add("plane-points", options.plane_points,
        "independent points that a plane seen again counts as, at most");
    add("min-surface-share", options.min_surface_share,
        "of the samples, for a pose that rests on depth alone");
    add("color-jitter-s", options.color_jitter_s, "sigma of the colour image's time against its stamp");
    add("acceleration", options.acceleration,
        "of the camera, m/s^2: how far a pose may be from its prediction");
    add("angular-acceleration", options.angular_acceleration, "of the camera, rad/s^2");
    add("max-prediction-s", options.max_prediction_s,
        "the motion of the last frames is not carried on for longer");
    add("min-tracked-share", options.min_tracked_share,
        "fewer of a keyframe's points tracked: a new keyframe");
    add("max-translation-m", options.max_translation_m, "from the keyframe: a new keyframe");
    add("max-rotation-rad", options.max_rotation_rad, "from the keyframe: a new keyframe");
    add("local-keyframes", options.local_keyframes, "recent keyframes that tracking may return to; 0: never");
    add("max-descriptors", options.max_descriptors, "features a keyframe hands to loop closure");
    add("max-known-keyframes", options.max_known_keyframes, "keyframes kept for relocalisation");
    add("relocalisation-tries", options.relocalisation_tries, "keyframes matched in one lost frame");
    add("max-descriptor-distance", options.max_descriptor_distance,
        "bits in which matched descriptors may differ");
    add("max-lost-frames", options.max_lost_frames,
        "then a new keyframe begins, without an edge to the others");
    add("seed", options.seed, "of RANSAC");
}

}  // namespace planemap
