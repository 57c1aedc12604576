// SPDX-License-Identifier: BSD-3-Clause
#include "map/rebuild.hpp"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <thread>
#include <tuple>
#include <utility>

#include "map/belonging.hpp"

namespace planemap::map {

Rebuild::Rebuild(KeyframeStore& store, FoldedPlanes& folded, PlaneIds& ids, const ObservationModel& model)
    : store_(store), folded_(folded), ids_(ids), first_provisional_id_(ids.upcoming()) {
    store.place_all();
    std::vector<double> weights;
    for (auto& [id, keyframe] : store.keyframes()) {
        if (!keyframe.world_from_camera) continue;
        for_each_view(keyframe, [&, id = id](StoredKeyframe& view) {
            for (std::size_t i = 0; i < view.regions.size(); ++i) {
                StoredRegion& region = view.regions[i];
                weights.push_back(model.weight(region, view.noise) * static_cast<double>(region.count));
                entries_.push_back({id, &view, i});
                regions_.push_back(&region);
                planes_before_.push_back(region.plane);
                region.plane = -1;
            }
        });
    }
    order_.resize(entries_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return weights[a] > weights[b]; });
}

void Rebuild::join(PlaneSet& planes, RegionJoiner& joiner, const std::optional<SurfaceRules>& surfaces) {
    folded_.unite();
    for (const PlaneEstimate& folded : folded_.planes()) {
        PlaneEstimate& plane = planes.estimates()[planes.push_back(folded)];
        plane.changed = true;
        plane.changed_cells = PlaneEstimate::kAllCells;
    }
    for (const std::size_t i : order_) {
        SeenRegion& entry = entries_[i];
        const Observation seen(*entry.keyframe, entry.stored());
        if (!seen.is_near()) continue;
        entry.plane = joiner.join_best(planes, ids_, seen);
        entry.world_from_box = seen.world_from_box();
    }
    std::vector<std::size_t> all(planes.estimates().size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    for (const std::size_t i : all) {
        planes.estimates()[i].refit();
        planes.update(i);
    }
    std::vector<std::size_t> now = planes.merge(all);
    for (SeenRegion& entry : entries_)
        if (entry.plane != PlaneSet::none()) entry.plane = now[entry.plane];
    if (surfaces) {
        const auto follow = [&](const std::vector<std::size_t>& to) {
            for (std::size_t& plane : now)
                if (plane != PlaneSet::none()) plane = to[plane];
        };
        follow(unite_surfaces(planes, entries_, *surfaces));
        std::size_t fixed = 0;  // folded planes, which are the first ones
        for (std::size_t i = 0; i < folded_.planes().size(); ++i) fixed = std::max(fixed, now[i] + 1);
        follow(reassign_strays(planes, entries_, order_, fixed, joiner, *surfaces));
    }
    rename_folded(planes, now);
}

/// Folded planes, which are the first ones, are part of those that they are in now.
void Rebuild::rename_folded(const PlaneSet& planes, const std::vector<std::size_t>& now) {
    std::map<int, int> merged_into;
    for (std::size_t i = 0; i < folded_.planes().size(); ++i)
        merged_into[folded_.planes()[i].id] = planes.estimates()[now[i]].id;
    folded_.rename(merged_into);
    folded_.unite();
}

void Rebuild::draw(PlaneSet& planes, const RegionJoiner& joiner, const FreeSpace& free_space,
                   int threads) const {
    std::vector<std::vector<const SeenRegion*>> seen(planes.estimates().size());
    for (const std::size_t i : order_) {
        const SeenRegion& entry = entries_[i];
        if (entry.plane != PlaneSet::none()) seen[entry.plane].push_back(&entry);
    }
    const std::vector<Viewpoint> viewpoints = map::viewpoints(store_);
    // Shapes are independent of each other.
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        RegionJoiner own = joiner;
        for (std::size_t i = next++; i < seen.size(); i = next++) {
            PlaneEstimate& plane = planes.estimates()[i];
            draw(plane, seen[i], own, free_space, viewpoints);
        }
    };
    std::vector<std::jthread> others;
    for (int i = 1; i < threads; ++i) others.emplace_back(work);
    work();
}

void Rebuild::draw(PlaneEstimate& plane, const std::vector<const SeenRegion*>& seen, RegionJoiner& joiner,
                   const FreeSpace& free_space, const std::vector<Viewpoint>& viewpoints) const {
    std::vector<SeenCells> cells;
    cells.reserve(seen.size());
    for (const SeenRegion* entry : seen) {
        cells.push_back(joiner.draw_support(plane, entry->world_from_box, entry->stored(), *entry->keyframe));
        if (entry->stored().number >= 0) cells.back().view = entry->keyframe;
    }
    std::stable_sort(cells.begin(), cells.end(),
                     [](const SeenCells& a, const SeenCells& b) { return a.utime > b.utime; });
    free_space.look_back(plane, cells, viewpoints);
    plane.changed_cells = PlaneEstimate::kAllCells;
}

std::vector<Viewpoint> viewpoints(const KeyframeStore& store) {
    std::vector<Viewpoint> viewpoints;
    viewpoints.reserve(store.keyframes().size());
    for (const auto& [id, keyframe] : store.keyframes()) {
        if (!keyframe.world_from_camera) continue;
        for_each_view(keyframe, [&](const StoredKeyframe& view) { viewpoints.emplace_back(view); });
    }
    std::stable_sort(viewpoints.begin(), viewpoints.end(), [](const Viewpoint& a, const Viewpoint& b) {
        return a.keyframe->seen_utime > b.keyframe->seen_utime;
    });
    return viewpoints;
}

void Rebuild::carry_over_ids(PlaneSet& planes) {
    std::vector<int> now, kept;
    for (const PlaneEstimate& plane : planes.estimates()) now.push_back(plane.id);
    for (const PlaneEstimate& folded : folded_.planes()) kept.push_back(folded.id);
    PlaneIds::Votes votes;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const SeenRegion& entry = entries_[i];
        if (entry.plane == PlaneSet::none() || planes_before_[i] < 0) continue;
        votes[{planes_before_[i], now[entry.plane]}] += static_cast<double>(entry.stored().count);
    }
    const std::map<int, int> id_of = ids_.carry_over(now, kept, votes, first_provisional_id_);
    for (PlaneEstimate& plane : planes.estimates()) plane.id = id_of.at(plane.id);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const SeenRegion& entry = entries_[i];
        if (entry.plane == PlaneSet::none()) continue;
        regions_[i]->plane = planes.estimates()[entry.plane].id;
    }
}

}  // namespace planemap::map
