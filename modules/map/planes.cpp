// SPDX-License-Identifier: BSD-3-Clause
#include "map/planes.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "map/evidence_blocks.hpp"
#include "map/rebuild.hpp"
#include "map/rules.hpp"

namespace planemap::map {

namespace {

/// The newest of the keyframes near a view and their looks, the newest first: whether what is new in it was
/// looked through before.
std::vector<Viewpoint> views_before(const StoredKeyframe& view, KeyframeStore& store) {
    constexpr std::size_t kNear = 12, kMost = 16;
    std::vector<const StoredKeyframe*> views;
    for (const StoredKeyframe* near : store.nearest(*view.world_from_camera, kNear)) {
        for_each_view(*near, [&](const StoredKeyframe& other) {
            if (other.seen_utime < view.seen_utime) views.push_back(&other);
        });
    }
    std::stable_sort(views.begin(), views.end(),
                     [](const auto* a, const auto* b) { return a->seen_utime > b->seen_utime; });
    if (views.size() > kMost) views.resize(kMost);
    std::vector<Viewpoint> viewpoints;
    viewpoints.reserve(views.size());
    for (const StoredKeyframe* other : views) viewpoints.emplace_back(*other);
    return viewpoints;
}

}  // namespace

Planes::Planes(const MapOptions& options, PlaneIds ids)
    : threads_(options.threads),
      surfaces_(surface_rules(options)),
      joiner_(observation_model(options), options.outline_cell_m),
      free_space_(options.see_through_m),
      planes_(merge_rules(options), options.max_extent_m),
      folded_(merge_rules(options), options.max_extent_m),
      ids_(std::move(ids)) {}

void Planes::start_from(PlaneEstimate plane) {
    ids_.reserve(plane.id);
    folded_.push_back(std::move(plane));
}

void Planes::integrate(int keyframe_id, KeyframeStore& store, MapLosses& losses) {
    for_each_view(store.keyframes().at(keyframe_id),
                  [&](StoredKeyframe& view) { integrate(keyframe_id, view, store, losses); });
}

void Planes::integrate(int keyframe_id, StoredKeyframe& view, KeyframeStore& store, MapLosses& losses) {
    const std::vector<Viewpoint> before = views_before(view, store);
    std::vector<std::size_t> grown;
    std::vector<EvidenceBlock> fresh;
    for (StoredRegion& region : view.regions) {
        region.plane = -1;
        const Observation seen(view, region);
        if (!seen.is_near()) {
            ++losses.regions_too_far;
            continue;
        }
        const std::size_t at = joiner_.join_best(planes_, ids_, seen);
        PlaneEstimate& plane = planes_.estimates()[at];
        fresh.clear();
        plane.changed_cells += joiner_.draw(plane, seen.world_from_box(), region, view, region.looks, &fresh);
        free_space_.carve_before(plane, before, fresh);
        plane.count_keyframe(keyframe_id, region.keyframes);
        region.plane = plane.id;
        grown.push_back(at);
    }
    std::sort(grown.begin(), grown.end());
    grown.erase(std::unique(grown.begin(), grown.end()), grown.end());
    for (const std::size_t i : grown) {
        planes_.estimates()[i].refit();
        planes_.update(i);
    }
    merge(grown, store);
    free_space_.carve(planes_.estimates(), Viewpoint(view), view.looks);
}

void Planes::see_again(const StoredKeyframe& view, int looks) {
    std::map<int, PlaneEstimate*> planes;
    for (PlaneEstimate& plane : planes_.estimates()) planes[plane.id] = &plane;
    for (const StoredRegion& region : view.regions) {
        const auto plane = planes.find(region.plane);
        if (plane == planes.end() || region.number < 0) continue;
        const Pose world_from_box = Observation(view, region).world_from_box();
        const int came = joiner_.draw(*plane->second, world_from_box, region, view, looks);
        plane->second->changed_cells += came;
        plane->second->changed = plane->second->changed || came > 0;
    }
    free_space_.carve(planes_.estimates(), Viewpoint(view), looks);
}

bool Planes::has_changed() const {
    constexpr int kCellsOfNote = 16;
    return std::any_of(planes_.estimates().begin(), planes_.estimates().end(),
                       [](const PlaneEstimate& plane) { return plane.changed_cells >= kCellsOfNote; });
}

/// Merges planes that have come to satisfy the rules.
void Planes::merge(const std::vector<std::size_t>& grown, KeyframeStore& store) {
    std::vector<int> ids;
    for (const PlaneEstimate& plane : planes_.estimates()) ids.push_back(plane.id);
    const std::vector<std::size_t> now = planes_.merge(grown);
    std::map<int, int> merged_into;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const int id = planes_.estimates()[now[i]].id;
        if (id != ids[i]) merged_into[ids[i]] = id;
    }
    if (merged_into.empty()) return;
    for (auto& [id, keyframe] : store.keyframes()) {
        for_each_view(keyframe, [&](StoredKeyframe& view) {
            for (StoredRegion& region : view.regions)
                if (const auto into = merged_into.find(region.plane); into != merged_into.end())
                    region.plane = into->second;
        });
    }
    folded_.rename(merged_into);
    count_keyframes(store);
}

void Planes::fold(int keyframe_id, const StoredKeyframe& keyframe) {
    for_each_view(keyframe,
                  [&](const StoredKeyframe& view) { folded_.fold(keyframe_id, view, joiner_, free_space_); });
}

void Planes::rebuild(KeyframeStore& store) {
    Rebuild rebuild(store, folded_, ids_, model());
    planes_.clear();
    rebuild.join(planes_, joiner_, surfaces_);
    rebuild.draw(planes_, joiner_, free_space_, threads_);
    rebuild.carry_over_ids(planes_);
    count_keyframes(store);
}

/// How many keyframes saw each plane, counted anew.
void Planes::count_keyframes(const KeyframeStore& store) {
    std::map<int, PlaneEstimate*> planes;
    for (PlaneEstimate& plane : planes_.estimates()) {
        planes[plane.id] = &plane;
        plane.keyframes = 0;
        plane.last_keyframe = PlaneEstimate::kNoKeyframe;
    }
    for (const PlaneEstimate& folded : folded_.planes()) {
        if (const auto at = planes.find(folded.id); at != planes.end())
            at->second->keyframes += folded.keyframes;
    }
    for (const auto& [id, keyframe] : store.keyframes()) {
        std::map<int, int> saw;  // how many keyframes' views of each plane it holds
        for_each_view(keyframe, [&](const StoredKeyframe& view) {
            for (const StoredRegion& region : view.regions)
                saw[region.plane] = std::max(saw[region.plane], region.keyframes);
        });
        for (const auto& [plane, keyframes] : saw) {
            if (const auto at = planes.find(plane); at != planes.end())
                at->second->count_keyframe(id, keyframes);
        }
    }
}

std::size_t Planes::memory_bytes() const {
    std::size_t bytes = 0;
    for (const auto* group : {&planes_.estimates(), &folded_.planes()})
        for (const PlaneEstimate& plane : *group) bytes += sizeof plane + plane.grid.memory_bytes();
    return bytes;
}

}  // namespace planemap::map
