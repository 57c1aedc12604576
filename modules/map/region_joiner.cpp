// SPDX-License-Identifier: BSD-3-Clause
#include "map/region_joiner.hpp"

#include <utility>

namespace planemap::map {

std::size_t RegionJoiner::join(PlaneSet& planes, std::size_t at, int new_id, const Observation& seen) {
    const Reliability reliability = model_.reliability(seen.region, seen.keyframe.noise);
    if (at == PlaneSet::none()) {
        outline_in(Pose::Identity(), seen.region, seen.keyframe, polygon_);
        PlaneEstimate plane(seen.placed, polygon_, reliability);
        plane.id = new_id;
        return planes.push_back(std::move(plane));
    }
    PlaneEstimate& plane = planes.estimates()[at];
    outline_in(plane.world_from_extent.inverse(Eigen::Isometry) * seen.world_from_box(), seen.region,
               seen.keyframe, polygon_);
    plane.add(seen.placed, polygon_, reliability);
    planes.update(at);
    return at;
}

std::size_t RegionJoiner::join_best(PlaneSet& planes, PlaneIds& ids, const Observation& seen) {
    const std::size_t at = planes.partner_of(seen.placed);
    return join(planes, at, at == PlaneSet::none() ? ids.next() : planes.estimates()[at].id, seen);
}

void RegionJoiner::outline_in_grid(PlaneEstimate& plane, const Pose& world_from_box,
                                   const StoredRegion& region, const StoredKeyframe& keyframe) {
    if (plane.grid.empty()) plane.grid = EvidenceGrid(plane.box.frame_from_box, cell_m_);
    outline_in(plane.grid.world_from_grid().inverse(Eigen::Isometry) * world_from_box, region, keyframe,
               polygon_);
}

int RegionJoiner::draw(PlaneEstimate& plane, const Pose& world_from_box, const StoredRegion& region,
                       const StoredKeyframe& keyframe, int looks, std::vector<EvidenceBlock>* fresh) {
    outline_in_grid(plane, world_from_box, region, keyframe);
    return plane.grid.add(polygon_, model_.strength(region, keyframe.noise), looks, fresh);
}

SeenCells RegionJoiner::draw_support(PlaneEstimate& plane, const Pose& world_from_box,
                                     const StoredRegion& region, const StoredKeyframe& keyframe) {
    outline_in_grid(plane, world_from_box, region, keyframe);
    SeenCells seen{region.utime, region.looks, plane.grid.cells_of(polygon_)};
    plane.grid.add_support(seen.cells, model_.strength(region, keyframe.noise));
    return seen;
}

}  // namespace planemap::map
