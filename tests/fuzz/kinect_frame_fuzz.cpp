// SPDX-License-Identifier: BSD-3-Clause
#include <kinect/frame_msg_t.hpp>

#include "fuzz/message.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    fuzz_message<kinect::frame_msg_t>(bytes, [](const auto&) {});
}

std::vector<std::string> seeds() {
    kinect::frame_msg_t frame{};
    frame.image.width = frame.depth.width = 4;
    frame.image.height = frame.depth.height = 2;
    frame.image.image_data.assign(24, 7);
    frame.image.image_data_nbytes = 24;
    frame.depth.depth_data.assign(16, 5);
    frame.depth.depth_data_nbytes = 16;
    return {seed_of(frame)};
}

}  // namespace planemap::fuzz
