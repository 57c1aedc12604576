// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/segmentation_shell.hpp"

#include <optional>

#include "messages/channels.hpp"

namespace planemap::segmentation {

FoundRegions RegionFinder::find(const messages::Frame& frame) {
    FoundRegions found;
    found.regions.utime = frame.utime();
    const DepthImage& depth = frame.depth();
    {
        const messages::SpentTimer timer(found.spent);
        segmenter_->segment(depth, frame.camera(), segmentation_);
        const Pose& camera_from_depth = frame.camera().color_from_depth;
        for (const PlanarRegion& region : segmentation_.regions)
            found.regions.regions.push_back(camera_from_depth * region);
    }
    return found;
}

SegmentationShell::SegmentationShell(messages::Bus& bus, std::shared_ptr<messages::FrameDecoder> decoder,
                                     const SegmentationOptions& options)
    : bus_(bus), decoder_(std::move(decoder)), finder_(options) {
    // A short queue: late regions are worth less than the next frame's.
    decoder_->subscribe(status_, 4, [this](const auto& frame) { on_frame(*frame); });
}

void SegmentationShell::on_frame(const messages::Frame& frame) {
    std::optional<FoundRegions> own;
    const auto* found = frame.made<FoundRegions>();
    if (found == nullptr) found = &own.emplace(finder_.find(frame));
    status_.worked(found->spent);
    const messages::FrameRegions& regions = found->regions;
    bus_.publish(messages::channels::kRegions, messages::to_message(regions, seq_++, bus_.session()));
    status_.published(regions.utime, messages::now_us());
    status_.set_text(std::to_string(regions.regions.size()) + " regions");
}

}  // namespace planemap::segmentation
