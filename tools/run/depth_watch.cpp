// SPDX-License-Identifier: BSD-3-Clause
#include "run/depth_watch.hpp"

#include "messages/error.hpp"
#include "pipeline/given_poses.hpp"

namespace planemap {

namespace {

/// Nothing for a picture that is corrupt: the depth beside it is still good.
std::optional<RgbImage> picture_of(const messages::Frame& frame, int reduction) {
    try {
        return frame.color(reduction);
    } catch (const messages::MessageError&) {
        return std::nullopt;
    }
}

}  // namespace

DepthWatch::DepthWatch(messages::FrameDecoder& decoder) {
    constexpr int kWaiting = 30;  // frames
    decoder.subscribe(
        status_, kWaiting,
        [this](const std::shared_ptr<const messages::Frame>& frame) {
            count_.add(frame->depth(), frame->camera());
            views_.add(frame->depth(), frame->camera(), frame->utime(),
                       [&](int reduction) { return picture_of(*frame, reduction); });
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
