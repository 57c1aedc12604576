// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/relocaliser.hpp"

#include <algorithm>
#include <cmath>

#include "odometry/feature_matching.hpp"
#include "odometry/features.hpp"
#include "odometry/ransac.hpp"

namespace planemap::odometry {
namespace {

/// A plane of a keyframe is seen again: within so much; one that is turned less than kNearAngle and is not,
/// contradicts.
constexpr double kAngle = 0.07, kNearAngle = 0.6;  // radians
constexpr double kOffset = 0.06;                   // metres
constexpr std::size_t kRegions = 3;

constexpr int kInliers = 20;  // matched features that make a place known again

/// Flow from a local keyframe, started where its features were matched.
std::optional<Track> refine(const OdometryOptions& options, const LocalKeyframe& keyframe,
                            const PreparedFrame& frame, const Pose& camera_from_keyframe) {
    Guess guess;
    guess.camera_from_keyframe = camera_from_keyframe;
    guess.information = Matrix6d::Identity();
    return track_points(options, keyframe, frame, guess, options.flow_levels);
}

}  // namespace

Relocaliser::Relocaliser(const OdometryOptions& options)
    : options_(options), known_(options.max_known_keyframes) {}

void Relocaliser::add(const Keyframe& keyframe, const PreparedFrame& frame) {
    known_.add({keyframe.id, keyframe.odom_from_camera, keyframe.features, make_thumbnail(*frame.gray)});
}

void Relocaliser::add(const Keyframe& keyframe) {
    std::vector<Plane> planes;
    for (const PlanarRegion& region : keyframe.regions) planes.push_back(region.plane);  // the largest first
    known_.add({keyframe.id, keyframe.odom_from_camera, keyframe.features, {}, std::move(planes)});
}

bool Relocaliser::agrees(const Located& located, std::span<const PlanarRegion> regions) const {
    const KnownKeyframe* keyframe = known_.find(located.keyframe_id);
    if (keyframe == nullptr) return false;
    const Pose keyframe_from_camera = located.keyframe_from_camera();
    int agree = 0, contradict = 0;
    for (const PlanarRegion& region : regions.first(std::min<std::size_t>(regions.size(), kRegions))) {
        const Plane seen = keyframe_from_camera * region.plane;
        bool is_known = false, is_near = false;
        for (const Plane& plane : keyframe->planes) {
            const double angle = angle_between(seen.normal, plane.normal), off = std::abs(seen.d - plane.d);
            is_known = is_known || (angle < kAngle && off < kOffset);
            is_near = is_near || angle < kNearAngle;
        }
        agree += is_known;
        contradict += !is_known && is_near;
    }
    return agree > 0 && agree >= contradict;
}

std::optional<Located> Relocaliser::locate(const PreparedFrame& frame, const CameraMotion& motion,
                                           const LocalKeyframes& local) const {
    const std::vector<Feature> features = describe(*frame.gray, *frame.depth, *frame.camera,
                                                   options_.max_descriptors, options_.max_depth_spread);
    MotionRansacOptions ransac;
    ransac.inlier_px = 4 * options_.pixel_sigma_px;
    ransac.min_inliers = kInliers;
    ransac.seed = options_.seed;
    for (const KnownKeyframe* known : known_.candidates(*frame.gray, options_.relocalisation_tries)) {
        const std::vector<PointTerm> matches =
            match_terms(known->features, features, frame, options_.max_descriptor_distance);
        const std::optional<Pose> pose = ransac_motion(frame.camera->color, matches, ransac);
        if (!pose || !motion.is_plausible(known->odom_from_keyframe * pose->inverse(), frame.utime)) continue;
        if (const LocalKeyframe* keyframe = local.find(known->id))
            if (std::optional<Track> track = refine(options_, *keyframe, frame, *pose))
                return Located{std::move(*track), known->id, known->odom_from_keyframe};
        if (std::optional<Track> track = align_matches(frame.camera->color, matches, *pose, kInliers)) {
            track->by_features = true;
            return Located{std::move(*track), known->id, known->odom_from_keyframe, true};
        }
    }
    return std::nullopt;
}

}  // namespace planemap::odometry
