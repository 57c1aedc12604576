// SPDX-License-Identifier: BSD-3-Clause
#include "map/inferred_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/outline_frame.hpp"

namespace planemap::map {

void InferredParts::start_from(const PlaneMap& map) {
    if (rules_.infers) keep(map);
}

void InferredParts::keep(const PlaneMap& map) {
    for (const InferredRings& rings : map.inferred) {
        const MapPlane* plane = map.find(rings.plane);
        if (plane != nullptr) told_[rings.plane] = {plane->world_from_plane(), rings.outline.rings()};
    }
}

void InferredParts::infer(PlaneMap& map, const std::vector<Viewpoint>& views) {
    cells_.clear();
    map.inferred.clear();
    if (!rules_.infers) return;
    std::erase_if(told_, [&](const auto& part) { return map.find(part.first) == nullptr; });
    cells_ = Inference(map, views, told_, rules_.cell_m).infer();
    std::vector<int> all;
    for (const auto& [id, cells] : cells_) all.push_back(id);
    update(map, all);
}

void InferredParts::update(PlaneMap& map, const std::vector<int>& changed) const {
    std::vector<InferredRings> inferred;
    for (const auto& [id, cells] : cells_) {
        const MapPlane* plane = map.find(id);
        if (plane == nullptr || !is_bound(plane->label)) continue;
        const MapOutline* before = map.inferred_of(id);
        const bool has_changed = std::binary_search(changed.begin(), changed.end(), id);
        if (!has_changed && before == nullptr) continue;  // nothing was left of it
        MapOutline outline = has_changed ? outline_of(*plane) : *before;
        if (!outline.empty()) inferred.push_back({id, std::move(outline)});
    }
    inferred.shrink_to_fit();
    map.inferred = std::move(inferred);
}

/// In the plane's x and y, without what is seen now.
MapOutline InferredParts::outline_of(const MapPlane& plane) const {
    const InferredCells& inferred = cells_.at(plane.id);
    const Pose raster_from_plane =
        inferred.world_from_raster.inverse(Eigen::Isometry) * plane.world_from_plane();
    Bitmap cells = inferred.cells, seen(cells.word0(), cells.y0(), cells.words(), cells.rows());
    draw(plane.outline.rings(), raster_from_plane, inferred.cell_m, seen);
    cells -= seen;
    Outline outline = cells.opened(1).trace();
    for (Ring& ring : outline.rings)
        for (Eigen::Vector2d& v : ring) v *= inferred.cell_m;
    std::erase_if(outline.rings,
                  [&](const Ring& ring) { return std::abs(signed_area(ring)) < rules_.least_m2; });
    outline = with_straight_edges(outline, inferred.lines, {inferred.cell_m, rules_.tolerance_m, 0.005});
    const Pose plane_from_raster = raster_from_plane.inverse(Eigen::Isometry);
    return MapOutline(projected(plane_from_raster, std::move(outline)));
}

std::size_t InferredParts::memory_bytes() const {
    std::size_t bytes = 0;
    for (const auto& [id, of] : cells_)
        bytes += sizeof of + static_cast<std::size_t>(of.cells.words()) *
                                 static_cast<std::size_t>(of.cells.rows()) * sizeof(std::uint64_t);
    return bytes;
}

}  // namespace planemap::map
