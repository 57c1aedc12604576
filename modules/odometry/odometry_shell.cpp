// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odometry_shell.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <bot_core/pose_t.hpp>
#include <bot_core/rigid_transform_t.hpp>
#include <planemap/module_status_t.hpp>
#include <stdexcept>
#include <utility>

#include "messages/channels.hpp"
#include "messages/decode.hpp"
#include "messages/keyframe_watch.hpp"

namespace planemap::odometry {

namespace {

constexpr std::size_t kMostApart = 64;  // odom frames beside the first that are known

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
    : bus_(bus), decoder_(std::move(decoder)), odometry_(options) {
    if (!journal.empty()) {
        journal_ = std::make_unique<messages::Journal>(journal);
        resume();
    }
    decoder_->subscribe(status_, 8, [this](auto frame) { on_frame(std::move(frame)); });
    // Only until it is known how the body lies; the newest is enough.
    bus_.subscribe(
        messages::channels::kTrajectory, [this](const messages::RawMessage& m) { on_trajectory(m); }, 1);
    bus_.subscribe(
        messages::channels::kMap, [this](const messages::RawMessage& m) { on_map(m); }, 1);
    bus_.subscribe(messages::channels::kRegions,
                   status_.guard([this](const messages::RawMessage& m) { on_regions(m); }), 8);
    if (!options.motion.channel.empty()) hear_priors(options.motion.channel);
    if (!bus_.is_network()) return;
    for (const char* module : {"GRAPH", "MAP", "OCTOMAP"})
        bus_.subscribe(std::string(messages::channels::kStatusPrefix) + module,
                       [this](const messages::RawMessage& m) { on_status(m); });
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
    bot_core::rigid_transform_t body;
    body.utime = messages::checked_utime(pose.utime, "pose.utime");
    std::copy(pose.pos, pose.pos + 3, body.trans);
    std::copy(pose.orientation, pose.orientation + 4, body.quat);
    if (!odometry_.hear({body.utime, messages::from_message(body)})) status_.count_loss(kPriorBroken);
}

/// Takes the keyframes that the process before made.
void OdometryShell::resume() {
    for (const std::string& complaint : journal_->complaints()) spdlog::warn("odometry: {}", complaint);
    std::vector<Keyframe> keyframes;
    journal_->replay([&](const messages::LogEvent& event) {
        try {
            keyframes.push_back(messages::from_message(messages::decode<keyframe_t>(event.bytes)));
        } catch (const messages::MessageError& error) {
            bus_.complaints().add(journal_->file().string() + ": a keyframe left out: " + error.what());
        }
    });
    odometry_.resume(keyframes);
    if (!keyframes.empty()) {
        const Keyframe& first = keyframes.front();
        first_keyframe_ = {first.id, first.utime, first.odom_from_camera};
        first_chain_ = first.chain;
        newest_id_ = keyframes.back().id + Odometry::kIdsLeftOut;
    }
    if (!keyframes.empty())
        spdlog::info("odometry: knows {} keyframes of {}; lost until it finds a place that they saw",
                     keyframes.size(), journal_->file().string());
}

/// A module that was started again has missed what was sent meanwhile.
void OdometryShell::on_status(const messages::RawMessage& message) {
    const auto status = messages::decode<module_status_t>(message.bytes);
    if (status.state == module_status_t::STOPPED) return;
    const auto [known, is_first] = sessions_.try_emplace(status.module, status.session);
    if (is_first || known->second == status.session) return;
    known->second = status.session;
    send_again();
}

void OdometryShell::send_again() {
    for (const Sent& sent : sent_)
        if (Clock::now() - sent.at < kSendAgain)
            bus_.publish_bytes(messages::channels::kKeyframe, sent.bytes);
}

void OdometryShell::publish(const Keyframe& keyframe) {
    constexpr std::size_t kMostSent = 32;
    newest_id_ = std::max(newest_id_, keyframe.id);
    const keyframe_t message = messages::to_message(keyframe, keyframe_seq_++, bus_.session());
    std::vector<std::uint8_t> bytes = messages::to_bytes(message);
    if (journal_)
        journal_->add(messages::channels::kKeyframe, bytes);  // first: an id that is known is given once
    bus_.publish_bytes(messages::channels::kKeyframe, bytes);
    messages::remark_new_part(status_, keyframe.id, keyframe.previous_id, keyframe.utime);
    if (!bus_.is_network()) return;
    sent_.push_back({Clock::now(), std::move(bytes)});
    if (sent_.size() > kMostSent) sent_.pop_front();
}

/// After its keyframe: what a frame says of the place.
void OdometryShell::publish_look(const OdometryResult& result, std::span<const PlanarRegion> regions) {
    if (result.keyframe) return looks_.begin(*result.keyframe);
    if (const std::optional<Look> look = looks_.see(result.estimate, regions))
        bus_.publish(messages::channels::kLook, messages::to_message(*look, look_seq_++, bus_.session()));
}

void OdometryShell::on_frame(std::shared_ptr<const messages::Frame> frame) {
    heard_ = true;
    Waiting input{std::move(frame), std::nullopt};
    const auto early =
        std::find_if(early_regions_.begin(), early_regions_.end(),
                     [&](const messages::FrameRegions& r) { return r.utime == input.frame->utime(); });
    if (early != early_regions_.end()) {
        input.regions = std::move(*early);
        early_regions_.erase(early);
    }
    waiting_.push_back(std::move(input));
    process_ready(missing_ >= kMaxMissing && !bus_.in_process() ? 0 : kMaxWaiting);
}

void OdometryShell::on_regions(const messages::RawMessage& message) {
    messages::FrameRegions regions =
        messages::from_message(messages::decode<planar_regions_t>(message.bytes));
    missing_ = 0;
    heard_ = true;
    const auto input = std::find_if(waiting_.begin(), waiting_.end(),
                                    [&](const Waiting& w) { return w.frame->utime() == regions.utime; });
    if (input != waiting_.end()) {
        input->regions = std::move(regions);
        // Regions come in the frames' order: none will come for those before.
        for (auto before = input - waiting_.begin(); before > 0; --before) process_front();
        process_ready(kMaxWaiting);
        return;
    }
    const bool twice = std::any_of(early_regions_.begin(), early_regions_.end(),
                                   [&](const auto& early) { return early.utime == regions.utime; });
    if (twice || (handled_utime_ && regions.utime <= *handled_utime_))
        return status_.lost("regions that came late or twice");
    early_regions_.push_back(std::move(regions));
    if (early_regions_.size() > kMaxWaiting) {
        early_regions_.pop_front();
        status_.lost("regions that no frame waited for");
    }
}

void OdometryShell::process_ready(std::size_t max_waiting) {
    while (!waiting_.empty() && (waiting_.front().regions || waiting_.size() > max_waiting)) {
        if (!waiting_.front().regions) ++missing_;
        process_front();
    }
}

void OdometryShell::process_front() {
    const Waiting input = std::move(waiting_.front());
    waiting_.pop_front();
    handled_utime_ = input.frame->utime();
    if (!input.regions) status_.lost("frames handled without their regions");
    process(input);
}

int OdometryShell::poll() {
    constexpr int kIdle_ms = 100, kWaiting_ms = 20;
    if (journal_) tend_journal();
    // While messages come one after the other, the regions may be among those that the bus holds.
    const bool quiet = !std::exchange(heard_, false);
    if (quiet && !waiting_.empty() && Clock::now() - waiting_.front().since > kMaxWait) {
        ++missing_;
        process_front();
        process_ready(missing_ >= kMaxMissing ? 0 : kMaxWaiting);
    }
    return waiting_.empty() ? kIdle_ms : kWaiting_ms;
}

/// As many keyframes as are looked at for a known place, and no more, are worth keeping.
void OdometryShell::tend_journal() {
    if (journal_->is_due_to_compact()) {
        constexpr std::int64_t kKept = 200;
        std::int64_t last = 0;
        journal_->replay([&](const messages::LogEvent& event) { last = event.number; });
        journal_->compact([&](const messages::LogEvent& event) { return event.number > last - kKept; });
    }
    if (const auto news = journal_->news()) status_.remark("journal", *news);
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

void OdometryShell::process(const Waiting& input) {
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
    try {
        in.gray = frame.gray();
        in.color_utime = frame.color_utime();
    } catch (const messages::MessageError& error) {  // a broken colour image leaves a good depth image
        status_.decode_error();
        status_.set_text(error.what());
        bus_.complaints().add(std::string(messages::channels::kFrame) + ": colour left out: " + error.what());
    }
    if (in.gray != nullptr && registration_.see(in.utime, *in.depth, *in.gray)) {
        if (const auto complaint = registration_.complaint()) status_.remark("registration", *complaint);
    }
    if (input.regions) in.regions = input.regions->regions;
    OdometryResult result;
    {
        const messages::ModuleStatus::Work work(status_);
        result = odometry_.process(in);
    }
    bus_.publish(messages::channels::kOdometry,
                 messages::to_message(result.estimate, odometry_seq_++, bus_.session()));
    count(result.news);
    count(result.prior);
    if (result.keyframe) remember_chain(*result.keyframe);
    publish_body(result.estimate, frame.camera());
    if (result.keyframe) publish(*result.keyframe);
    if (result.news.depth == News::Image::kNew) publish_look(result, in.regions);
    status_.published(result.estimate.utime, messages::now_us());
    const bool is_lost = result.estimate.status == TrackingStatus::kLost;
    const char* const fault = is_lost ? fault_of_depth(frame) : nullptr;
    if (fault != nullptr) status_.lost(fault);
    status_.set_text(text_of(result.estimate) + (is_lost ? "" : "; " + body_.text()));
}

/// The first keyframe of each odom frame, by which a trajectory says how they lie about each other.
void OdometryShell::remember_chain(const Keyframe& keyframe) {
    const Start start{keyframe.id, keyframe.utime, keyframe.odom_from_camera};
    if (!first_keyframe_) {
        first_keyframe_ = start;
        first_chain_ = keyframe.chain;
    } else if (keyframe.chain == keyframe.id) {
        apart_[keyframe.chain] = start;
        if (apart_.size() > kMostApart) apart_.erase(apart_.begin());
    }
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
    if ((body_.is_known() && apart_.empty()) || !first_keyframe_) return;
    const KeyframeTrajectory trajectory = messages::from_message(received);
    const auto named = [&](const Start& start) {
        const auto found = std::find_if(
            trajectory.keyframes.begin(), trajectory.keyframes.end(),
            [&](const KeyframePose& pose) { return pose.id == start.id && pose.utime == start.utime; });
        return found == trajectory.keyframes.end() ? nullptr : &*found;
    };
    const KeyframePose* first = named(*first_keyframe_);
    if (first == nullptr) return;
    odom_from_world_ = first_keyframe_->odom_from_camera * first->world_from_camera.inverse();
    std::erase_if(apart_, [&](const auto& entry) {
        const auto& [chain, start] = entry;
        const KeyframePose* pose = named(start);
        if (pose == nullptr || pose->component != first->component) return false;
        first_from_odom_[chain] =
            *odom_from_world_ * pose->world_from_camera * start.odom_from_camera.inverse(Eigen::Isometry);
        return true;
    });
    while (first_from_odom_.size() > kMostApart) first_from_odom_.erase(first_from_odom_.begin());
}

void OdometryShell::on_map(const messages::RawMessage& message) {
    if (body_.is_known() || !odom_from_world_) return;
    const Eigen::Vector3f up = messages::from_message(messages::decode<plane_map_t>(message.bytes)).up;
    if (!up.isZero()) body_.hear_up(odom_from_world_->linear() * up.cast<double>());
}

/// POSE_BODY, and once a second of the frames' time how its frames lie about ours, for those who come late.
/// After a loss it is silent until a loop closure says how the odom frame lies about the first one.
void OdometryShell::publish_body(OdometryEstimate estimate, const CameraInfo& camera) {
    if (!is_tracked(estimate.status)) return;
    const auto known = first_from_odom_.find(estimate.chain);
    const bool is_apart = estimate.chain != first_chain_ && known == first_from_odom_.end();
    if (is_apart != is_silent_) {
        is_silent_ = is_apart;
        status_.remark("body frame", is_apart
                                         ? "POSE_BODY is silent: where the camera is, relative to where it "
                                           "was before tracking was lost, is not known"
                                         : "");
    }
    if (is_apart) return;
    if (known != first_from_odom_.end())
        estimate.odom_from_camera = known->second * estimate.odom_from_camera;
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

void OdometryShell::finish() {
    process_ready(0);
}

}  // namespace planemap::odometry
