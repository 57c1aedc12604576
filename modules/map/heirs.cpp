// SPDX-License-Identifier: BSD-3-Clause
#include "map/heirs.hpp"

namespace planemap::map {

void Heirs::add(const StoredKeyframe& gone, const StoredKeyframe& heir) {
    heirs_[gone.id] = {gone.utime,
                       {heir.id, heir.utime},
                       heir.world_from_camera->inverse(Eigen::Isometry) * *gone.world_from_camera};
    if (heirs_.size() > kMost) heirs_.erase(heirs_.begin());
}

bool Heirs::follow(Place& place, Pose& keyframe_from_camera) const {
    const auto heir = heirs_.find(place.id);
    if (heir == heirs_.end() || heir->second.gone_utime != place.utime) return false;
    keyframe_from_camera = heir->second.heir_from_gone * keyframe_from_camera;
    place = heir->second.place;
    return true;
}

void Heirs::absorb(Heirs&& other) {
    heirs_.merge(other.heirs_);
}

}  // namespace planemap::map
