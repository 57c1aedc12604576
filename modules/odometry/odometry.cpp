// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odometry.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "odometry/features.hpp"
#include "odometry/known_keyframes.hpp"
#include "odometry/motion_filter.hpp"
#include "odometry/ransac.hpp"
#include "odometry/readout.hpp"
#include "odometry/tracker.hpp"

namespace planemap {
namespace {

constexpr double kUsual = 0.01;          // metres and radians by which a prediction is off at any rate
constexpr int kRelocalisedInliers = 20;  // matched features that make a place known again
constexpr int kMinSurfaceCells = 40;     // for a keyframe without texture
constexpr double kStillPredicted = 0.3;  // seconds without a pose for which the prediction means something
constexpr double kLongestGap = 1.5;      // seconds without a pose after which depth alone is not followed
constexpr double kReach = 0.3;           // metres and radians that a camera may always have moved
constexpr int kBlindFrames = 3;          // without features, after which they are not looked for any harder
constexpr int kBlindRetry = 8;           // every so many blind frames are looked at as others
constexpr double kSameView = 1.1;  // residual of depth without motion over that with it, where nothing moved
constexpr double kSureShare = 0.85;  // of the visible surface that must fit where nothing was predicted

double seconds(std::int64_t microseconds) {
    return static_cast<double>(microseconds) * 1e-6;
}

void check(const OdometryFrame& frame) {
    if (!frame.depth || !frame.camera)
        throw std::invalid_argument("OdometryFrame: depth and camera are needed");
    const PinholeCamera& camera = frame.camera->color;
    const auto fits = [&](const auto& image) {
        return image.width == camera.width && image.height == camera.height &&
               image.pixels.size() ==
                   static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
    };
    if (!fits(*frame.depth))
        throw std::invalid_argument("OdometryFrame: depth is not of the colour camera's size; register it");
    if (frame.gray && !fits(*frame.gray))
        throw std::invalid_argument("OdometryFrame: gray is not of the colour camera's size");
}

/// Puts the features that lie on regions onto their planes (paper section 2.2).
void put_on_regions(std::vector<Feature>& features, const PreparedFrame& view) {
    for (Feature& feature : features) {
        const Eigen::Vector3d point = feature.point.cast<double>();
        feature.region = region_of(view.regions, point, view.camera->noise.sigma(point.z()));
        if (feature.region < 0) continue;
        const Plane& plane = view.regions[static_cast<std::size_t>(feature.region)].plane;
        feature.point = regularised(plane, point).cast<float>();
    }
}

/// Brings features that the colour image showed to where they were at the depth image's time, onto the
/// regions that they lie on there.
void put_at_depth_time(std::vector<Feature>& features, const PreparedFrame& view, double color_offset_s,
                       const Twist& velocity) {
    const auto move = [](Feature& feature, const Twist& motion) {
        const Eigen::Vector3d point = moved(motion, feature.point.cast<double>());
        feature.point = point.cast<float>();
    };
    for (Feature& feature : features) move(feature, -color_offset_s * velocity);
    put_on_regions(features, view);
    for (Feature& feature : features) {
        const double late = row_share(view.camera->color, static_cast<double>(feature.pixel.y()));
        move(feature, -late * view.readout_s * velocity);
    }
}

/// A matched descriptor; ORB is coarser than flow, in the image and in depth.
PointTerm match_term(const Feature& seen, const Feature& here, const PreparedFrame& view) {
    const double z = here.point.z(), sigma = view.camera->noise.sigma(z) / (z * z);
    return {seen.point.cast<double>(), here.pixel.cast<double>(), 2, 1 / z, 6 * sigma};
}

/// Where a frame is, and how it is known.
struct Located {
    Track track;
    int keyframe_id = -1;
    Pose odom_from_keyframe = Pose::Identity();
    bool relocalised = false;  ///< against a remembered keyframe that can no longer be tracked against

