// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/waiting_keyframe.hpp"

#include <utility>

namespace planemap::odometry {

Keyframe& WaitingKeyframe::begin(const PreparedFrame& frame, const FrameMotion& motion) {
    waiting_ = std::make_unique<UndescribedKeyframe>(frame, motion);
    return waiting_->keyframe;
}

Keyframe WaitingKeyframe::describe_at_once() {
    Keyframe keyframe = waiting_->described(options_);
    if (waiting_->has_color()) relocaliser_.add(keyframe);
    waiting_.reset();
    return keyframe;
}

void WaitingKeyframe::describe() {
    if (waiting_) described_ = describe_at_once();
}

std::optional<Keyframe> WaitingKeyframe::take() {
    return std::exchange(described_, std::nullopt);
}

}  // namespace planemap::odometry
