// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odometry.hpp"

#include <algorithm>
#include <utility>

#include "odometry/camera_motion.hpp"
#include "odometry/chains.hpp"
#include "odometry/estimates.hpp"
#include "odometry/image_filter.hpp"
#include "odometry/keyframe_choice.hpp"
#include "odometry/keyframe_making.hpp"
#include "odometry/local_keyframes.hpp"
#include "odometry/method.hpp"
#include "odometry/motion_priors.hpp"
#include "odometry/prepared_frame.hpp"
#include "odometry/readout.hpp"
#include "odometry/relocaliser.hpp"
#include "odometry/waiting_keyframe.hpp"

namespace planemap::odometry {

class Odometry::State {
  public:
    explicit State(const OdometryOptions& options)
        : options_(options),
          motion_(options),
          keyframes_(options.local_keyframes),
          relocaliser_(options),
          waiting_(options_, relocaliser_),
          priors_(options.motion),
          method_(make_method(options)) {}

    OdometryResult process(const OdometryFrame& input);
    std::optional<Keyframe> finish();
    void resume(std::span<const Keyframe> keyframes);
    void start_after(int id);
    bool hear(const MotionPrior& prior) { return priors_.hear(prior); }

  private:
    OdometryResult track(const OdometryFrame& input, const News& news);
    OdometryEstimate stay(std::int64_t utime) const {
        return estimates_.stale(motion_, utime, keyframes_.current().odom_from_keyframe);
    }
    PriorUse take_prior(const PreparedFrame& frame, Located& located);
    OdometryResult find_again(PreparedFrame& frame);
    OdometryResult restart(PreparedFrame& frame);
    OdometryResult lose(PreparedFrame& frame);
    OdometryResult follow(PreparedFrame& frame, Located& located);
    std::optional<Keyframe> begin(PreparedFrame& frame);
    void change_keyframe(PreparedFrame& frame, const Located& located);
    Keyframe& add_keyframe(PreparedFrame& frame, LocalKeyframe local, const Located* located,
                           const FrameMotion& motion);

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
    WaitingKeyframe waiting_;  ///< of the frame before, to be described in this one
    MotionPriors priors_;
    std::unique_ptr<Method> method_;
    ImageFilter images_;
    Estimates estimates_;
};

OdometryResult Odometry::State::process(const OdometryFrame& input) {
    check(input);
    waiting_.describe();
    const News news = images_.see(input);
    OdometryResult result;
    if (news.any() || keyframes_.empty()) {
        result = track(images_.only_new(input, news), news);
        estimates_.said(result.estimate);
    } else {
        result.estimate = stay(input.utime);
    }
    result.described = waiting_.take();
    result.news = news;
    result.estimate.utime = result.estimate.pose_utime = input.utime;
    result.estimate.chain = chains_.of(result.estimate.keyframe_id);
    return result;
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
    waiting_.describe();
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
    estimates_.start();
    method_->begin(frame);
    camera_ = *frame.camera;
    const FrameMotion motion{motion_.velocity(), frame.color_offset_s};
    LocalKeyframe local = make_local_keyframe(options_, frame, motion);
    if (!can_be_tracked_against(local, options_.min_inliers)) return result;
    resumed_ = false;
    add_keyframe(frame, std::move(local), &*located, motion);
    Keyframe keyframe = waiting_.describe_at_once();
    result.estimate = Estimates::at(keyframe, motion_);
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
    result.estimate = Estimates::at(*result.keyframe, motion_);
    result.estimate.features = result.estimate.inliers = static_cast<int>(keyframes_.current().points.size());
    return result;
}

OdometryResult Odometry::State::lose(PreparedFrame& frame) {
    OdometryResult result;
    motion_.lose();
    method_->lose();
    if (motion_.lost_frames() >= options_.max_lost_frames) result.keyframe = begin(frame);
    if (result.keyframe) result.estimate = Estimates::at(*result.keyframe, motion_);
    return result;
}

OdometryResult Odometry::State::follow(PreparedFrame& frame, Located& located) {
    if (motion_.knows_velocity(frame.utime) && !located.relocalised)
        readout_.learn(frame.readout_s, located.track.alignment);
    keyframes_.make_current(located.keyframe_id);
    const double elapsed = motion_.seconds_since_pose(frame.utime);
    estimates_.expect(located, motion_, frame.utime);
    motion_.follow(frame.utime, located);
    method_->follow(frame, located, elapsed);

    OdometryResult result;
    result.estimate = estimates_.of(located, motion_, keyframes_.find(located.keyframe_id));
    // A frame without its colour has no points to follow: the next one would be tracked by depth alone.
    if (!images_.waits_for_color() && (located.relocalised || has_moved(options_, located) ||
                                       method_->wants_keyframe(frame, located, keyframes_.current())))
        change_keyframe(frame, located);
    else
        method_->go_on_from(frame, located.track);
    return result;
}

/// A keyframe without an edge. Nothing when the frame has neither texture nor surface.
std::optional<Keyframe> Odometry::State::begin(PreparedFrame& frame) {
    camera_ = *frame.camera;
    const FrameMotion at_rest{Twist::Zero(), frame.color_offset_s};
    LocalKeyframe local = make_local_keyframe(options_, frame, at_rest);
    // Where nothing can begin, the last pose stays as old as it is.
    if (!can_be_tracked_against(local, 2 * options_.min_inliers)) return std::nullopt;
    motion_.start(frame.utime);
    estimates_.start();
    method_->begin(frame);
    keyframes_.clear();
    add_keyframe(frame, std::move(local), nullptr, at_rest);
    return waiting_.describe_at_once();
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
    keyframe.covariance = located.track.degenerate ? estimates_.measured_covariance()
                                                   : assumed_covariance(located.track.alignment);
}

/// With an edge from where the frame was located; nullptr: without one, at the last pose, and a chain begins.
/// It then waits to be described. Precondition: none waits.
Keyframe& Odometry::State::add_keyframe(PreparedFrame& frame, LocalKeyframe local, const Located* located,
                                        const FrameMotion& motion) {
    Keyframe& keyframe = waiting_.begin(frame, motion);
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

std::optional<Keyframe> Odometry::State::finish() {
    waiting_.describe();
    return waiting_.take();
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
