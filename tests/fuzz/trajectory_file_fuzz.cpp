// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "core/trajectory_file.hpp"
#include "fuzz/fuzz.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    const MemoryFile file(bytes);
    try {
        const TrajectoryFile read = read_trajectory_file(file.path());
        for (const auto& pose : read.poses)
            require(pose.world_from_camera.matrix().allFinite(), "poses are finite");
        span_text(read.poses);
    } catch (const std::runtime_error&) {
    }
}

std::vector<std::string> seeds() {
    return {};
}

}  // namespace planemap::fuzz