    Pose keyframe_from_camera() const { return track.alignment.camera_from_keyframe.inverse(); }
    void move_to(const Pose& odom_from_camera) {
        track.alignment.camera_from_keyframe = odom_from_camera.inverse() * odom_from_keyframe;
    }
    Pose odom_from_camera() const { return orthonormalised(odom_from_keyframe * keyframe_from_camera()); }
    /// Small motions of keyframe_from_camera in the camera frame are those of camera_from_keyframe reversed.
    Matrix6d covariance() const { return track.alignment.information.ldlt().solve(Matrix6d::Identity()); }
};

}  // namespace

class Odometry::State {
  public:
    explicit State(const OdometryOptions& options)
        : options_(options), known_(options.max_known_keyframes), filter_(options.max_prediction_s) {}

    OdometryResult process(const OdometryFrame& frame);

  private:
    /// True when the motion of the last frames tells how the camera moves now.
    bool knows_velocity(std::int64_t utime) const {
        return lost_frames_ == 0 && utime > pose_utime_ &&
               seconds(utime - pose_utime_) <= options_.max_prediction_s;
    }
    PreparedFrame prepare(const OdometryFrame& frame) const;
    Guess predict(std::int64_t utime, const LocalKeyframe& keyframe, bool moving) const;
    std::optional<Located> locate(const PreparedFrame& view);
    std::optional<Track> second_chances(const PreparedFrame& view, const Guess& better) const;
    std::optional<Track> track_geometry(const PreparedFrame& view, const Guess& guess) const;
    std::optional<Located> locate_by_paper(const PreparedFrame& view);
    std::vector<Feature> planar_features(const PreparedFrame& view) const;
    bool is_plausible(const Pose& odom_from_camera, std::int64_t utime) const;
    std::optional<Located> relocalise(const PreparedFrame& view);

    void follow(const PreparedFrame& view, Located& located);
    void remember_flow(PreparedFrame& view, const Track& track);
    bool has_moved(const Located& located) const;
    bool sees_the_same(const PreparedFrame& view, const Located& located) const;
    bool has_lost_overlap(const PreparedFrame& view, const Located& located) const;
    bool wants_keyframe(const PreparedFrame& view, const Located& located) const;
    bool is_worth_it(const PreparedFrame& view, const Located& located, const LocalKeyframe& local) const;
    std::optional<std::size_t> other_keyframe(const PreparedFrame& view, const Located& located,
                                              Track& track) const;
    std::optional<Keyframe> change_keyframe(PreparedFrame& view, const Located& located);
    std::optional<Keyframe> begin(PreparedFrame& view, const Pose& odom_from_camera);
    Keyframe add_keyframe(PreparedFrame& view, LocalKeyframe local, const Pose& odom_from_camera);
    LocalKeyframe make_local(const PreparedFrame& view) const;

    LocalKeyframe& current() { return local_[current_]; }
    const LocalKeyframe& current() const { return local_[current_]; }

    OdometryOptions options_;
    CameraInfo camera_;
    int next_id_ = 0;
    std::vector<LocalKeyframe> local_;  ///< in order of use, the newest last
    std::size_t current_ = 0;           ///< the one tracked against
    KnownKeyframes known_;

