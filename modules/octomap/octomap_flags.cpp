// SPDX-License-Identifier: BSD-3-Clause
#include "messages/flags.hpp"
#include "octomap/octomap_shell.hpp"

namespace planemap {

void add_flags(CLI::App& app, OctomapOptions& options, const std::string& prefix) {
    FlagAdder add(app, prefix, "OctoMap");
    add("resolution-m", options.resolution_m, "edge of a leaf");
    add("max-range-m", options.max_range_m,
        "readings further away clear space up to here and occupy nothing; 0: the camera's depth_max_m");
    add("subsample", options.subsample, "every n-th pixel along u and v");
    add("max-keyframes", options.max_keyframes,
        "keyframes whose depth is kept for rebuilding (about 150 KB each). Beyond it the oldest is frozen at "
        "its pose and its depth dropped");
    add("moved-m", options.moved_m, "keyframes that moved less than this");
    add("moved-deg", options.moved_deg, "and turned less than this, do not cause a rebuild");
}

}  // namespace planemap
