// SPDX-License-Identifier: BSD-3-Clause
#include "core/replacement.hpp"

#include <algorithm>
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
            if (other->component != keyframe->component) continue;
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

void KeyframePoses::update(const std::vector<KeyframePose>& named) {
    for (const Replacement& gone : replacements(named_, named)) {
        for (auto& [id, earlier] : replaced_) {
            if (earlier.by != gone.id) continue;
            earlier.by = gone.by;
            earlier.by_from_id = gone.by_from_id * earlier.by_from_id;
        }
        replaced_[gone.id] = gone;
    }
    named_ = named;
}

const KeyframePose* KeyframePoses::named(int id) const {
    const auto found =
        std::lower_bound(named_.begin(), named_.end(), id,
                         [](const KeyframePose& pose, int wanted) { return pose.id < wanted; });
    return found != named_.end() && found->id == id ? &*found : nullptr;
}

const KeyframePose* KeyframePoses::keeper(int id) const {
    if (const KeyframePose* own = named(id)) return own;
    const auto gone = replaced_.find(id);
    return gone == replaced_.end() ? nullptr : named(gone->second.by);
}

std::optional<Pose> KeyframePoses::pose_of(int id) const {
    const KeyframePose* by = keeper(id);
    if (by == nullptr) return std::nullopt;
    return by->id == id ? by->world_from_camera : by->world_from_camera * replaced_.at(id).by_from_id;
}

std::optional<int> KeyframePoses::component_of(int id) const {
    const KeyframePose* by = keeper(id);
    return by == nullptr ? std::nullopt : std::optional(by->component);
}

void KeyframePoses::keep_replaced(const std::function<bool(int id)>& is_wanted) {
    std::erase_if(replaced_, [&](const auto& gone) { return !is_wanted(gone.first); });
}

}  // namespace planemap
