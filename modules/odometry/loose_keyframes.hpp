// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/keyframe.hpp"
#include "messages/module_status.hpp"

namespace planemap::odometry {

/// Says of keyframes that those before them hardly hold (more than 10 cm or 5 degrees, one sigma): each takes
/// all that follows along.
class LooseKeyframes {
  public:
    /// The status must outlive it.
    explicit LooseKeyframes(messages::ModuleStatus& status) : status_(status) {}

    /// Each keyframe, once.
    void see(const Keyframe& keyframe);

  private:
    messages::ModuleStatus& status_;
    int count_ = 0;
};

}  // namespace planemap::odometry
