// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/keyframe_tracer.hpp"

namespace planemap::octomap {

void KeyframeTracer::trace(const ::octomap::OcTree& tree, const StoredScan& scan,
                           const Pose& world_from_camera, const std::stop_token& stop) {
    const double max_range = max_range_m_ > 0 ? max_range_m_ : scan.camera().depth_max_m;
    inserter_.trace(tree, scan.points(world_from_camera, subsample_), scan.origin(world_from_camera),
                    max_range, stop);
}

}  // namespace planemap::octomap
