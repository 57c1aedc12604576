// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/options.hpp"

namespace planemap::odometry {

OptionList options_of(MotionPriorOptions& options) {
    using enum Audience;
    OptionList list("Motion prior");
    list.add(
        "motion_channel", options.channel, std::vector<std::string>{},
        "Channel of bot_core.pose_t on which wheel odometry or an IMU says how the robot's body moves: it "
        "fills the directions that the camera does not see. Needs body_from_camera in camera.json");
    list.add("motion_way_sigma", options.sigma_m_per_m, {0, 10},
             "Standard deviation of the motion channel's ways, as a share of the way", kExpert);
    list.add("motion_turn_sigma", options.sigma_rad_per_rad, {0, 10},
             "Standard deviation of the motion channel's turns, as a share of the turn", kExpert);
    list.add("motion_max_age", options.max_age_s, {0.001, 10, "s"},
             "A frame that is longer after the motion channel's last pose, or between two of its poses that "
             "are further apart, goes without a prior",
             kExpert);
    return list;
}

OptionList options_of(OdometryOptions& options) {
    using enum Audience;
    OptionList list("Odometry");
    list.add("method", options.method, {"planar", "paper"},
             "'planar' tracks features against keyframes, refined together with depth surfaces and planes; "
             "'paper' matches planar feature points only, frame to frame (paper section 2)");
    list.add("max_points", options.max_points, {10, 5000}, "Corners that are tracked from a keyframe");
    list.add("cell_px", options.cell_px, {4, 200},
             "Side of the squares of the image in which at most one corner is tracked", kExpert);
    list.add("corner_threshold", options.corner_threshold, {1, 200},
             "Least contrast of a corner (FAST, of 255 levels); a dim image is tried again at a third of it",
             kExpert);
    list.add("pixel_sigma_px", options.pixel_sigma_px, {0.01, 20},
             "Standard deviation of where a feature is tracked to", kExpert);
    list.add("min_inliers", options.min_inliers, {6, 1000},
             "With fewer features that agree, a pose does not rest on features", kExpert);
    list.add("color_jitter_s", options.color_jitter_s, {1e-5, 1},
             "Standard deviation of when the colour image was taken, against its stamp", kExpert);
    list.add("acceleration", options.acceleration, {0.01, 1000, "m/s^2"},
             "Of the camera: bounds how far a pose may be from where the motion so far leads", kExpert);
    list.add("angular_acceleration", options.angular_acceleration, {0.01, 10000, "rad/s^2"},
             "Of the camera: bounds how far a pose may be turned from where the motion so far leads",
             kExpert);
    list.add("min_tracked_share", options.min_tracked_share, kShare,
             "A new keyframe begins when a smaller share of the keyframe's points is tracked", kExpert);
    list.add("max_translation_m", options.max_translation_m, {0.01, 10},
             "A new keyframe begins when the camera is further from the last one");
    list.add("max_rotation_rad", options.max_rotation_rad, {0.01, 3},
             "A new keyframe begins when the camera is turned further from the last one");
    list.add("local_keyframes", options.local_keyframes, {0, 1000},
             "Recent keyframes that tracking may return to; 0: never", kExpert);
    list.add("max_descriptors", options.max_descriptors, {10, 10000},
             "Features that a keyframe hands to loop closure", kExpert);
    list.add("max_known_keyframes", options.max_known_keyframes, {1, 100000},
             "Keyframes that are kept to find the way again after a loss", kExpert);
    list.add(
        "relocalisation_tries", options.relocalisation_tries, {0, 1000},
        "Known keyframes that a lost frame is matched with; 0: a lost camera does not find its way again",
        kExpert);
    list.add("max_lost_frames", options.max_lost_frames, {1, 1e6},
             "After so many lost frames a new keyframe begins, which nothing ties to the others yet");
    list.add("seed", options.seed, kAnyNumber, "Of the random samples of RANSAC", kExpert);
    return list;
}

void OdometryOptions::validate() const {
    check_options("OdometryOptions", *this);
    check_options("MotionPriorOptions", motion);
}

}  // namespace planemap::odometry
