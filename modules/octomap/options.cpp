// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/options.hpp"

namespace planemap::octomap {

OptionList options_of(OctomapOptions& options) {
    using enum Audience;
    OptionList list("OctoMap");
    list.add("resolution_m", options.resolution_m, {0.001, 10}, "Edge of a leaf");
    list.add("max_range_m", options.max_range_m, {0, 1000},
             "Readings further away clear space up to here and occupy nothing; 0: the end of the camera's "
             "depth range");
    list.add("subsample", options.subsample, {1, 64}, "Every n-th pixel of each row and column is used");
    list.add("max_keyframes", options.max_keyframes, at_least(1),
             "Keyframes whose depth is kept for rebuilding (about 150 KB each). Beyond it the oldest is "
             "frozen at its pose and its depth dropped");
    list.add("moved_m", options.moved_m, {0, 10},
             "A keyframe that moves by no more, nor turns beyond its limit, is not entered anew", kExpert);
    list.add("moved_deg", options.moved_deg, {0, 180},
             "A keyframe that turns by no more, nor moves beyond its limit, is not entered anew", kExpert);
    return list;
}

void OctomapOptions::validate() const {
    check_options("OctomapOptions", *this);
}

}  // namespace planemap::octomap
