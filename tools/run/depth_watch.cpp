// SPDX-License-Identifier: BSD-3-Clause
#include "run/depth_watch.hpp"

#include "pipeline/given_poses.hpp"

namespace planemap {

DepthWatch::DepthWatch(messages::FrameDecoder& decoder) {
    constexpr int kWaiting = 30;  // frames
    decoder.subscribe(
        status_, kWaiting,
        [this](const std::shared_ptr<const messages::Frame>& frame) {
            views_.add(frame->depth(), frame->camera(), frame->utime());
        },
        false);
}

std::vector<evaluation::PosedView> DepthWatch::posed(const Trajectory& trajectory) const {
    std::vector<evaluation::PosedView> posed;
    for (const evaluation::DepthView& view : views_.views())
        if (const auto pose = pipeline::given_pose(trajectory, view.utime)) posed.push_back({&view, *pose});
    return posed;
}

}  // namespace planemap
