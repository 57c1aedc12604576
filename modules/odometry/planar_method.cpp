// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/planar_method.hpp"

#include <vector>

#include "odometry/keyframe_choice.hpp"

namespace planemap::odometry {
namespace {

constexpr double kStillPredicted = 0.3;  // seconds without a pose for which the prediction means something
constexpr int kBlindFrames = 3;          // without features, after which they are not looked for any harder
constexpr int kBlindRetry = 8;           // every so many blind frames are looked at as others
constexpr double kSureShare = 0.85;      // of the visible surface that must fit where nothing was predicted

}  // namespace

bool PlanarMethod::is_blind() const {
    return blind_frames_ >= kBlindFrames && blind_frames_ % kBlindRetry != 0;
}

std::optional<Located> PlanarMethod::locate(const PreparedFrame& frame, const References& known) {
    // After a pause what lies ahead may only look like what was there: it is not followed, but verified.
    if (!known.motion.is_bounded(frame.utime)) {
        if (!frame.gray) return std::nullopt;
        return known.relocaliser.locate(frame, known.motion, known.keyframes);
    }
    const LocalKeyframe& keyframe = known.keyframes.current();
    const Guess guess = known.motion.predict(frame.utime, keyframe.odom_from_keyframe);
    std::optional<Guess> better;
    std::optional<Track> track;
    if (!keyframe.points.empty() && !frame.pyramid.empty()) {
        track = track_points(options_, keyframe, frame, guess, options_.flow_levels);
        if (!track && !is_blind()) {
            better = coarse_guess(options_, keyframe, frame, guess, last_dense_,
                                  keyframe.odom_from_keyframe.inverse() * known.motion.odom_from_camera());
            track = second_chances(frame, keyframe, *better);
        }
        if (!track && !is_blind())
            if (std::optional<Located> again = known.relocaliser.locate(frame, known.motion, known.keyframes))
                return again;
    }
    if (!track) track = track_geometry(frame, known, guess, better);
    if (!track) return std::nullopt;
    return Located{std::move(*track), keyframe.id, keyframe.odom_from_keyframe};
}

/// Flow again from a guess by the whole image: from the keyframe, then from the last frame with a pose.
std::optional<Track> PlanarMethod::second_chances(const PreparedFrame& frame, const LocalKeyframe& keyframe,
                                                  const Guess& better) const {
    std::optional<Track> track = track_points(options_, keyframe, frame, better, options_.flow_wide_levels);
    if (track || last_pyramid_.empty()) return track;
    const FlowSearch search{&last_pyramid_, &last_pixels_, &last_inlier_, options_.flow_wide_levels};
    return track_points(options_, keyframe, frame, better, search);
}

/// Depth alone: from the guess, from the one by the whole image (which means nothing in the dark, but takes
/// the guess's place where no motion is known), from where the camera was, and from where its motion would
/// have led it.
std::optional<Track> PlanarMethod::track_geometry(const PreparedFrame& frame, const References& known,
                                                  const Guess& guess,
                                                  const std::optional<Guess>& by_image) const {
    const double elapsed = known.motion.seconds_since_pose(frame.utime);
    const bool fresh = elapsed < kStillPredicted;
    const LocalKeyframe& keyframe = known.keyframes.current();
    const Guess still = known.motion.stand_still(frame.utime, keyframe.odom_from_keyframe);
    Guess carried_on = still;
    carried_on.camera_from_keyframe =
        pose_from_twist(elapsed * known.motion.velocity()) * still.camera_from_keyframe;
    std::optional<Track> best;
    const bool is_motion_known = !guess.velocity_gain.isZero();
    std::vector<Guess> starts;
    if (is_motion_known || !by_image) starts.push_back(guess);
    if (by_image) starts.push_back(*by_image);
    starts.push_back(still);
    starts.push_back(carried_on);
    for (const Guess& start : starts) {
        std::optional<Track> track = track_surface(options_, keyframe, frame, start);
        if (!track || (!fresh && (track->degenerate || track->inliers < kSureShare * track->tried))) continue;
        if (!best || track->inliers * best->tried > best->inliers * track->tried) best = std::move(track);
        if (fresh) break;
    }
    return best;
}

bool PlanarMethod::wants_keyframe(const PreparedFrame& frame, const Located& located,
                                  const LocalKeyframe& keyframe) const {
    // Without features, new ones are looked for now and then.
    const bool looks_for_features = !located.track.by_features && frame.gray && !is_blind();
    return looks_for_features || has_lost_overlap(options_, keyframe, frame, located.track);
}

void PlanarMethod::begin(const PreparedFrame& frame) {
    last_dense_ = make_dense_reference(frame.pyramid, *frame.depth, *frame.camera);
}

void PlanarMethod::follow(const PreparedFrame& frame, const Located& located, double elapsed_s) {
    const bool is_seeing = located.track.by_features || elapsed_s > options_.max_prediction_s;
    blind_frames_ = is_seeing ? 0 : blind_frames_ + 1;
    last_dense_ = make_dense_reference(frame.pyramid, *frame.depth, *frame.camera);
}

void PlanarMethod::lose() {
    blind_frames_ = 0;
    last_pyramid_ = {};
}

void PlanarMethod::go_on_from(PreparedFrame& frame, const Track& track) {
    last_pyramid_ = track.by_features ? std::move(frame.pyramid) : FlowPyramid{};
    last_pixels_ = track.pixels;
    last_inlier_ = track.inlier;
}

void PlanarMethod::go_on_from(PreparedFrame& frame, const LocalKeyframe& keyframe) {
    last_pyramid_ = std::move(frame.pyramid);
    last_pixels_ = keyframe.pixels();
    last_inlier_.assign(keyframe.points.size(), 1);
}

}  // namespace planemap::odometry
