// SPDX-License-Identifier: BSD-3-Clause
// The depth that a run's map is held against at its end.
#pragma once

#include <vector>

#include "core/trajectory.hpp"
#include "evaluate/depth_views.hpp"
#include "evaluate/soundness.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/module_status.hpp"
#include "run/doubts.hpp"

namespace planemap {

/// Keeps depth views, with their colours, spread over the frames of a run.
class DepthWatch {
  public:
    /// The decoder is the shells' own, so that no frame is decoded twice. It calls this one as long as it
    /// lives.
    explicit DepthWatch(messages::FrameDecoder& decoder);

    /// Those that the trajectory (of the colour camera) has a pose for.
    std::vector<evaluation::PosedView> posed(const Trajectory& trajectory) const;
    /// Of all frames.
    const DepthCount& count() const { return count_; }

  private:
    messages::ModuleStatus status_{"soundness"};
    evaluation::SpreadViews views_;
    DepthCount count_;
};

}  // namespace planemap
