// SPDX-License-Identifier: BSD-3-Clause
#include "map/derived_map.hpp"

#include <algorithm>
#include <utility>

#include "map/labels.hpp"

namespace planemap::map {

namespace {

/// So many of the poses or a few more, spread over all: they tell which way is up as well as all do.
std::vector<Pose> some_of(const std::map<int, Pose>& poses) {
    constexpr std::size_t kCameras = 128;
    const std::size_t stride = 1 + poses.size() / kCameras;
    std::vector<Pose> cameras;
    std::size_t i = 0;
    for (const auto& [id, pose] : poses) {
        if (i++ % stride == 0) cameras.push_back(pose);
    }
    return cameras;
}

}  // namespace

void DerivedMap::start_from(const PlaneMap& map) {
    map_.utime = map.utime;
    map_.up = map.up;
}

void DerivedMap::take_labels(const PlaneMap& earlier) {
    for (MapPlane& plane : map_.planes) {
        if (const MapPlane* before = earlier.find(plane.id)) plane.label = before->label;
    }
}

void DerivedMap::seen_at(std::int64_t utime) {
    map_.utime = std::max(map_.utime, utime);
}

/// Returns whether the plane changed to note.
bool DerivedMap::derive(PlaneEstimate& estimate, std::optional<MapPlane>& plane) const {
    if (plane) {
        const Plane* as_drawn = intersections_.plane(estimate.id);
        if (keeps_outline(estimate, *plane, as_drawn != nullptr ? *as_drawn : plane->plane())) {
            move_to_estimate(*plane, estimate);
            return false;
        }
    }
    estimate.changed_cells = 0;
    plane = derived_plane(estimate, derivation_);
    return true;
}

void DerivedMap::refresh(std::vector<PlaneEstimate>& estimates, const std::map<int, Pose>& poses) {
    std::map<int, MapPlane> before;
    for (MapPlane& plane : map_.planes) before.emplace(plane.id, std::move(plane));
    std::vector<int> changed;
    std::vector<MapPlane> planes;
    for (PlaneEstimate& estimate : estimates) {
        std::optional<MapPlane> plane;
        if (const auto known = before.find(estimate.id); known != before.end()) {
            plane = std::move(known->second);
            before.erase(known);
        }
        if (estimate.changed) {
            estimate.changed = false;
            if (derive(estimate, plane)) changed.push_back(estimate.id);
        }
        if (plane) planes.push_back(std::move(*plane));
    }
    for (const auto& [id, plane] : before) changed.push_back(id);  // merged into another one, or gone
    std::sort(planes.begin(), planes.end(), [](auto& a, auto& b) { return a.id < b.id; });
    planes.shrink_to_fit();
    map_.planes = std::move(planes);
    std::sort(changed.begin(), changed.end());
    intersections_.update(map_, changed);
    if (changed.empty()) return;
    if (const std::vector<Pose> cameras = some_of(poses); !cameras.empty()) label_planes(map_, cameras);
}

}  // namespace planemap::map
