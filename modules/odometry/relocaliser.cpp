// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/relocaliser.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "odometry/keyframe_making.hpp"
#include "places/comparison.hpp"

namespace planemap::odometry {
namespace {

constexpr double kSlack_m = 0.05;     // of the poses of keyframes about one
constexpr double kRivalScore = 0.25;  // of the score of what was found, that a rival has at least
constexpr double kRefined_m = 0.05, kRefined_rad = 0.03;  // that flow may move a verified pose

/// Flow from a local keyframe, started where its features were matched.
std::optional<Track> refine(const OdometryOptions& options, const LocalKeyframe& keyframe,
                            const PreparedFrame& frame, const Pose& camera_from_keyframe) {
    Guess guess;
    guess.camera_from_keyframe = camera_from_keyframe;
    guess.information = Matrix6d::Identity();
    std::optional<Track> track = track_points(options, keyframe, frame, guess, options.flow_levels);
    if (!track) return std::nullopt;
    const Pose moved = track->alignment.camera_from_keyframe * camera_from_keyframe.inverse(Eigen::Isometry);
    const bool is_near = moved.translation().norm() < kRefined_m && rotation_angle(moved) < kRefined_rad;
    return is_near ? track : std::nullopt;
}

/// Root mean square of where the frame shows a keyframe's points, against where it should; pixels.
double residual_px(const PinholeCamera& camera, const places::KeyframeView& keyframe,
                   const places::KeyframeView& view, const Pose& keyframe_from_camera,
                   const places::VerificationOptions& options) {
    const Pose camera_from_keyframe = keyframe_from_camera.inverse(Eigen::Isometry);
    double sum = 0, count = 0;
    for (const places::Match& match : match_at(keyframe, view, keyframe_from_camera, options)) {
        const Eigen::Vector3d p =
            camera_from_keyframe * keyframe.points[static_cast<std::size_t>(match.first)];
        if (!(p.z() > 0.05)) continue;
        sum += (camera.project(p) - camera.project(view.points[static_cast<std::size_t>(match.second)]))
                   .squaredNorm();
        ++count;
    }
    return count > 0 ? std::sqrt(sum / count) : 0;
}

}  // namespace

Relocaliser::Relocaliser(const OdometryOptions& options)
    : options_(options), known_(options.max_known_keyframes) {}

void Relocaliser::add(const Keyframe& keyframe) {
    known_.add(keyframe.id, keyframe.previous_id, keyframe.odom_from_camera,
               places::make_view(keyframe, options_.max_descriptors));
}

std::optional<Located> Relocaliser::locate(const PreparedFrame& frame, const CameraMotion& motion,
                                           const LocalKeyframes& local) const {
    if (options_.relocalisation_tries < 1) return std::nullopt;
    const Query query{frame, motion,
                      places::make_view(make_keyframe(options_, frame, {}), options_.max_descriptors)};
    const std::vector<KnownKeyframes::Candidate> candidates = known_.candidates(query.view.descriptors);
    const auto tried = std::min(candidates.size(), static_cast<std::size_t>(options_.relocalisation_tries));
    for (std::size_t i = 0; i < tried; ++i) {
        const std::optional<Explanation> found = explain(query, candidates[i], verification_);
        if (!found) continue;
        if (has_rival(query, *found, candidates) || has_twin(query, *found)) return std::nullopt;
        return located(query, *found, local);
    }
    return std::nullopt;
}

std::optional<Relocaliser::Explanation> Relocaliser::explain(
    const Query& query, const KnownKeyframes::Candidate& candidate,
    const places::VerificationOptions& options) const {
    const std::uint64_t seed = options_.seed + static_cast<std::uint64_t>(candidate.keyframe->id);
    Explanation explanation{candidate.keyframe, verify(candidate.keyframe->view, query.view, options, seed),
                            candidate.score};
    if (explanation.verification.verdict != places::Verdict::kAccepted) return std::nullopt;
    if (!query.motion.is_plausible(explanation.odom_from_camera(), query.frame.utime)) return std::nullopt;
    if (is_contradicted(explanation, query.view)) return std::nullopt;
    return explanation;
}

/// Whether what was seen shortly before and after the keyframe speaks against it: a wall where a camera
/// looked through, or a view through a wall.
bool Relocaliser::is_contradicted(const Explanation& explanation, const places::KeyframeView& view) const {
    std::vector<places::PlacedView> others;
    for (const KnownKeyframe* other : known_.around(*explanation.keyframe))
        others.push_back({&other->view, other->odom_from_keyframe.inverse(Eigen::Isometry) *
                                            explanation.odom_from_camera()});
    return share_seen_through(view, others, kSlack_m) > verification_.max_contradiction;
}

/// Whether another keyframe, one that does not see what the found one sees, explains the view too.
bool Relocaliser::has_rival(const Query& query, const Explanation& found,
                            std::span<const KnownKeyframes::Candidate> candidates) const {
    const places::VerificationOptions options = rival_options(verification_, found.verification);
    const bool is_free = !query.motion.is_bounded(query.frame.utime);
    int tries = 0;
    for (const KnownKeyframes::Candidate& candidate : candidates) {
        if (tries >= 2 * options_.relocalisation_tries) break;
        const KnownKeyframe& keyframe = *candidate.keyframe;
        if (&keyframe == found.keyframe || candidate.score < kRivalScore * found.score) continue;
        // What was shortly before in another part may be the same place: nobody knows how parts lie.
        const bool is_other_part = keyframe.part != found.keyframe->part;
        if (is_other_part && !is_free) continue;
        const Pose keyframe_from_camera =
            keyframe.odom_from_keyframe.inverse(Eigen::Isometry) * found.odom_from_camera();
        if (!is_other_part && looks_at_the_same(keyframe.view, query.view, keyframe_from_camera)) continue;
        ++tries;
        const std::optional<Explanation> rival = explain(query, candidate, options);
        if (rival &&
            (is_other_part || places::are_apart(rival->odom_from_camera(), found.odom_from_camera())))
            return true;
    }
    return false;
}

/// Whether the keyframe itself, which shows more than a view of part of it, looks like another place that the
/// view may be of. After a pause only: before, the camera cannot have come there.
bool Relocaliser::has_twin(const Query& query, const Explanation& found) const {
    if (query.motion.is_bounded(query.frame.utime)) return false;
    const KnownKeyframe& keyframe = *found.keyframe;
    const places::VerificationOptions options = rival_options(verification_, found.verification);
    int tries = 0;
    for (const KnownKeyframes::Candidate& candidate : known_.candidates(keyframe.view.descriptors)) {
        const KnownKeyframe& other = *candidate.keyframe;
        if (tries >= 2 * options_.relocalisation_tries) break;
        if (other.part != keyframe.part) continue;
        const Pose other_from_odom = other.odom_from_keyframe.inverse(Eigen::Isometry);
        if (looks_at_the_same(other.view, keyframe.view, other_from_odom * keyframe.odom_from_keyframe))
            continue;
        ++tries;
        Explanation twin{&other, verify(other.view, keyframe.view, options, options_.seed), candidate.score};
        if (twin.verification.verdict != places::Verdict::kAccepted) continue;
        if (!places::are_apart(twin.odom_from_camera(), keyframe.odom_from_keyframe)) continue;
        twin.verification.a_from_b = twin.verification.a_from_b * found.verification.a_from_b;
        if (query.motion.is_plausible(twin.odom_from_camera(), query.frame.utime) &&
            !is_contradicted(twin, query.view))
            return true;
    }
    return false;
}

Located Relocaliser::located(const Query& query, const Explanation& found,
                             const LocalKeyframes& local) const {
    const places::Verification& verification = found.verification;
    const Pose camera_from_keyframe = verification.a_from_b.inverse(Eigen::Isometry);
    if (const LocalKeyframe* keyframe = local.find(found.keyframe->id))
        if (std::optional<Track> track = refine(options_, *keyframe, query.frame, camera_from_keyframe))
            return {std::move(*track), keyframe->id, found.keyframe->odom_from_keyframe};
    Track track;
    track.alignment.camera_from_keyframe = camera_from_keyframe;
    track.alignment.information = verification.covariance.ldlt().solve(Matrix6d::Identity());
    track.alignment.color_offset_s = query.frame.color_offset_s;
    track.alignment.inliers = track.inliers = verification.inliers;
    track.alignment.residual_px = residual_px(query.frame.camera->color, found.keyframe->view, query.view,
                                              verification.a_from_b, verification_);
    track.alignment.converged = true;
    track.tried = std::max(verification.matches, verification.inliers);
    track.by_features = true;
    return {std::move(track), found.keyframe->id, found.keyframe->odom_from_keyframe, true};
}

}  // namespace planemap::odometry
