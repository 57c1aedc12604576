// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/given_poses.hpp"

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"

namespace planemap::pipeline {

namespace {
constexpr std::int64_t kMaxGapUs = 100000;
}

std::optional<Pose> given_pose(const Trajectory& trajectory, std::int64_t utime) {
    return pose_at(trajectory, utime, kMaxGapUs);
}

GivenPoses::GivenPoses(messages::Bus& bus, Trajectory poses) : bus_(bus), poses_(std::move(poses)) {
    bus_.subscribe(messages::channels::kKeyframe, [this](const messages::RawMessage& m) { on_keyframe(m); });
}

void GivenPoses::on_keyframe(const messages::RawMessage& message) {
    const keyframe_t keyframe = messages::decode<keyframe_t>(message.bytes);
    const std::optional<Pose> pose = given_pose(poses_, keyframe.utime);
    const bool repeated = !keyframes_.keyframes.empty() && keyframe.id <= keyframes_.keyframes.back().id;
    if (repeated) return;  // the map has its pose
    if (!pose) {
        ++missing_;
        return;
    }
    const int component = keyframes_.keyframes.empty() ? keyframe.id : keyframes_.keyframes.front().id;
    keyframes_.keyframes.push_back({keyframe.id, keyframe.utime, *pose, component});
    keyframes_.utime = keyframe.utime;
    bus_.publish(messages::channels::kTrajectory, messages::to_message(keyframes_, seq_++));
}

}  // namespace planemap::pipeline
