// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odometry.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <utility>

#include "odometry/camera_motion.hpp"
#include "odometry/chains.hpp"
#include "odometry/keyframe_choice.hpp"
#include "odometry/keyframe_making.hpp"
#include "odometry/local_keyframes.hpp"
#include "odometry/method.hpp"
#include "odometry/motion_priors.hpp"
#include "odometry/news.hpp"
#include "odometry/prepared_frame.hpp"
#include "odometry/readout.hpp"
#include "odometry/relocaliser.hpp"

namespace planemap::odometry {
namespace {

/// Whether three standard deviations in any direction are less than 10 cm and 5 degrees.
bool says_where(const Matrix6d& covariance) {
    constexpr double kFar_m = 0.1, kFar_rad = 0.0873, kSigmas = 3;
    const auto worst = [](const Eigen::Matrix3d& block) {
        return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(block, Eigen::EigenvaluesOnly).eigenvalues()(2);
    };
    return kSigmas * kSigmas * worst(covariance.topLeftCorner<3, 3>()) < kFar_m * kFar_m &&
           kSigmas * kSigmas * worst(covariance.bottomRightCorner<3, 3>()) < kFar_rad * kFar_rad;
}

}  // namespace

class Odometry::State {
  public:
    explicit State(const OdometryOptions& options)
        : options_(options),
          motion_(options),
          keyframes_(options.local_keyframes),
          relocaliser_(options),
          priors_(options.motion),
          method_(make_method(options)) {}

    OdometryResult process(const OdometryFrame& input);
    std::optional<Keyframe> finish();
    void resume(std::span<const Keyframe> keyframes);
    void start_after(int id);
    bool hear(const MotionPrior& prior) { return priors_.hear(prior); }

  private:
    /// Frames without new colour after which it is no longer waited for.
    static constexpr int kPatience = 15;
    /// A frame without its colour has no points to follow: the next one would be tracked by depth alone.
    bool may_become_keyframe() const { return old_colors_ == 0 || old_colors_ > kPatience; }
    OdometryResult track(const OdometryFrame& input, const News& news);
    OdometryEstimate stay(std::int64_t utime) const;
    PriorUse take_prior(const PreparedFrame& frame, Located& located);
    OdometryResult find_again(PreparedFrame& frame);
    OdometryResult restart(PreparedFrame& frame);
    OdometryResult lose(PreparedFrame& frame);
    OdometryResult follow(PreparedFrame& frame, Located& located);
    std::optional<Keyframe> begin(PreparedFrame& frame);
    void change_keyframe(PreparedFrame& frame, const Located& located);
    Keyframe& add_keyframe(PreparedFrame& frame, LocalKeyframe local, const Located* located,
                           const FrameMotion& motion);
    void describe_waiting();
    Keyframe described_at_once();
    OdometryEstimate estimate_at(const Keyframe& keyframe) const;
    Matrix6d measured_covariance(const Located& located, const Guess& predicted) const;
    Matrix6d covariance_of_moment(const Located& located) const;

