// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/odometry_shell.hpp"

#include <algorithm>
#include <utility>

#include "messages/channels.hpp"
#include "messages/decode.hpp"
#include "messages/keyframe_watch.hpp"

namespace planemap::odometry {

namespace {

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
                             const OdometryOptions& options)
    : bus_(bus), decoder_(std::move(decoder)), odometry_(options) {
    decoder_->subscribe(status_, 8, [this](auto frame) { on_frame(std::move(frame)); });
    bus_.subscribe(messages::channels::kRegions,
                   status_.guard([this](const messages::RawMessage& m) { on_regions(m); }), 8);
    // Only until it is known how the body lies; the newest is enough.
    bus_.subscribe(
        messages::channels::kTrajectory, [this](const messages::RawMessage& m) { on_trajectory(m); }, 1);
    bus_.subscribe(
        messages::channels::kMap, [this](const messages::RawMessage& m) { on_map(m); }, 1);
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

void OdometryShell::on_trajectory(const messages::RawMessage& message) {
    if (body_.is_known() || !first_keyframe_) return;
    const KeyframeTrajectory trajectory =
        messages::from_message(messages::decode<trajectory_t>(message.bytes));
    for (const KeyframePose& keyframe : trajectory.keyframes) {
        if (keyframe.id == first_keyframe_->id && keyframe.utime == first_keyframe_->utime)
            odom_from_world_ = first_keyframe_->odom_from_camera * keyframe.world_from_camera.inverse();
    }
}

void OdometryShell::on_map(const messages::RawMessage& message) {
    if (body_.is_known() || !odom_from_world_) return;
    const Eigen::Vector3f up = messages::from_message(messages::decode<plane_map_t>(message.bytes)).up;
    if (!up.isZero()) body_.hear_up(odom_from_world_->linear() * up.cast<double>());
}

/// POSE_BODY, and once a second of the frames' time how its frames lie about ours, for those who come late.
void OdometryShell::publish_body(const OdometryEstimate& estimate, const CameraInfo& camera) {
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
    // While messages come one after the other, the regions may be among those that the bus holds.
    const bool quiet = !std::exchange(heard_, false);
    if (quiet && !waiting_.empty() && Clock::now() - waiting_.front().since > kMaxWait) {
        ++missing_;
        process_front();
        process_ready(missing_ >= kMaxMissing ? 0 : kMaxWaiting);
    }
    return waiting_.empty() ? kIdle_ms : kWaiting_ms;
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
    if (input.regions) in.regions = input.regions->regions;
    OdometryResult result;
    {
        const messages::ModuleStatus::Work work(status_);
        result = odometry_.process(in);
    }
    bus_.publish(messages::channels::kOdometry,
                 messages::to_message(result.estimate, odometry_seq_++, bus_.session()));
    if (result.estimate.status != TrackingStatus::kLost) publish_body(result.estimate, frame.camera());
    if (const auto& keyframe = result.keyframe) {
        if (!first_keyframe_) first_keyframe_ = {keyframe->id, keyframe->utime, keyframe->odom_from_camera};
        bus_.publish(messages::channels::kKeyframe,
                     messages::to_message(*keyframe, keyframe_seq_++, bus_.session()));
        messages::remark_new_part(status_, keyframe->id, keyframe->previous_id, keyframe->utime);
    }
    status_.published();
    const bool is_lost = result.estimate.status == TrackingStatus::kLost;
    const char* const fault = is_lost ? fault_of_depth(frame) : nullptr;
    if (fault != nullptr) status_.lost(fault);
    status_.set_text(is_lost ? "lost"
                             : "tracked, " + std::to_string(result.estimate.inliers) + " of " +
                                   std::to_string(result.estimate.features) + " features; " + body_.text());
}

void OdometryShell::finish() {
    process_ready(0);
}

}  // namespace planemap::odometry
