// SPDX-License-Identifier: BSD-3-Clause
#include "core/replacement.hpp"

#include <limits>
#include <unordered_set>

namespace planemap {

std::vector<Replacement> replacements(const std::vector<KeyframePose>& before,
                                      const std::vector<KeyframePose>& now) {
    std::unordered_set<int> named;
    for (const KeyframePose& keyframe : now) named.insert(keyframe.id);
    std::vector<const KeyframePose*> gone, stay;
    for (const KeyframePose& keyframe : before)
        (named.contains(keyframe.id) ? stay : gone).push_back(&keyframe);
    std::vector<Replacement> out;
    if (stay.empty()) return out;
    for (const KeyframePose* keyframe : gone) {
        Replacement nearest{keyframe->id, -1, Pose::Identity()};
        double least = std::numeric_limits<double>::infinity();
        for (const KeyframePose* other : stay) {
            const Pose apart =
                other->world_from_camera.inverse(Eigen::Isometry) * keyframe->world_from_camera;
            const double distance = apart.translation().norm() + rotation_angle(apart);
            if (!(distance < least)) continue;
            least = distance;
            nearest.by = other->id;
            nearest.by_from_id = apart;
        }
        if (nearest.by >= 0) out.push_back(nearest);
    }
    return out;
}

}  // namespace planemap
