// SPDX-License-Identifier: BSD-3-Clause
#include "graph/schedule.hpp"

#include <algorithm>

namespace planemap::graph {

void Schedule::keyframe_added(const Addition& addition) {
    disagreement_ = std::max(disagreement_, addition.disagreement);
    ++since_started_;
    is_due_ = is_due_ || asks(addition);
}

void Schedule::landmarks_changed(double disagreement) {
    disagreement_ = std::max(disagreement_, disagreement);
}

/// At once when a loop closure is far from the present poses. What pulls less waits the longer the larger the
/// graph is, so that the cost a keyframe stays flat; PoseGraph::finish() makes up for what waits.
bool Schedule::asks(const Addition& addition) const {
    constexpr int kNodesAKeyframe = 50;
    if (options_.optimise_every > 0 && addition.nodes % options_.optimise_every == 0) return true;
    if (is_far(addition.worst_new_loop)) return true;
    return (addition.new_loops || disagreement_ > options_.landmark_trigger) &&
           since_started_ > addition.nodes / kNodesAKeyframe;
}

bool Schedule::is_far(double whitened_error) const {
    constexpr double kFar = 2;  // kernel widths
    return whitened_error > kFar * options_.kernel_width;
}

int Schedule::start() {
    is_running_ = true;
    is_due_ = false;
    since_started_ = 0;
    disagreement_ = 0;
    return parts_moved_;
}

bool Schedule::end(int started) {
    is_running_ = false;
    if (started == parts_moved_) return true;
    is_due_ = true;
    return false;
}

}  // namespace planemap::graph
