// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/message.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    fuzz_value<camera_info_t>(bytes, 0, 0);
}

std::vector<std::string> seeds() {
    CameraInfo bent = test::sample_camera();
    bent.depth_distortion = LensDistortion{LensDistortion::Model::kBrown, {-0.2, 0.01, 0, 0.001, 0}};
    bent.color_distortion = LensDistortion{LensDistortion::Model::kFisheye, {0.01, 0, 0, 0}};
    return {seed_of(messages::to_message(test::sample_camera(), 5, 1)),
            seed_of(messages::to_message(bent, 5, 1))};
}

}  // namespace planemap::fuzz
