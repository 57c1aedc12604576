// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/segmentation_shell.hpp"

#include "messages/channels.hpp"
#include "messages/convert.hpp"

namespace planemap::segmentation {

SegmentationShell::SegmentationShell(messages::Bus& bus, std::shared_ptr<messages::FrameDecoder> decoder,
                                     const SegmentationOptions& options)
    : bus_(bus), decoder_(std::move(decoder)), segmenter_(make_segmenter(options)) {
    // A short queue: late regions are worth less than the next frame's.
    decoder_->subscribe(status_, 4, [this](const auto& frame) { on_frame(*frame); });
}

void SegmentationShell::on_frame(const messages::Frame& frame) {
    const DepthImage& depth = frame.depth();
    messages::FrameRegions regions;
    regions.utime = frame.utime();
    {
        const messages::ModuleStatus::Work work(status_);
        segmenter_->segment(depth, frame.camera(), segmentation_);
        const Pose& camera_from_depth = frame.camera().color_from_depth;
        for (const PlanarRegion& region : segmentation_.regions)
            regions.regions.push_back(camera_from_depth * region);
    }
    bus_.publish(messages::channels::kRegions, messages::to_message(regions, seq_++, bus_.session()));
    status_.published(regions.utime, messages::now_us());
    status_.set_text(std::to_string(regions.regions.size()) + " regions");
}

}  // namespace planemap::segmentation
