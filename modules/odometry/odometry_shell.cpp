// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odometry_shell.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <bot_core/pose_t.hpp>
#include <bot_core/rigid_transform_t.hpp>
#include <stdexcept>
#include <utility>

#include "messages/channels.hpp"
#include "messages/decode.hpp"

namespace planemap::odometry {

namespace {

std::string text_of(const OdometryEstimate& estimate) {
    if (estimate.status == TrackingStatus::kLost) return "lost";
    if (estimate.status == TrackingStatus::kStale) return "stale: nothing new says where it is";
    return (estimate.status == TrackingStatus::kDegenerate ? "degenerate, " : "tracked, ") +
           std::to_string(estimate.inliers) + " of " + std::to_string(estimate.features) + " features";
}

/// Why a lost frame's depth cannot be the help that it should be; nullptr when it can.
const char* fault_of_depth(const messages::Frame& frame) {
    constexpr double kHardlyAny = 0.01;  // share of an image's pixels
    const CameraInfo& camera = frame.camera();
    const auto share = [&](const DepthImage& depth) {
        const double low = camera.depth_min_m * camera.depth_units_per_metre,
                     high = camera.depth_max_m * camera.depth_units_per_metre;
        const auto count = std::count_if(depth.pixels.begin(), depth.pixels.end(), [&](std::uint16_t raw) {
            return is_valid_depth(raw) && raw >= low && raw <= high;
        });
        return static_cast<double>(count) / static_cast<double>(depth.pixels.size());
    };
    if (share(frame.depth()) < kHardlyAny) return OdometryShell::kNoReadings;
    return share(frame.depth_in_color()) < kHardlyAny ? OdometryShell::kBesideColor : nullptr;
}

}  // namespace

OdometryShell::OdometryShell(messages::Bus& bus, std::shared_ptr<messages::FrameDecoder> decoder,
                             const OdometryOptions& options, const std::filesystem::path& journal)
    : bus_(bus),
      decoder_(std::move(decoder)),
      odometry_(options),
      pairing_(status_, bus.in_process(), [this](const FrameWithRegions& input) { process(input); }),
      outbox_(bus, status_, journal) {
    resume();
    decoder_->subscribe(status_, 8, [this](auto frame) { pairing_.add(std::move(frame)); });
    // Only until it is known how the body lies; the newest is enough.
    bus_.subscribe(
        messages::channels::kTrajectory, [this](const messages::RawMessage& m) { on_trajectory(m); }, 1);
    bus_.subscribe(
        messages::channels::kMap, [this](const messages::RawMessage& m) { on_map(m); }, 1);
    bus_.subscribe(messages::channels::kRegions, status_.guard([this](const messages::RawMessage& m) {
        pairing_.add(messages::from_message(messages::decode<planar_regions_t>(m.bytes)));
    }),
                   8);
    motion_channel_ = options.motion.channel;
    if (!motion_channel_.empty()) hear_priors(motion_channel_);
}

void OdometryShell::hear_priors(const std::string& channel) {
    constexpr int kCapacity = 256;
    if (channel == messages::channels::kPose)
        throw std::invalid_argument("--motion-channel " + channel +
                                    ": is what planemap-odometry sends itself, no other's word");
    bus_.subscribe(channel, status_.guard([this](const messages::RawMessage& m) { on_prior(m); }), kCapacity);
}

void OdometryShell::on_prior(const messages::RawMessage& message) {
    const auto pose = messages::decode<bot_core::pose_t>(message.bytes);
    heard_prior_ = true;
    bot_core::rigid_transform_t body;
    body.utime = messages::checked_utime(pose.utime, "pose.utime");
    std::copy(pose.pos, pose.pos + 3, body.trans);
    std::copy(pose.orientation, pose.orientation + 4, body.quat);
    if (!odometry_.hear({body.utime, messages::from_message(body)})) status_.count_loss(kPriorBroken);
}

/// Takes the keyframes that the process before made.
void OdometryShell::resume() {
    const std::vector<Keyframe> keyframes = outbox_.earlier();
    odometry_.resume(keyframes);
    if (keyframes.empty()) return;
    frames_.add(keyframes.front());
    newest_id_ = keyframes.back().id + Odometry::kIdsLeftOut;
}

/// After its keyframe: what a frame says of the place.
void OdometryShell::publish_look(const OdometryResult& result, std::span<const PlanarRegion> regions) {
    if (result.keyframe) return looks_.begin(*result.keyframe);
    if (const std::optional<Look> look = looks_.see(result.estimate, regions))
        bus_.publish(messages::channels::kLook, messages::to_message(*look, look_seq_++, bus_.session()));
}

int OdometryShell::poll() {
    constexpr int kIdle_ms = 100, kWaiting_ms = 20;
    outbox_.tend_journal();
    return pairing_.poll() ? kWaiting_ms : kIdle_ms;
}

void OdometryShell::count(const News& news) {
    if (news.color == News::Image::kRepeated) status_.lost(kColorRepeats);
    if (news.color == News::Image::kLate) status_.lost(kColorLate);
    if (news.depth == News::Image::kRepeated) status_.lost(kDepthRepeats);
}

void OdometryShell::count(PriorUse prior) {
    if (prior == PriorUse::kNoMount) status_.lost(kPriorNoMount);
    if (prior == PriorUse::kStale) status_.lost(kPriorStale);
    if (prior == PriorUse::kContradictory) status_.lost(kPriorContradicts);
    if (prior == PriorUse::kDistrusted) status_.lost(kPriorDistrusted);
}

/// A broken colour image leaves a good depth image.
void OdometryShell::add_colour(const messages::Frame& frame, OdometryFrame& in) {
    try {
        in.gray = frame.gray();
        in.color_utime = frame.color_utime();
    } catch (const messages::MessageError& error) {
        status_.decode_error();
        status_.set_text(error.what());
        bus_.complaints().add(std::string(messages::channels::kFrame) + ": colour left out: " + error.what());
    }
    if (in.gray != nullptr && registration_.see(in.utime, *in.depth, *in.gray)) {
        if (const auto complaint = registration_.complaint()) status_.remark("registration", *complaint);
    }
}

OdometryResult OdometryShell::track(const OdometryFrame& frame) {
    const messages::ModuleStatus::Work work(status_);
    return odometry_.process(frame);
}

void OdometryShell::process(const FrameWithRegions& input) {
    const messages::Frame& frame = *input.frame;
    OdometryFrame in;
    in.utime = frame.utime();
    in.camera = &frame.camera();
    try {
        in.depth = &frame.depth_in_color();
    } catch (const messages::MessageError&
                 error) {  // here, not in a handler's guard: other frames wait behind this one
        status_.decode_error();
        status_.set_text(error.what());
        bus_.report(messages::channels::kFrame, error.what());
        return;
    }
    add_colour(frame, in);
    if (input.regions) in.regions = input.regions->regions;
    const OdometryResult result = track(in);
    if (result.described) {
        publish_keyframe(*result.described);
        looks_.begin(*result.described);
    }
    bus_.publish(messages::channels::kOdometry,
                 messages::to_message(result.estimate, odometry_seq_++, bus_.session()));
    count(result.news);
    count(result.prior);
    if (result.keyframe) publish_keyframe(*result.keyframe);
    publish_body(result.estimate, frame.camera());
    if (result.news.depth == News::Image::kNew) publish_look(result, in.regions);
    status_.published(result.estimate.utime, messages::now_us());
    const bool is_lost = result.estimate.status == TrackingStatus::kLost;
    const char* const fault = is_lost ? fault_of_depth(frame) : nullptr;
    if (fault != nullptr) status_.lost(fault);
    status_.set_text(text_of(result.estimate) + (is_lost ? "" : "; " + body_.text()));
}

void OdometryShell::on_trajectory(const messages::RawMessage& message) {
    const auto received = messages::decode<trajectory_t>(message.bytes);
    if (const int newest = received.ids.empty() ? -1 : received.ids.back(); newest > newest_id_) {
        if (newest > Odometry::kMostIdAfter)
            throw messages::MessageError("trajectory.ids: " + std::to_string(newest) + " is no keyframe's");
        odometry_.start_after(newest);
        newest_id_ = newest;
        status_.remark(
            "ids",
            "the graph knows keyframes of an odometry before this one, which this one does not: its "
            "ids begin after those, and what it tracks is a component of its own");
    }
    if (frames_.wants_trajectory(!body_.is_known())) frames_.hear(messages::from_message(received));
}

void OdometryShell::on_map(const messages::RawMessage& message) {
    if (body_.is_known() || !frames_.odom_from_world()) return;
    const Eigen::Vector3f up = messages::plane_map_from(message.bytes).up;
    if (!up.isZero()) body_.hear_up(frames_.odom_from_world()->linear() * up.cast<double>());
}

/// POSE_BODY, and once a second of the frames' time how its frames lie about ours, for those who come late.
/// After a loss it is silent until a loop closure says how the odom frame lies about the first one.
void OdometryShell::publish_body(OdometryEstimate estimate, const CameraInfo& camera) {
    if (!is_tracked(estimate.status)) return;
    const std::optional<Pose> first_from_odom = frames_.first_from(estimate.chain);
    const bool is_apart = !first_from_odom;
    if (is_apart != is_silent_) {
        is_silent_ = is_apart;
        status_.remark("body frame", is_apart
                                         ? "POSE_BODY is silent: where the camera is, relative to where it "
                                           "was before tracking was lost, is not known"
                                         : "");
    }
    if (is_apart) return;
    estimate.odom_from_camera = *first_from_odom * estimate.odom_from_camera;
    body_.see(estimate, camera.body_from_camera);
    if (!body_.is_known()) return;
    bus_.publish(messages::channels::kPose,
                 messages::to_message(body_.motion(estimate), estimate.pose_utime));
    if (body_.source() == BodyFrame::Source::kAssumed && !bus_.in_process())
        status_.remark("body", body_.text());
    if (frames_told_utime_ && std::abs(estimate.utime - *frames_told_utime_) < messages::kRepeat_us) return;
    frames_told_utime_ = estimate.utime;
    bus_.publish(messages::channels::kLocalFromOdom,
                 messages::to_rigid_transform(body_.local_from_odom(), estimate.utime));
    bus_.publish(messages::channels::kBodyFromCamera,
                 messages::to_rigid_transform(body_.body_from_camera(), estimate.utime));
}

void OdometryShell::publish_keyframe(const Keyframe& keyframe) {
    loose_.see(keyframe);
    frames_.add(keyframe);
    newest_id_ = std::max(newest_id_, keyframe.id);
    outbox_.publish(keyframe);
}

void OdometryShell::finish() {
    if (!motion_channel_.empty() && !heard_prior_)
        status_.remark("motion channel",
                       "no bot_core.pose_t came on " + motion_channel_ + ", the motion channel");
    pairing_.finish();
    if (const std::optional<Keyframe> last = odometry_.finish()) publish_keyframe(*last);
}

}  // namespace planemap::odometry
