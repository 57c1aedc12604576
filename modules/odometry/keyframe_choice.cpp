// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/keyframe_choice.hpp"

namespace planemap::odometry {
namespace {

constexpr int kMinPatches = 40;    // of depth, for a keyframe without texture
constexpr double kSameView = 1.1;  // residual of depth without motion over that with it, where nothing moved
constexpr double kMinVisible = 0.6;    // share of a keyframe's points in the image, to return to it
constexpr double kReturnShare = 0.1;   // less of its points than of a present keyframe's must be tracked
constexpr double kReturnReach = 0.8;   // of the motion that asks for a new keyframe
constexpr double kReturnSigma = 0.02;  // metres and radians of the known pose
constexpr std::size_t kScouts = 64;    // points that tell how many of all are seen
constexpr double kShareSlack = 0.13;   // two deviations of a share that so many tell

bool is_beyond(const Pose& motion, double metres, double radians) {
    return motion.translation().norm() > metres || rotation_angle(motion) > radians;
}

/// Whether the frame's depth is the keyframe's, reading by reading. It asks the readings, since a pose before
/// a bare wall may drift while the camera stands.
bool sees_the_same(const OdometryOptions& options, const LocalKeyframe& keyframe, const PreparedFrame& frame,
                   const Located& located) {
    const auto match = [&](const Pose& camera_from_keyframe) {
        return match_patches(keyframe.patches, frame.camera->color, frame.samples, camera_from_keyframe,
                             options.surface_gate_m, 1);
    };
    const PatchMatch still = match(Pose::Identity());
    const PatchMatch moved = match(located.track.alignment.camera_from_keyframe);
    return still.matched >= moved.matched && still.residual < kSameView * moved.residual;
}

/// Share of a keyframe's points that lie in the image at camera_from_keyframe.
double visible_share(const LocalKeyframe& keyframe, const PinholeCamera& camera,
                     const Pose& camera_from_keyframe) {
    int visible = 0;
    for (const TrackPoint& point : keyframe.points) {
        const Eigen::Vector3d p = camera_from_keyframe * point.point;
        visible += p.z() > 0.05 && camera.sees(camera.project(p));
    }
    return visible / static_cast<double>(keyframe.points.size());
}

/// The keyframe near the camera, other than the present one, of which it sees most; nullptr: not enough.
const LocalKeyframe* most_visible(const OdometryOptions& options, const LocalKeyframes& keyframes,
                                  const PinholeCamera& camera, const Pose& odom_from_camera) {
    const LocalKeyframe* best = nullptr;
    double best_share = kMinVisible;
    for (const LocalKeyframe& keyframe : keyframes.all()) {
        if (&keyframe == &keyframes.current() || keyframe.points.empty()) continue;
        const Pose camera_from_keyframe = odom_from_camera.inverse() * keyframe.odom_from_keyframe;
        if (is_beyond(camera_from_keyframe, kReturnReach * options.max_translation_m,
                      kReturnReach * options.max_rotation_rad))
            continue;
        const double share = visible_share(keyframe, camera, camera_from_keyframe);
        if (share <= best_share) continue;
        best_share = share;
        best = &keyframe;
    }
    return best;
}

/// Whether some of a keyframe's points, spread over all of them, leave it open that so many of all are found.
/// Most keyframes that are near show too little: to know that costs a fifth of tracking against them.
bool may_see(const OdometryOptions& options, const LocalKeyframe& keyframe, const PreparedFrame& frame,
             const Guess& guess, double needed) {
    const std::size_t all = keyframe.points.size();
    if (all < 2 * kScouts) return true;
    std::vector<char> usable(all, 0);
    for (std::size_t i = 0; i < kScouts; ++i) usable[i * all / kScouts] = 1;
    const std::vector<cv::Point2f> pixels = keyframe.pixels();
    const int found = count_points(options, keyframe, frame, guess,
                                   {&keyframe.pyramid, &pixels, &usable, options.flow_levels});
    const double share = found / static_cast<double>(kScouts);
    return (share + kShareSlack) * static_cast<double>(all) >= needed;
}

}  // namespace

bool can_be_tracked_against(const LocalKeyframe& keyframe, int min_points) {
    return static_cast<int>(keyframe.points.size()) >= min_points || keyframe.patches.cells() >= kMinPatches;
}

bool has_moved(const OdometryOptions& options, const Located& located) {
    return is_beyond(located.keyframe_from_camera(), options.max_translation_m, options.max_rotation_rad);
}

bool has_lost_overlap(const OdometryOptions& options, const LocalKeyframe& keyframe,
                      const PreparedFrame& frame, const Track& track) {
    const std::size_t all = track.by_features ? keyframe.points.size() : frame.samples.size();
    return track.inliers < options.min_tracked_share * static_cast<double>(all);
}

bool is_worth_it(const OdometryOptions& options, const LocalKeyframe& keyframe, const PreparedFrame& frame,
                 const Located& located, const LocalKeyframe& candidate) {
    if (located.relocalised) return true;
    const auto corners = static_cast<int>(candidate.points.size());
    if (located.track.by_features) return corners > located.track.inliers;
    return has_moved(options, located) || has_lost_overlap(options, keyframe, frame, located.track) ||
           !sees_the_same(options, keyframe, frame, located) ||
           corners >= 2 * static_cast<int>(keyframe.points.size()) + options.min_inliers;
}

std::optional<Return> find_other_keyframe(const OdometryOptions& options, const LocalKeyframes& keyframes,
                                          const PreparedFrame& frame, const Located& located,
                                          const Twist& velocity) {
    if (frame.pyramid.empty()) return std::nullopt;
    const Pose odom_from_camera = located.odom_from_camera();
    const LocalKeyframe* keyframe = most_visible(options, keyframes, frame.camera->color, odom_from_camera);
    if (!keyframe) return std::nullopt;
    Guess guess;
    guess.camera_from_keyframe = odom_from_camera.inverse() * keyframe->odom_from_keyframe;
    guess.information = Matrix6d::Identity() / (kReturnSigma * kReturnSigma);
    guess.velocity = velocity;
    const double needed =
        (options.min_tracked_share - kReturnShare) * static_cast<double>(keyframe->points.size());
    if (!may_see(options, *keyframe, frame, guess, needed)) return std::nullopt;
    std::optional<Track> track = track_points(options, *keyframe, frame, guess, options.flow_levels);
    if (!track || track->degenerate || track->inliers < needed) return std::nullopt;
    return Return{keyframe->id, std::move(*track)};
}

}  // namespace planemap::odometry