    std::int64_t utime_ = 0;       ///< of the last frame
    std::int64_t pose_utime_ = 0;  ///< of the last frame with a pose
    MotionFilter filter_;          ///< of the last frame with a pose
    Readout readout_;
    int lost_frames_ = 0;
    int blind_frames_ = 0;       ///< poses in a row that rest on depth alone
    DenseReference last_dense_;  ///< of the last frame with a pose
    FlowPyramid last_pyramid_;   ///< of the last frame, when it was tracked by features
    std::vector<cv::Point2f> last_pixels_;
    std::vector<char> last_inlier_;
    double last_color_offset_s_ = 0;
    std::vector<Feature> last_planar_;  ///< of the last frame, for the paper's method
};

PreparedFrame Odometry::State::prepare(const OdometryFrame& frame) const {
    PreparedFrame view;
    view.utime = frame.utime;
    view.gray = frame.gray;
    view.depth = frame.depth;
    view.camera = frame.camera;
    view.readout_s = knows_velocity(frame.utime) ? readout_.seconds() : 0;
    if (frame.gray) {
        if (frame.color_utime != 0) view.color_offset_s = seconds(frame.color_utime - frame.utime);
        view.pyramid =
            make_flow_pyramid(*frame.gray, options_.flow_wide_levels, options_.flow_window_px, false);
    }
    view.samples = sample_depth(*frame.depth, frame.camera->color, *frame.camera, options_.surface_stride_px);
    for (const PlanarRegion& region : frame.regions)
        if (is_valid(region)) view.regions.push_back(region);
    return view;
}

/// Constant velocity, or standing still when not `moving`.
Guess Odometry::State::predict(std::int64_t utime, const LocalKeyframe& keyframe, bool moving) const {
    Guess guess;
    const double elapsed = std::clamp(seconds(utime - pose_utime_), 0.0, 10.0);
    const Twist motion = filter_.velocity() * (moving ? std::min(elapsed, options_.max_prediction_s) : 0.0);
    guess.camera_from_keyframe =
        pose_from_twist(motion) * filter_.odom_from_camera().inverse() * keyframe.odom_from_keyframe;
    const double off = kUsual + options_.acceleration * elapsed * elapsed;
    const double turned = kUsual + options_.angular_acceleration * elapsed * elapsed;
    guess.information.diagonal() << Eigen::Vector3d::Constant(1 / (off * off)),
        Eigen::Vector3d::Constant(1 / (turned * turned));
    if (!moving) return guess;
    guess.velocity = filter_.velocity();
    guess.predicted_from_keyframe = guess.camera_from_keyframe;
    if (knows_velocity(utime)) guess.velocity_gain = filter_.velocity_gain(elapsed);
    return guess;
}

OdometryResult Odometry::State::process(const OdometryFrame& frame) {
    check(frame);
    const bool other_camera = !local_.empty() && !(*frame.camera == camera_);
    if (local_.empty() || other_camera) frame.camera->validate();
    PreparedFrame view = prepare(frame);
    OdometryResult result;
    OdometryEstimate& estimate = result.estimate;
    estimate.utime = estimate.pose_utime = frame.utime;
    const bool restart = local_.empty() || other_camera || frame.utime < utime_;
    utime_ = frame.utime;
    if (other_camera) {
        known_.clear();
        readout_ = {};
    }
    if (restart) {
        result.keyframe = begin(view, filter_.odom_from_camera());
        if (!result.keyframe) {
            local_.clear();
            return result;
        }
        estimate.status = TrackingStatus::kTracked;
        estimate.odom_from_camera = filter_.odom_from_camera();
        estimate.keyframe_id = result.keyframe->id;
        estimate.features = estimate.inliers = static_cast<int>(current().points.size());
        return result;
    }

    std::optional<Located> located = locate(view);
    if (!located) {
        ++lost_frames_;
        blind_frames_ = 0;
        filter_.start(filter_.odom_from_camera());
        last_pyramid_ = {};
        if (lost_frames_ >= options_.max_lost_frames)
            result.keyframe = begin(view, filter_.odom_from_camera());
        if (!result.keyframe) return result;
        estimate.status = TrackingStatus::kTracked;
        estimate.odom_from_camera = filter_.odom_from_camera();
        estimate.keyframe_id = result.keyframe->id;
        return result;
    }
    if (knows_velocity(view.utime) && !located->relocalised)
        readout_.learn(view.readout_s, located->track.alignment);
    follow(view, *located);
    estimate.status = located->track.degenerate ? TrackingStatus::kDegenerate : TrackingStatus::kTracked;
    estimate.odom_from_camera = located->odom_from_camera();
    estimate.keyframe_id = located->keyframe_id;
    estimate.keyframe_from_camera = located->keyframe_from_camera();
    estimate.covariance = located->covariance();
    estimate.features = located->track.tried;
    estimate.inliers = located->track.inliers;
    estimate.residual_px = located->track.alignment.residual_px;
    if (wants_keyframe(view, *located))
        result.keyframe = change_keyframe(view, *located);
    else
        remember_flow(view, located->track);
    return result;
}

std::optional<Located> Odometry::State::locate(const PreparedFrame& view) {
    if (options_.method == "paper") {
        std::optional<Located> located = locate_by_paper(view);
        if (!located && view.gray) located = relocalise(view);
        if (!located) last_planar_.clear();
        return located;
    }
    const bool moving = lost_frames_ == 0;
    Guess guess = predict(view.utime, current(), moving);
    std::optional<Track> track;
    if (!current().points.empty() && !view.pyramid.empty()) {
        std::vector<cv::Point2f> pixels;
        for (const TrackPoint& point : current().points) pixels.push_back(point.pixel);
        FlowSearch search{&current().pyramid, &pixels, nullptr, options_.flow_levels};
        track = track_points(options_, current(), view, guess, search);
        const bool is_blind = blind_frames_ >= kBlindFrames && blind_frames_ % kBlindRetry != 0;
        if (!track && !is_blind) {
            guess = coarse_guess(options_, current(), view, guess, last_dense_,
                                 current().odom_from_keyframe.inverse() * filter_.odom_from_camera());
            track = second_chances(view, guess);
        }
        if (!track && !is_blind)
            if (std::optional<Located> known = relocalise(view)) return known;
    }
    if (!track) track = track_geometry(view, guess);
    if (!track) return std::nullopt;
    return Located{std::move(*track), current().id, current().odom_from_keyframe, false};
}

/// Flow again from a guess by the whole image: from the keyframe, then from the last frame with a pose.
std::optional<Track> Odometry::State::second_chances(const PreparedFrame& view, const Guess& better) const {
    std::vector<cv::Point2f> pixels;
    for (const TrackPoint& point : current().points) pixels.push_back(point.pixel);
    FlowSearch search{&current().pyramid, &pixels, nullptr, options_.flow_wide_levels};
    std::optional<Track> track = track_points(options_, current(), view, better, search);
    if (track || last_pyramid_.empty()) return track;
    search = {&last_pyramid_, &last_pixels_, &last_inlier_, options_.flow_wide_levels};
    return track_points(options_, current(), view, better, search);
}

/// Depth alone: from the guess, from where the camera was, and from where its motion would have led it.
std::optional<Track> Odometry::State::track_geometry(const PreparedFrame& view, const Guess& guess) const {
    const double elapsed = seconds(view.utime - pose_utime_);
    if (elapsed > kLongestGap) return std::nullopt;
    const bool fresh = elapsed < kStillPredicted;
    const Guess still = predict(view.utime, current(), false);
    Guess carried_on = still;
    carried_on.camera_from_keyframe =
        pose_from_twist(elapsed * filter_.velocity()) * still.camera_from_keyframe;
    std::optional<Track> best;
    for (const Guess& start : {guess, still, carried_on}) {
        std::optional<Track> track = track_surface(options_, current(), view, start);
        if (!track || (!fresh && (track->degenerate || track->inliers < kSureShare * track->tried))) continue;
        if (!best || track->inliers * best->tried > best->inliers * track->tried) best = std::move(track);
        if (fresh) break;
    }
    return best;
}

/// The paper's way (section 2): features on planes, projected onto them, matched with the last frame's; the
/// motion by RANSAC, refined on its inliers; poses by chaining.
std::optional<Located> Odometry::State::locate_by_paper(const PreparedFrame& view) {
    if (!view.gray) return std::nullopt;
    const std::vector<Feature> features = planar_features(view);
    std::vector<PointTerm> terms;
    for (const auto& [i, j] : match_descriptors(last_planar_, features, options_.max_descriptor_distance))
        terms.push_back(match_term(last_planar_[static_cast<std::size_t>(i)],
                                   features[static_cast<std::size_t>(j)], view));
    MotionRansacOptions ransac;
    ransac.inlier_px = options_.inlier_sigmas * options_.pixel_sigma_px;
    ransac.min_inliers = options_.min_inliers;
    ransac.seed = options_.seed;
    const std::optional<Pose> motion = ransac_motion(view.camera->color, terms, ransac);
    if (!motion) return std::nullopt;
    Alignment alignment;
    alignment.camera = view.camera->color;
    alignment.points = terms;
    alignment.quadratics.push_back({*motion, Matrix6d::Identity(), Twist::Zero()});
    Track track;
    track.alignment = align(alignment, *motion);
    if (!track.alignment.converged || track.alignment.inliers < options_.min_inliers) return std::nullopt;
    const Pose last_from_keyframe = filter_.odom_from_camera().inverse() * current().odom_from_keyframe;
    track.alignment.camera_from_keyframe = track.alignment.camera_from_keyframe * last_from_keyframe;
    track.tried = static_cast<int>(terms.size());
    track.inliers = track.alignment.inliers;
    last_planar_ = features;
    return Located{std::move(track), current().id, current().odom_from_keyframe, false};
}

std::vector<Feature> Odometry::State::planar_features(const PreparedFrame& view) const {
    std::vector<Feature> features =
        describe(*view.gray, *view.depth, *view.camera, options_.max_descriptors, options_.max_depth_spread);
    put_on_regions(features, view);
    std::erase_if(features, [](const Feature& feature) { return feature.region < 0; });
    return features;
}

/// True when the camera can have come there since the last pose.
bool Odometry::State::is_plausible(const Pose& odom_from_camera, std::int64_t utime) const {
    const double elapsed = seconds(utime - pose_utime_), reach = kReach + options_.acceleration * elapsed;
    const Pose moved = filter_.odom_from_camera().inverse() * odom_from_camera;
    return moved.translation().norm() < reach * (1 + elapsed) &&
           rotation_angle(moved) < reach * (1 + elapsed);
}

/// The frame's descriptors against remembered keyframes; refined by flow where the keyframe is still at hand.
std::optional<Located> Odometry::State::relocalise(const PreparedFrame& view) {
    const std::vector<Feature> features =
        describe(*view.gray, *view.depth, *view.camera, options_.max_descriptors, options_.max_depth_spread);
    for (const KnownKeyframe* known : known_.candidates(*view.gray, options_.relocalisation_tries)) {
        std::vector<PointTerm> terms;
        for (const auto& [i, j] :
             match_descriptors(known->features, features, options_.max_descriptor_distance)) {
            terms.push_back(match_term(known->features[static_cast<std::size_t>(i)],
                                       features[static_cast<std::size_t>(j)], view));
        }
        MotionRansacOptions ransac;
        ransac.inlier_px = 4 * options_.pixel_sigma_px;
        ransac.min_inliers = kRelocalisedInliers;
        ransac.seed = options_.seed;
        const std::optional<Pose> pose = ransac_motion(view.camera->color, terms, ransac);
        if (!pose || !is_plausible(known->odom_from_keyframe * pose->inverse(), view.utime)) continue;
        Guess guess;
        guess.camera_from_keyframe = *pose;
        guess.information = Matrix6d::Identity();
        for (std::size_t i = 0; i < local_.size(); ++i) {
            if (local_[i].id != known->id) continue;
            std::vector<cv::Point2f> pixels;
            for (const TrackPoint& point : local_[i].points) pixels.push_back(point.pixel);
            FlowSearch search{&local_[i].pyramid, &pixels, nullptr, options_.flow_levels};
            std::optional<Track> track = track_points(options_, local_[i], view, guess, search);
            if (!track) continue;
            current_ = i;
            return Located{std::move(*track), known->id, known->odom_from_keyframe, false};
        }
        Alignment alignment;
        alignment.camera = view.camera->color;
        alignment.points = terms;
        alignment.quadratics.push_back({*pose, guess.information, Twist::Zero()});
        Track track;
        track.alignment = align(alignment, *pose);
        if (!track.alignment.converged || track.alignment.inliers < kRelocalisedInliers) continue;
        track.tried = static_cast<int>(terms.size());
        track.inliers = track.alignment.inliers;
        track.by_features = true;
        return Located{std::move(track), known->id, known->odom_from_keyframe, true};
    }
    return std::nullopt;
}

/// Takes over the pose, without its jitter, and the motion since the last one.
void Odometry::State::follow(const PreparedFrame& view, Located& located) {
    const double elapsed = seconds(view.utime - pose_utime_);
    if (lost_frames_ > 0 || located.relocalised || !(elapsed > 0) || options_.method == "paper")
        filter_.start(located.odom_from_camera());
    else
        located.move_to(filter_.update(located.odom_from_camera(), elapsed));
    pose_utime_ = view.utime;
    lost_frames_ = 0;
    blind_frames_ = located.track.by_features || elapsed > options_.max_prediction_s ? 0 : blind_frames_ + 1;
    last_dense_ = make_dense_reference(view.pyramid, *view.depth, *view.camera);
    last_color_offset_s_ =
        located.track.by_features ? located.track.alignment.color_offset_s : view.color_offset_s;
}

void Odometry::State::remember_flow(PreparedFrame& view, const Track& track) {
    last_pyramid_ = track.by_features ? std::move(view.pyramid) : FlowPyramid{};
    last_pixels_ = track.pixels;
    last_inlier_ = track.inlier;
}

bool Odometry::State::has_moved(const Located& located) const {
    const Pose keyframe_from_camera = located.keyframe_from_camera();
    return keyframe_from_camera.translation().norm() > options_.max_translation_m ||
           rotation_angle(keyframe_from_camera) > options_.max_rotation_rad;
}

/// Whether the frame's depth is the keyframe's, reading by reading. It asks the readings, since a pose before
/// a bare wall may drift while the camera stands.
bool Odometry::State::sees_the_same(const PreparedFrame& view, const Located& located) const {
    const auto match = [&](const Pose& camera_from_keyframe) {
        return match_surface(current().surface, view.camera->color, view.samples, camera_from_keyframe,
                             options_.surface_gate_m, 1);
    };
    const SurfaceMatch still = match(Pose::Identity());
    const SurfaceMatch moved = match(located.track.alignment.camera_from_keyframe);
    return still.matched >= moved.matched && still.residual < kSameView * moved.residual;
}

/// Whether too little of the keyframe is seen again, of its corners or, where depth alone leads, its surface.
bool Odometry::State::has_lost_overlap(const PreparedFrame& view, const Located& located) const {
    const std::size_t all = located.track.by_features ? current().points.size() : view.samples.size();
    return located.track.inliers < options_.min_tracked_share * static_cast<double>(all);
}

bool Odometry::State::wants_keyframe(const PreparedFrame& view, const Located& located) const {
    if (located.relocalised || has_moved(located)) return true;
    if (options_.method == "paper") return false;
    // Without features, new ones are looked for now and then.
    const bool looks_for_features = !located.track.by_features && view.gray &&
                                    (blind_frames_ < kBlindFrames || blind_frames_ % kBlindRetry == 0);
    return looks_for_features || has_lost_overlap(view, located);
}

/// Whether a keyframe of this view would do what the present one does not. Where features do not hold, those
/// of the same view would not hold either, unless they are many more, as when the light goes on.
bool Odometry::State::is_worth_it(const PreparedFrame& view, const Located& located,
                                  const LocalKeyframe& local) const {
    if (located.relocalised) return true;
    const auto corners = static_cast<int>(local.points.size());
    if (located.track.by_features) return corners > located.track.inliers;
    return has_moved(located) || has_lost_overlap(view, located) || !sees_the_same(view, located) ||
           corners >= 2 * static_cast<int>(current().points.size()) + options_.min_inliers;
}

/// Another recent keyframe that sees more of this frame, with the frame tracked against it.
std::optional<std::size_t> Odometry::State::other_keyframe(const PreparedFrame& view, const Located& located,
                                                           Track& track) const {
    if (view.pyramid.empty()) return std::nullopt;
    std::optional<std::size_t> best;
    double best_share = 0.6;
    const Pose odom_from_camera = located.odom_from_camera();
    for (std::size_t i = 0; i < local_.size(); ++i) {
        if (i == current_ || local_[i].points.empty()) continue;
        const Pose camera_from_keyframe = odom_from_camera.inverse() * local_[i].odom_from_keyframe;
        if (camera_from_keyframe.translation().norm() > 0.8 * options_.max_translation_m ||
            rotation_angle(camera_from_keyframe) > 0.8 * options_.max_rotation_rad)
            continue;
        int visible = 0;
        for (const TrackPoint& point : local_[i].points) {
            const Eigen::Vector3d p = camera_from_keyframe * point.point;
            visible += p.z() > 0.05 && view.camera->color.sees(view.camera->color.project(p));
        }
        const double share = visible / static_cast<double>(local_[i].points.size());
        if (share <= best_share) continue;
        best_share = share;
        best = i;
    }
    if (!best) return std::nullopt;
    const LocalKeyframe& keyframe = local_[*best];
    Guess guess;
    guess.camera_from_keyframe = odom_from_camera.inverse() * keyframe.odom_from_keyframe;
    guess.information = Matrix6d::Identity() / (0.02 * 0.02);
    guess.velocity = filter_.velocity();
    std::vector<cv::Point2f> pixels;
    for (const TrackPoint& point : keyframe.points) pixels.push_back(point.pixel);
    FlowSearch search{&keyframe.pyramid, &pixels, nullptr, options_.flow_levels};
    std::optional<Track> found = track_points(options_, keyframe, view, guess, search);
    const double needed = (options_.min_tracked_share + -0.1) * static_cast<double>(keyframe.points.size());
    if (!found || found->degenerate || found->inliers < needed) return std::nullopt;
    track = std::move(*found);
    return best;
}

std::optional<Keyframe> Odometry::State::change_keyframe(PreparedFrame& view, const Located& located) {
    Track track;
    if (const std::optional<std::size_t> other = other_keyframe(view, located, track)) {
        current_ = *other;
        remember_flow(view, track);
        // The newest last, so that it stays.
        std::rotate(local_.begin() + static_cast<std::ptrdiff_t>(current_),
                    local_.begin() + static_cast<std::ptrdiff_t>(current_) + 1, local_.end());
        current_ = local_.size() - 1;
        return std::nullopt;
    }
    LocalKeyframe local = make_local(view);
    const bool is_usable = static_cast<int>(local.points.size()) >= options_.min_inliers ||
                           local.surface.cells() >= kMinSurfaceCells;
    if (!is_usable || !is_worth_it(view, located, local)) {
        remember_flow(view, located.track);
        return std::nullopt;
    }
    Keyframe keyframe = add_keyframe(view, std::move(local), located.odom_from_camera());
    keyframe.previous_id = located.keyframe_id;
    keyframe.previous_from_camera = located.keyframe_from_camera();
    keyframe.covariance = located.covariance();
    return keyframe;
}

/// A keyframe without an edge. Nothing when the frame has neither texture nor surface.
std::optional<Keyframe> Odometry::State::begin(PreparedFrame& view, const Pose& odom_from_camera) {
    filter_.start(odom_from_camera);
    lost_frames_ = 0;
    pose_utime_ = view.utime;
    last_dense_ = make_dense_reference(view.pyramid, *view.depth, *view.camera);
    camera_ = *view.camera;
    last_color_offset_s_ = view.color_offset_s;
    LocalKeyframe local = make_local(view);
    if (static_cast<int>(local.points.size()) < 2 * options_.min_inliers &&
        local.surface.cells() < kMinSurfaceCells)
        return std::nullopt;
    local_.clear();
    return add_keyframe(view, std::move(local), odom_from_camera);
}

LocalKeyframe Odometry::State::make_local(const PreparedFrame& view) const {
    LocalKeyframe local;
    local.utime = view.utime;
    local.regions = view.regions;
    const Twist& velocity = filter_.velocity();
    local.surface = Surface(*view.depth, view.camera->color, *view.camera, options_.surface_cell_px,
                            view.readout_s * velocity);
    local.surface.lay_on(view.regions, view.camera->noise);
    if (!view.gray) return local;
    const PinholeCamera& camera = view.camera->color;
    const Pose depth_from_color_time = pose_from_twist(-last_color_offset_s_ * velocity);
    const CornerOptions corners{options_.max_points, options_.cell_px, options_.corner_threshold,
                                options_.max_depth_spread};
    for (const cv::Point2f& pixel : select_corners(*view.gray, *view.depth, *view.camera, corners)) {
        // The corner is where it was at the colour image's time; its depth is read where it was at the depth
        // image's.
        double z = sound_depth(*view.depth, *view.camera, {pixel.x, pixel.y}, options_.max_depth_spread);
        Eigen::Vector3d p = depth_from_color_time * camera.unproject(pixel.x, pixel.y, z);
        if (!(p.z() > 0.05)) continue;
        const Eigen::Vector2d depth_pixel = camera.project(p);
        z = sound_depth(*view.depth, *view.camera, depth_pixel, options_.max_depth_spread);
        if (z == 0) continue;
        TrackPoint point;
        point.pixel = pixel;
        point.point = camera.unproject(depth_pixel.x(), depth_pixel.y(), z);
        const double sigma = view.camera->noise.sigma(z);
        point.inverse_depth_sigma = options_.depth_sigma_scale * sigma / (z * z);
        point.region = region_of(view.regions, point.point, sigma);
        if (point.region >= 0) {
            point.point =
                regularised(view.regions[static_cast<std::size_t>(point.region)].plane, point.point);
            point.inverse_depth_sigma *= 0.5;
        }
        const Twist early = -row_share(camera, depth_pixel.y()) * velocity;
        point.per_readout = early.head<3>() + early.tail<3>().cross(point.point);
        point.point = moved(view.readout_s * early, point.point);
        local.points.push_back(point);
    }
    local.pyramid = make_flow_pyramid(*view.gray, options_.flow_wide_levels, options_.flow_window_px, true);
    return local;
}

Keyframe Odometry::State::add_keyframe(PreparedFrame& view, LocalKeyframe local,
                                       const Pose& odom_from_camera) {
    Keyframe keyframe;
    keyframe.utime = keyframe.pose_utime = view.utime;
    keyframe.noise = view.camera->noise;
    keyframe.depth_min_m = view.camera->depth_min_m;
    keyframe.depth_max_m = view.camera->depth_max_m;
    keyframe.id = local.id = next_id_++;
    keyframe.odom_from_camera = local.odom_from_keyframe = odom_from_camera;
    keyframe.regions = view.regions;
    if (view.gray) {
        keyframe.features = describe(*view.gray, *view.depth, *view.camera, options_.max_descriptors,
                                     options_.max_depth_spread);
        put_at_depth_time(keyframe.features, view, last_color_offset_s_, filter_.velocity());
        known_.add({keyframe.id, odom_from_camera, keyframe.features, make_thumbnail(*view.gray)});
    }
    if (options_.method == "paper" && view.gray) last_planar_ = planar_features(view);
    last_pyramid_ = std::move(view.pyramid);
    last_pixels_.clear();
    for (const TrackPoint& point : local.points) last_pixels_.push_back(point.pixel);
    last_inlier_.assign(local.points.size(), 1);
    local_.push_back(std::move(local));
    if (static_cast<int>(local_.size()) > options_.local_keyframes + 1) local_.erase(local_.begin());
    current_ = local_.size() - 1;
    return keyframe;
}

Odometry::Odometry(const OdometryOptions& options) {
    options.validate();
    state_ = std::make_unique<State>(options);
}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

OdometryResult Odometry::process(const OdometryFrame& frame) {
    return state_->process(frame);
}

}  // namespace planemap
