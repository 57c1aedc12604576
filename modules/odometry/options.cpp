// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/options.hpp"

#include "core/validation.hpp"

namespace planemap::odometry {

void OdometryOptions::validate() const {
    FieldErrors errors("OdometryOptions");
    const auto in = [&](double value, double low, double high, const char* field) {
        errors.require(value >= low && value <= high, field, value,
                       std::to_string(low) + " to " + std::to_string(high));
    };
    errors.require(method == "planar" || method == "paper", "method", method, "planar or paper");
    in(max_points, 10, 5000, "max_points");
    in(cell_px, 4, 200, "cell_px");
    in(corner_threshold, 1, 200, "corner_threshold");
    in(max_depth_spread, 0.001, 1, "max_depth_spread");
    in(flow_window_px, 3, 51, "flow_window_px");
    in(flow_levels, 1, 10, "flow_levels");
    in(flow_wide_levels, flow_levels, 10, "flow_wide_levels");
    in(flow_iterations, 1, 100, "flow_iterations");
    in(pixel_sigma_px, 0.01, 20, "pixel_sigma_px");
    in(depth_sigma_scale, 0.01, 100, "depth_sigma_scale");
    in(loss_scale, 0.1, 100, "loss_scale");
    in(inlier_sigmas, 0.5, 100, "inlier_sigmas");
    in(min_inliers, 6, 1000, "min_inliers");
    in(min_inlier_share, 0, 1, "min_inlier_share");
    in(surface_cell_px, 4, 200, "surface_cell_px");
    in(surface_stride_px, 1, 200, "surface_stride_px");
    in(surface_gate_m, 0.001, 1, "surface_gate_m");
    in(surface_weight, 0, 1, "surface_weight");
    in(plane_points, 0, 1e6, "plane_points");
    in(min_surface_share, 0, 1, "min_surface_share");
    in(color_jitter_s, 1e-5, 1, "color_jitter_s");
    in(acceleration, 0.01, 1000, "acceleration");
    in(angular_acceleration, 0.01, 10000, "angular_acceleration");
    in(max_prediction_s, 0, 10, "max_prediction_s");
    in(min_tracked_share, 0, 1, "min_tracked_share");
    in(max_translation_m, 0.01, 10, "max_translation_m");
    in(max_rotation_rad, 0.01, 3, "max_rotation_rad");
    in(local_keyframes, 0, 1000, "local_keyframes");
    in(max_descriptors, 10, 10000, "max_descriptors");
    in(max_known_keyframes, 1, 100000, "max_known_keyframes");
    in(relocalisation_tries, 0, 1000, "relocalisation_tries");
    in(max_descriptor_distance, 1, 256, "max_descriptor_distance");
    in(max_lost_frames, 1, 1e6, "max_lost_frames");
    errors.throw_if_any();
}

}  // namespace planemap::odometry
