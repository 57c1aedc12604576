// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/paper_method.hpp"

#include "odometry/feature_matching.hpp"
#include "odometry/features.hpp"
#include "odometry/ransac.hpp"

namespace planemap::odometry {

std::optional<Located> PaperMethod::locate(const PreparedFrame& frame, const References& known) {
    if (!frame.gray) return std::nullopt;
    std::vector<Feature> features = planar_features(frame);
    // The next frame is matched with this one's: without any it could not go on from here.
    if (static_cast<int>(features.size()) < options_.min_inliers) return std::nullopt;
    std::optional<Located> located;
    const LocalKeyframe& keyframe = known.keyframes.current();
    // After a pause what lies ahead may only look like what was there: it is not followed, but verified.
    std::optional<Track> found;
    if (known.motion.is_bounded(frame.utime)) found = track(features, frame, known);
    if (found)
        located = Located{std::move(*found), keyframe.id, keyframe.odom_from_keyframe};
    else
        located = known.relocaliser.locate(frame, known.motion, known.keyframes);
    if (!located) return std::nullopt;
    located->filtered = false;
    last_ = std::move(features);
    return located;
}

std::optional<Track> PaperMethod::track(const std::vector<Feature>& features, const PreparedFrame& frame,
                                        const References& known) const {
    const std::vector<PointTerm> matches =
        match_terms(last_, features, frame, options_.max_descriptor_distance);
    const std::optional<Pose> camera_from_last =
        ransac_motion(frame.camera->color, matches, motion_ransac_options(options_));
    if (!camera_from_last) return std::nullopt;
    std::optional<Track> track =
        align_matches(frame.camera->color, matches, *camera_from_last, options_.min_inliers);
    if (!track) return std::nullopt;
    const Pose last_from_keyframe =
        known.motion.odom_from_camera().inverse() * known.keyframes.current().odom_from_keyframe;
    track->alignment.camera_from_keyframe = track->alignment.camera_from_keyframe * last_from_keyframe;
    return track;
}

std::vector<Feature> PaperMethod::planar_features(const PreparedFrame& frame) const {
    std::vector<Feature> features = describe(*frame.gray, *frame.depth, *frame.camera,
                                             options_.max_descriptors, options_.max_depth_spread);
    put_on_regions(features, frame);
    std::erase_if(features, [](const Feature& feature) { return feature.region < 0; });
    return features;
}

void PaperMethod::go_on_from(PreparedFrame& frame, const LocalKeyframe&) {
    if (frame.gray) last_ = planar_features(frame);
}

}  // namespace planemap::odometry
