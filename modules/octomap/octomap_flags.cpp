// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_shell.hpp"

namespace planemap {

void add_flags(Flags& flags, OctomapOptions& options, const std::string& prefix) {
    flags.section("OctoMap", prefix);
    flags.add("resolution-m", options.resolution_m, "edge of a leaf");
    flags.add("max-range-m", options.max_range_m,
              "readings further away clear space up to here and occupy nothing; 0: the camera's depth_max_m");
    flags.add("subsample", options.subsample, "every n-th pixel along u and v");
    flags.add("max-keyframes", options.max_keyframes,
              "keyframes whose depth is kept for rebuilding (about 150 KB each). Beyond it the oldest is "
              "frozen at its pose and its depth dropped");
    flags.add("moved-m", options.moved_m, "keyframes that moved less than this");
    flags.add("moved-deg", options.moved_deg, "and turned less than this, do not cause a rebuild");
}

}  // namespace planemap
