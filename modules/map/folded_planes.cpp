// SPDX-License-Identifier: BSD-3-Clause
#include "map/folded_planes.hpp"

#include <algorithm>
#include <utility>

namespace planemap::map {

namespace {

std::size_t index_of(const std::vector<PlaneEstimate>& planes, int id) {
    const auto at = std::find_if(planes.begin(), planes.end(), [&](const auto& p) { return p.id == id; });
    return at == planes.end() ? PlaneSet::none() : static_cast<std::size_t>(at - planes.begin());
}

}  // namespace

void FoldedPlanes::fold(int keyframe_id, const StoredKeyframe& keyframe, RegionJoiner& joiner,
                        const FreeSpace& free_space) {
    for (const StoredRegion& region : keyframe.regions) {
        if (region.plane < 0) continue;
        const Observation seen(keyframe, region);
        const std::size_t at =
            joiner.join(planes_, index_of(planes_.estimates(), region.plane), region.plane, seen);
        PlaneEstimate& plane = planes_.estimates()[at];
        plane.changed_cells += joiner.draw(plane, seen.world_from_box(), region, keyframe, region.looks);
        plane.count_keyframe(keyframe_id, region.keyframes);
    }
    free_space.carve(planes_.estimates(), Viewpoint(keyframe), keyframe.looks);
}

void FoldedPlanes::rename(const std::map<int, int>& id_of) {
    for (PlaneEstimate& plane : planes_.estimates()) {
        if (const auto known = id_of.find(plane.id); known != id_of.end()) plane.id = known->second;
    }
}

void FoldedPlanes::unite() {
    std::vector<PlaneEstimate> parts = std::move(planes_.estimates());
    planes_.clear();
    for (PlaneEstimate& part : parts) {
        const std::size_t same = index_of(planes_.estimates(), part.id);
        if (same == PlaneSet::none()) {
            planes_.push_back(std::move(part));
        } else {
            planes_.estimates()[same].absorb(part);
            planes_.update(same);
        }
    }
}

}  // namespace planemap::map
