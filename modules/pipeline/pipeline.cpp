// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/pipeline.hpp"

#include <algorithm>

#include "core/frame_poses.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"

namespace planemap::pipeline {

Pipeline::Pipeline(messages::Bus& bus, const PipelineOptions& options)
    : bus_(bus),
      decoder_(std::make_shared<messages::FrameDecoder>(bus, options.camera)),
      segmentation_(bus, decoder_, options.segmentation),
      odometry_(bus, decoder_, options.odometry) {
    if (options.poses) {
        given_poses_ = std::make_unique<GivenPoses>(bus, *options.poses);
    } else if (options.with_graph) {
        graph_ = std::make_unique<graph::GraphShell>(bus, options.graph);
    }
    if ((graph_ || given_poses_) && options.with_map)
        map_ = std::make_unique<map::MapShell>(bus, options.map);
    if (map_ && options.camera) map_->hear(*options.camera);
    if (options.with_octomap)
        octomap_ = std::make_unique<octomap::OctomapShell>(bus, decoder_, options.octomap);
    bus_.subscribe(messages::channels::kOdometry, [this, keep = options.keep_estimates](
                                                      const messages::RawMessage& message) {
        if (!keep) estimates_.clear();
        estimates_.push_back(messages::from_message(messages::decode<odometry_t>(message.bytes)));
    });
    if (graph_) {
        bus_.subscribe(messages::channels::kTrajectory, [this, keep = options.keep_estimates](
                                                            const messages::RawMessage& message) {
            if (!keep) poses_.keep_replaced([](int) { return false; });
            poses_.update(messages::from_message(messages::decode<trajectory_t>(message.bytes)).keyframes);
        });
    }
}

void Pipeline::finish() {
    settle();
    odometry_.finish();
    settle();
    finish_graph();
    if (map_) map_->finish();
    settle();
    if (octomap_) octomap_->finish();
}

/// Poses and surfaces say something about each other: a few times in turn.
void Pipeline::finish_graph() {
    constexpr int kRounds = 4;
    for (int i = 0; graph_ && i < kRounds; ++i) {
        graph_->finish();
        settle();
        if (!map_) return;
        map_->settle();
        settle();
        if (!graph_->has_new_surfaces()) return;
    }
}

const KeyframeTrajectory& Pipeline::keyframes() const {
    return given_poses_ ? given_poses_->keyframes() : graph_->graph().trajectory();
}

Trajectory Pipeline::trajectory() const {
    return trajectories().front().trajectory;
}

std::vector<ComponentTrajectory> Pipeline::trajectories() const {
    if (given_poses_) {
        Trajectory trajectory;
        for (const OdometryEstimate& estimate : estimates_) {
            const auto pose = given_pose(given_poses_->poses(), estimate.pose_utime);
            if (pose) trajectory.push_back({estimate.pose_utime, *pose});
        }
        return {{largest_component(given_poses_->keyframes()), std::move(trajectory)}};
    }
    return place_frames(estimates_, poses_, graph_ ? graph_->graph().trajectory() : KeyframeTrajectory());
}

std::optional<std::string> Pipeline::reason_lost() {
    const auto lost = std::count_if(
        estimates_.begin(), estimates_.end(),
        [](const OdometryEstimate& estimate) { return estimate.status == TrackingStatus::kLost; });
    const messages::ModuleStatus& status = odometry_.status();
    const auto count_of = [&](const char* reason) {
        const auto found = status.losses().find(reason);
        return found == status.losses().end() ? 0 : found->second;
    };
    // Frames that never reached the odometry: no estimate tells of them.
    std::pair<std::int64_t, const char*> most{status.decode_error_count(), "frames that are corrupt"};
    std::int64_t refused = most.first;
    for (const char* reason : messages::FrameDecoder::refusals()) {
        refused += count_of(reason);
        most = std::max(most, {count_of(reason), reason});
    }
    if (refused > lost) return std::to_string(most.first) + " " + most.second + " are not used";
    if (2 * count_of(odometry::OdometryShell::kNoReadings) > lost)
        return "they have hardly a depth reading that is valid and within the camera's depth_range_m";
    if (2 * count_of(odometry::OdometryShell::kBesideColor) > lost)
        return "their depth lies beside the colour image; are camera.json's cameras and color_from_depth "
               "right?";
    return std::nullopt;
}

std::string Pipeline::why_lost() {
    return reason_lost().value_or("depth is there, but nothing to follow in it and in the colour image");
}

}  // namespace planemap::pipeline
