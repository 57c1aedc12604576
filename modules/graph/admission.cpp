// SPDX-License-Identifier: BSD-3-Clause
#include "graph/admission.hpp"

#include <algorithm>
#include <string>

#include "core/validation.hpp"

namespace planemap::graph {

namespace {

constexpr double kMaxReach = 1e6;   // metres: further away is not a pose but a mistake
constexpr int kMostMissed = 10000;  // keyframes between two that arrive

bool is_pose(const Pose& pose) {
    return is_valid(pose) && pose.translation().cwiseAbs().maxCoeff() < kMaxReach;
}

}  // namespace

bool follows(int id, int last_id) {
    return id > last_id && id - last_id <= kMostMissed;
}

void check(const Keyframe& keyframe, std::optional<int> last_id) {
    FieldErrors errors("keyframe");
    if (last_id) {
        errors.require(
            follows(keyframe.id, *last_id), "id", keyframe.id,
            "greater than " + std::to_string(*last_id) + " by at most " + std::to_string(kMostMissed));
    }
    errors.require(keyframe.id >= 0, "id", keyframe.id, "at least 0");
    errors.require(keyframe.previous_id >= -1 && keyframe.previous_id < std::max(keyframe.id, 0),
                   "previous_id", keyframe.previous_id, "-1 or an earlier keyframe's id");
    errors.require(is_pose(keyframe.odom_from_camera), "odom_from_camera", "not a rigid transform",
                   "a rigid transform");
    errors.require(keyframe.previous_id < 0 || is_pose(keyframe.previous_from_camera), "previous_from_camera",
                   "not a rigid transform", "a rigid transform");
    const auto regions = static_cast<int>(keyframe.regions.size());
    for (std::size_t i = 0; i < keyframe.features.size() && !errors.any(); ++i) {
        const Feature& feature = keyframe.features[i];
        const std::string name = "features[" + std::to_string(i) + "]";
        errors.require(feature.point.allFinite(), name + ".point", "not finite", "finite");
        errors.require(feature.pixel.allFinite(), name + ".pixel", "not finite", "finite");
        errors.require(feature.region >= -1 && feature.region < regions, name + ".region", feature.region,
                       "-1 or an index into regions");
    }
    check_depth(keyframe.noise, keyframe.depth_min_m, keyframe.depth_max_m, errors);
    for (std::size_t i = 0; i < keyframe.regions.size() && !errors.any(); ++i) {
        errors.require(is_valid(keyframe.regions[i]), "regions[" + std::to_string(i) + "]", "not valid",
                       "finite, with a unit normal and at least three points");
    }
    errors.throw_if_any();
}

}  // namespace planemap::graph
