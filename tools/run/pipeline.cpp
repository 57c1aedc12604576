// SPDX-License-Identifier: BSD-3-Clause
#include "run/pipeline.hpp"

#include <algorithm>

#include "core/replacement.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"

namespace planemap {

Pipeline::Pipeline(Bus& bus, const PipelineOptions& options)
    : bus_(bus),
      decoder_(std::make_shared<FrameDecoder>(bus, options.camera)),
      segmentation_(bus, decoder_, options.segmentation),
      odometry_(bus, decoder_, options.odometry) {
    if (options.poses) {
        given_poses_ = std::make_unique<GivenPoses>(bus, *options.poses);
    } else if (options.with_graph) {
        graph_ = std::make_unique<GraphShell>(bus, options.graph);
    }
    if ((graph_ || given_poses_) && options.with_map)
        map_ = std::make_unique<map::MapShell>(bus, options.map);
    if (options.with_octomap) octomap_ = std::make_unique<OctomapShell>(bus, decoder_, options.octomap);
    bus_.subscribe(channels::kOdometry, [this, keep = options.keep_estimates](const RawMessage& message) {
        if (!keep) estimates_.clear();
        estimates_.push_back(from_message(decode<odometry_t>(message.bytes)));
    });
    if (graph_ && options.keep_estimates) {
        bus_.subscribe(channels::kTrajectory, [this](const RawMessage& message) {
            const KeyframeTrajectory now = from_message(decode<trajectory_t>(message.bytes));
            for (const Replacement& replacement : replacements(named_, now.keyframes))
                replaced_[replacement.id] = replacement;
            named_ = now.keyframes;
        });
    }
}

void Pipeline::finish() {
    settle();
    odometry_.finish();
    settle();
    if (graph_) graph_->finish();
    settle();
    if (map_) map_->finish();
    settle();
    if (octomap_) octomap_->finish();
}

const KeyframeTrajectory& Pipeline::keyframes() const {
    return given_poses_ ? given_poses_->keyframes() : graph_->graph().trajectory();
}

/// World pose of a keyframe, also of one that the graph replaced.
std::optional<Pose> Pipeline::keyframe_pose(int id) const {
    Pose keyframe_from_asked = Pose::Identity();
    for (auto gone = replaced_.find(id); gone != replaced_.end(); gone = replaced_.find(id)) {
        keyframe_from_asked = gone->second.by_from_id * keyframe_from_asked;
        id = gone->second.by;
    }
    const std::vector<KeyframePose>& keyframes = graph_->graph().trajectory().keyframes;
    const auto keyframe =
        std::lower_bound(keyframes.begin(), keyframes.end(), id,
                         [](const KeyframePose& pose, int wanted) { return pose.id < wanted; });
    if (keyframe == keyframes.end() || keyframe->id != id) return std::nullopt;
    return keyframe->world_from_camera * keyframe_from_asked;
}

Trajectory Pipeline::trajectory() const {
    Trajectory trajectory;
    if (given_poses_) {
        for (const OdometryEstimate& estimate : estimates_) {
            const auto pose = given_pose(given_poses_->poses(), estimate.pose_utime);
            if (pose) trajectory.push_back({estimate.pose_utime, *pose});
        }
        return trajectory;
    }
    const Pose world_from_odom = graph_ ? graph_->graph().trajectory().world_from_odom : Pose::Identity();
    for (const OdometryEstimate& estimate : estimates_) {
        if (estimate.status == TrackingStatus::kLost) continue;
        const std::optional<Pose> keyframe = graph_ ? keyframe_pose(estimate.keyframe_id) : std::nullopt;
        trajectory.push_back({estimate.pose_utime, keyframe ? *keyframe * estimate.keyframe_from_camera
                                                            : world_from_odom * estimate.odom_from_camera});
    }
    std::stable_sort(trajectory.begin(), trajectory.end(),
                     [](const auto& a, const auto& b) { return a.utime < b.utime; });
    return trajectory;
}

std::string Pipeline::why_lost() {
    const auto lost = std::count_if(
        estimates_.begin(), estimates_.end(),
        [](const OdometryEstimate& estimate) { return estimate.status == TrackingStatus::kLost; });
    const auto& losses = odometry_.status().losses();
    const auto is_most = [&](const char* reason) {
        const auto found = losses.find(reason);
        return found != losses.end() && 2 * found->second > lost;
    };
    if (is_most(OdometryShell::kNoReadings))
        return "they have hardly a depth reading that is valid and within the camera's depth_range_m";
    if (is_most(OdometryShell::kBesideColor))
        return "their depth lies beside the colour image; are camera.json's cameras and color_from_depth "
               "right?";
    return "depth is there, but nothing to follow in it and in the colour image";
}

}  // namespace planemap
