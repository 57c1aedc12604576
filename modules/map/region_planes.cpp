// SPDX-License-Identifier: BSD-3-Clause
#include "map/region_planes.hpp"

namespace planemap::map {

Surfaces surfaces_of(const KeyframeStore& keyframes, std::int64_t utime) {
    Surfaces surfaces;
    surfaces.utime = utime;
    for (const auto& [id, keyframe] : keyframes.keyframes()) {
        if (!keyframe.world_from_camera) continue;
        KeyframeSurfaces& of = surfaces.keyframes.emplace_back();
        of.id = id;
        for (const StoredRegion& region : keyframe.regions) {
            if (region.number < 0) continue;
            const auto number = static_cast<std::size_t>(region.number);
            if (of.planes.size() <= number) of.planes.resize(number + 1, -1);
            of.planes[number] = region.plane;
        }
    }
    return surfaces;
}

void recall_surfaces(const Surfaces& surfaces, KeyframeStore& keyframes, Planes& planes) {
    for (auto& [id, keyframe] : keyframes.keyframes())
        for (StoredRegion& region : keyframe.regions) region.plane = -1;
    for (const KeyframeSurfaces& of : surfaces.keyframes) {
        for (const int plane : of.planes) planes.reserve_id(plane);
        const auto known = keyframes.keyframes().find(of.id);
        if (known == keyframes.keyframes().end()) continue;
        for (StoredRegion& region : known->second.regions) {
            const auto number = static_cast<std::size_t>(region.number);
            if (region.number >= 0 && number < of.planes.size()) region.plane = of.planes[number];
        }
    }
}

}  // namespace planemap::map
