// SPDX-License-Identifier: BSD-3-Clause
#include "pipeline/preparation.hpp"

#include <exception>
#include <utility>

namespace planemap::pipeline {

Preparation::Preparation(messages::FrameDecoder& decoder, const segmentation::SegmentationOptions& options,
                         int threads)
    : decoder_(decoder) {
    for (int i = 0; i < threads; ++i) finders_.emplace_back(options);
}

std::shared_ptr<const Undistortion> Preparation::camera() {
    const std::lock_guard lock(mutex_);
    return camera_;
}

std::shared_ptr<messages::Frame> Preparation::prepare(bot_core::images_t images, int worker) {
    const std::shared_ptr<const Undistortion> camera = this->camera();
    if (!camera) return nullptr;
    std::shared_ptr<messages::Frame> frame;
    try {
        frame = decoder_.prepare(std::move(images), camera);
        frame->keep(finders_[static_cast<std::size_t>(worker)].find(*frame));
        frame->depth_in_color();
        frame->gray();
    } catch (const std::exception&) {  // comes again, and is told, when the frame is handled
    }
    return frame;
}

void Preparation::expect(std::shared_ptr<messages::Frame> frame) {
    decoder_.expect(std::move(frame));
    const std::lock_guard lock(mutex_);
    camera_ = decoder_.camera_in_use();
}

}  // namespace planemap::pipeline