    OdometryOptions options_;
    CameraInfo camera_;
    std::int64_t utime_ = 0;  ///< of the last frame
    int next_id_ = 0;
    Chains chains_;
    bool resumed_ = false;  ///< and no place was found yet
    Readout readout_;
    CameraMotion motion_;
    LocalKeyframes keyframes_;
    Relocaliser relocaliser_;
    std::unique_ptr<UndescribedKeyframe> waiting_;  ///< the frame before's, to be described in this one
    std::optional<Keyframe> described_;             ///< and not given to the caller yet
    MotionPriors priors_;
    std::unique_ptr<Method> method_;
    NewsWatch watch_;
    DepthImage no_depth_;                        ///< without a reading, of the colour camera's size
    int old_colors_ = 0;                         ///< frames in a row whose colour was not new
    OdometryEstimate last_;                      ///< of the last frame that was not stale
    Matrix6d last_measured_ = Matrix6d::Zero();  ///< its covariance without what its moment adds
    int unseen_steps_ = 0;  ///< frames in a row that knew a direction by the prediction alone
};

OdometryResult Odometry::State::process(const OdometryFrame& input) {
    check(input);
    describe_waiting();
    const News news = watch_.see(input);
    OdometryResult result;
    if (news.any() || keyframes_.empty()) {
        OdometryFrame told = input;
        if (news.color != News::Image::kNew) told.gray = nullptr;
        old_colors_ = input.gray != nullptr && told.gray == nullptr ? old_colors_ + 1 : 0;
        if (news.depth != News::Image::kNew) {
            no_depth_ = DepthImage(input.depth->width, input.depth->height);
            told.depth = &no_depth_;
            told.regions = {};
        }
        result = track(told, news);
        if (result.estimate.status != TrackingStatus::kStale) last_ = result.estimate;
    } else {
        result.estimate = stay(input.utime);
    }
    result.described = std::exchange(described_, std::nullopt);
    result.news = news;
    result.estimate.utime = result.estimate.pose_utime = input.utime;
    result.estimate.chain = chains_.of(result.estimate.keyframe_id);
    return result;
}

/// Where the camera is when nothing new was seen: where it was, as far as it cannot have moved since.
OdometryEstimate Odometry::State::stay(std::int64_t utime) const {
    OdometryEstimate estimate = last_;
    if (estimate.status == TrackingStatus::kLost) return estimate;
    estimate.status = TrackingStatus::kStale;
    const double elapsed = motion_.seconds_since_pose(utime);
    const Guess guess = motion_.stand_still(utime, keyframes_.current().odom_from_keyframe);
    const Twist moved = elapsed * motion_.velocity();
    estimate.covariance += guess.information.diagonal().cwiseInverse().asDiagonal();
    estimate.covariance += moved * moved.transpose();
    estimate.velocity.setZero();
    estimate.features = estimate.inliers = 0;
    estimate.residual_px = 0;
    return estimate;
}

OdometryResult Odometry::State::track(const OdometryFrame& input, const News& news) {
    const bool other_camera = !keyframes_.empty() && !(*input.camera == camera_);
    if (keyframes_.empty() || other_camera) input.camera->validate();
    PreparedFrame frame =
        prepare(options_, input, motion_.knows_velocity(input.utime) ? readout_.seconds() : 0);
    const bool starts = keyframes_.empty() || other_camera || input.utime < utime_;
    utime_ = input.utime;
    if (other_camera) {
        relocaliser_.clear();
        readout_ = {};
    }
    if (resumed_ && !other_camera) return find_again(frame);
    if (starts) return restart(frame);
    std::optional<Located> located = method_->locate(frame, {motion_, keyframes_, relocaliser_});
    if (located) {
        const PriorUse prior = take_prior(frame, *located);
        OdometryResult result = follow(frame, *located);
        result.prior = prior;
        return result;
    }
    // What is missing comes with the next image that is new.
    if (const OdometryEstimate stale = stay(frame.utime); !news.is_whole() && is_placed(stale)) {
        OdometryResult result;
        result.estimate = stale;
        return result;
    }
    return lose(frame);
}

PriorUse Odometry::State::take_prior(const PreparedFrame& frame, Located& located) {
    const LocalKeyframe* const keyframe = keyframes_.find(located.keyframe_id);
    if (keyframe == nullptr || located.relocalised) return PriorUse::kNone;
    return priors_.apply(located.track, keyframe->utime, frame.utime, frame.camera->body_from_camera);
}

void Odometry::State::resume(std::span<const Keyframe> keyframes) {
    if (keyframes.empty()) return;
    for (const Keyframe& keyframe : keyframes) {
        relocaliser_.add(keyframe);
        chains_.remember(keyframe.id, keyframe.chain);
        next_id_ = std::max(next_id_, keyframe.id + 1 + kIdsLeftOut);
    }
    motion_.stand_at(keyframes.back().odom_from_camera, keyframes.back().utime);
    resumed_ = true;
}

void Odometry::State::start_after(int id) {
    describe_waiting();
    next_id_ = std::max(next_id_, id + 1 + kIdsLeftOut);
    keyframes_.clear();
    relocaliser_.clear();
}

/// After resume(): lost, until a place is known again; after max_lost_frames a part of its own begins.
OdometryResult Odometry::State::find_again(PreparedFrame& frame) {
    OdometryResult result;
    std::optional<Located> located;
    if (frame.gray) located = relocaliser_.locate(frame, motion_, keyframes_);
    if (!located) {
        motion_.lose();
        resumed_ = motion_.lost_frames() < options_.max_lost_frames;
        return resumed_ ? result : restart(frame);
    }
    motion_.follow(frame.utime, *located);
    last_measured_.setZero();
    unseen_steps_ = 0;
    method_->begin(frame);
    camera_ = *frame.camera;
    const FrameMotion motion{motion_.velocity(), frame.color_offset_s};
    LocalKeyframe local = make_local_keyframe(options_, frame, motion);
    if (!can_be_tracked_against(local, options_.min_inliers)) return result;
    resumed_ = false;
    add_keyframe(frame, std::move(local), &*located, motion);
    Keyframe keyframe = described_at_once();
    result.estimate = estimate_at(keyframe);
    result.estimate.features = located->track.tried;
    result.estimate.inliers = located->track.inliers;
    result.keyframe = std::move(keyframe);
    return result;
}

OdometryResult Odometry::State::restart(PreparedFrame& frame) {
    OdometryResult result;
    result.keyframe = begin(frame);
    if (!result.keyframe) {
        keyframes_.clear();
        return result;
    }
    result.estimate = estimate_at(*result.keyframe);
    result.estimate.features = result.estimate.inliers = static_cast<int>(keyframes_.current().points.size());
    return result;
}

OdometryResult Odometry::State::lose(PreparedFrame& frame) {
    OdometryResult result;
    motion_.lose();
    method_->lose();
    if (motion_.lost_frames() >= options_.max_lost_frames) result.keyframe = begin(frame);
    if (result.keyframe) result.estimate = estimate_at(*result.keyframe);
    return result;
}

OdometryResult Odometry::State::follow(PreparedFrame& frame, Located& located) {
    if (motion_.knows_velocity(frame.utime) && !located.relocalised)
        readout_.learn(frame.readout_s, located.track.alignment);
    keyframes_.make_current(located.keyframe_id);
    const double elapsed = motion_.seconds_since_pose(frame.utime);
    unseen_steps_ = located.track.degenerate && !located.track.by_prior ? unseen_steps_ + 1 : 0;
    last_measured_ = measured_covariance(located, motion_.predict(frame.utime, located.odom_from_keyframe));
    motion_.follow(frame.utime, located);
    method_->follow(frame, located, elapsed);

    OdometryResult result;
    OdometryEstimate& estimate = result.estimate;
    estimate.odom_from_camera = located.odom_from_camera();
    estimate.keyframe_id = located.keyframe_id;
    estimate.keyframe_from_camera = located.keyframe_from_camera();
    estimate.covariance = last_measured_ + covariance_of_moment(located);
    const bool is_sure = !located.track.degenerate && says_where(estimate.covariance);
    estimate.status = is_sure ? TrackingStatus::kTracked : TrackingStatus::kDegenerate;
    estimate.features = located.track.tried;
    estimate.inliers = located.track.inliers;
    estimate.residual_px = located.track.alignment.residual_px;
    estimate.velocity = -motion_.velocity();  // of the camera in the world, not of the world in its frame
    if (may_become_keyframe() && (located.relocalised || has_moved(options_, located) ||
                                  method_->wants_keyframe(frame, located, keyframes_.current())))
        change_keyframe(frame, located);
    else
        method_->go_on_from(frame, located.track);
    return result;
}

OdometryEstimate Odometry::State::estimate_at(const Keyframe& keyframe) const {
    OdometryEstimate estimate;
    estimate.status = TrackingStatus::kTracked;
    estimate.odom_from_camera = motion_.odom_from_camera();
    estimate.keyframe_id = keyframe.id;
    return estimate;
}

/// Located::covariance(); and where a direction is known by the prediction alone, that starts from a pose
/// that is no surer, and uncertainty adds up from frame to frame. So does that of the velocity, of which
/// nobody sees how it changes: by white accelerations, the n-th step is n times as uncertain as the first.
/// Not where a motion prior says it, whose own uncertainty grows with the way. Before the motion follows it.
Matrix6d Odometry::State::measured_covariance(const Located& located, const Guess& predicted) const {
    Matrix6d covariance = located.covariance();
    if (unseen_steps_ == 0) return covariance;
    const bool goes_on = last_.status != TrackingStatus::kLost && last_.keyframe_id == located.keyframe_id;
    const Matrix6d before = goes_on ? last_measured_ : Matrix6d::Zero();
    const double steps2 = static_cast<double>(unseen_steps_) * unseen_steps_;
    const auto inverse = [](const Matrix6d& matrix) -> Matrix6d {
        return matrix.ldlt().solve(Matrix6d::Identity());
    };
    const Matrix6d& information = located.track.alignment.information;
    const Matrix6d from_last = inverse(steps2 * inverse(predicted.information) + before);
    const Matrix6d surer = inverse(information),
                   unsurer = inverse(information - predicted.information + from_last);
    return covariance + 0.5 * (unsurer + unsurer.transpose()) - 0.5 * (surer + surer.transpose());
}

/// After the motion has followed it. It is not in keyframes' edges: loop closures are without it, too, and
/// the graph weighs one against the other.
Matrix6d Odometry::State::covariance_of_moment(const Located& located) const {
    const LocalKeyframe* keyframe = keyframes_.find(located.keyframe_id);
    return motion_.covariance_of_moment(located, keyframe ? keyframe->velocity : Twist::Zero());
}

/// A keyframe without an edge. Nothing when the frame has neither texture nor surface.
std::optional<Keyframe> Odometry::State::begin(PreparedFrame& frame) {
    camera_ = *frame.camera;
    const FrameMotion at_rest{Twist::Zero(), frame.color_offset_s};
    LocalKeyframe local = make_local_keyframe(options_, frame, at_rest);
    // Where nothing can begin, the last pose stays as old as it is.
    if (!can_be_tracked_against(local, 2 * options_.min_inliers)) return std::nullopt;
    motion_.start(frame.utime);
    last_measured_.setZero();
    unseen_steps_ = 0;
    method_->begin(frame);
    keyframes_.clear();
    add_keyframe(frame, std::move(local), nullptr, at_rest);
    return described_at_once();
}

/// Goes over to another keyframe that is known, else to a new one of this frame, where that is of use.
void Odometry::State::change_keyframe(PreparedFrame& frame, const Located& located) {
    if (const std::optional<Return> other =
            find_other_keyframe(options_, keyframes_, frame, located, motion_.velocity())) {
        keyframes_.renew(other->id);
        method_->go_on_from(frame, other->track);
        return;
    }
    const Track& track = located.track;
    const FrameMotion motion{motion_.velocity(),
                             track.by_features ? track.alignment.color_offset_s : frame.color_offset_s};
    LocalKeyframe local = make_local_keyframe(options_, frame, motion);
    if (!can_be_tracked_against(local, options_.min_inliers) ||
        !is_worth_it(options_, keyframes_.current(), frame, located, local)) {
        method_->go_on_from(frame, track);
        return;
    }
    Keyframe& keyframe = add_keyframe(frame, std::move(local), &located, motion);
    // Where all is seen as loop closures have it, so that edges and closures weigh alike in the graph.
    keyframe.covariance =
        located.track.degenerate ? last_measured_ : assumed_covariance(located.track.alignment);
}

/// With an edge from where the frame was located; nullptr: without one, at the last pose, and a chain begins.
/// It then waits to be described. Precondition: none waits.
Keyframe& Odometry::State::add_keyframe(PreparedFrame& frame, LocalKeyframe local, const Located* located,
                                        const FrameMotion& motion) {
    waiting_ = std::make_unique<UndescribedKeyframe>(frame, motion);
    Keyframe& keyframe = waiting_->keyframe;
    keyframe.id = local.id = next_id_++;
    local.utime = frame.utime;
    keyframe.odom_from_camera = local.odom_from_keyframe =
        located ? located->odom_from_camera() : motion_.odom_from_camera();
    if (located) {
        keyframe.previous_id = located->keyframe_id;
        keyframe.previous_from_camera = located->keyframe_from_camera();
        keyframe.covariance = located->covariance();
    }
    keyframe.chain = chains_.add(keyframe.id, keyframe.previous_id);
    method_->go_on_from(frame, local);
    keyframes_.add(std::move(local));
    return keyframe;
}

/// The keyframe that waits is described, and the relocaliser knows it.
Keyframe Odometry::State::described_at_once() {
    Keyframe keyframe = waiting_->described(options_);
    if (waiting_->has_color()) relocaliser_.add(keyframe);
    waiting_.reset();
    return keyframe;
}

void Odometry::State::describe_waiting() {
    if (waiting_) described_ = described_at_once();
}

std::optional<Keyframe> Odometry::State::finish() {
    describe_waiting();
    return std::exchange(described_, std::nullopt);
}

Odometry::Odometry(const OdometryOptions& options) {
    options.validate();
    state_ = std::make_unique<State>(options);
}
Odometry::~Odometry() = default;
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;

void Odometry::resume(std::span<const Keyframe> keyframes) {
    state_->resume(keyframes);
}

bool Odometry::hear(const MotionPrior& prior) {
    return state_->hear(prior);
}

void Odometry::start_after(int id) {
    state_->start_after(id);
}

std::optional<Keyframe> Odometry::finish() {
    return state_->finish();
}

OdometryResult Odometry::process(const OdometryFrame& frame) {
    return state_->process(frame);
}

}  // namespace planemap::odometry
