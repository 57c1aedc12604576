// SPDX-License-Identifier: BSD-3-Clause
#include "map/hand_over.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "map/plane_estimate.hpp"

namespace planemap::map {

namespace {

constexpr int kSamples = 12;            // a side of the grid that tells whether a region is covered
constexpr double kCoveredShare = 0.97;  // of its samples; outlines of one thing differ at the edges

/// Where to look for what a region covers: points inside it, in its box's x and y.
std::vector<Eigen::Vector2d> samples_of(const StoredRegion& region, const StoredKeyframe& owner) {
    FlatPolygon polygon;
    outline_in(Pose::Identity(), region, owner, polygon);
    std::vector<Eigen::Vector2d> samples;
    for (int i = 0; i < kSamples * kSamples; ++i) {
        const int row = i / kSamples, column = i % kSamples;
        const Eigen::Vector2d share((column + 0.5) / kSamples, (row + 0.5) / kSamples);
        const Eigen::Vector2d p =
            region.half_extents.cast<double>().cwiseProduct(2 * share - Eigen::Vector2d::Ones());
        if (contains(polygon, p)) samples.push_back(p);
    }
    return samples;
}

/// Takes away the samples that an heir's region covers.
void take_covered(std::vector<Eigen::Vector2d>& samples, const Pose& box_from_heir_box,
                  const StoredRegion& region, const StoredKeyframe& heir) {
    FlatPolygon polygon;
    outline_in(box_from_heir_box, region, heir, polygon);
    std::erase_if(samples, [&](const Eigen::Vector2d& p) { return contains(polygon, p); });
}

/// Whether one saw past what the other saw.
bool sees_change(const StoredKeyframe& gone, const StoredKeyframe& heir) {
    const std::vector<Plane> planes = seen_planes(heir);
    const SeenRegions one{gone.sight, gone.sight_planes}, other{heir.sight, planes};
    const Pose heir_from_gone = heir.world_from_camera->inverse(Eigen::Isometry) * *gone.world_from_camera;
    return has_changed(one, other, heir_from_gone, gone.noise);
}

}  // namespace

void hand_over(const StoredKeyframe& gone, const std::vector<StoredKeyframe*>& heirs,
               const std::function<double(const StoredRegion&)>& agreement_m) {
    for (const StoredRegion& region : gone.regions) {
        if (region.plane < 0) continue;  // too far out to be in the map
        const PlacedRegion placed(*gone.world_from_camera, region);
        const Pose box_from_world = placed.box.frame_from_box.inverse(Eigen::Isometry);
        std::vector<Eigen::Vector2d> samples = samples_of(region, gone);
        const auto all = static_cast<double>(samples.size());
        double least_misfit2 = std::pow(agreement_m(region), 2);
        StoredRegion* best = nullptr;
        StoredKeyframe* heir = heirs.front();
        for (StoredKeyframe* candidate : heirs) {
            for (StoredRegion& other : candidate->regions) {
                if (other.plane != region.plane) continue;
                const PlacedRegion placed_other(*candidate->world_from_camera, other);
                take_covered(samples, box_from_world * placed_other.box.frame_from_box, other, *candidate);
                const double misfit = misfit2(placed, placed_other.plane);
                if (misfit >= least_misfit2) continue;
                least_misfit2 = misfit;
                best = &other;
                heir = candidate;
            }
        }
        const bool is_covered =
            best != nullptr && static_cast<double>(samples.size()) <= (1 - kCoveredShare) * all;
        if (!is_covered) heir = heirs.front();
        const Pose heir_from_gone =
            heir->world_from_camera->inverse(Eigen::Isometry) * *gone.world_from_camera;
        if (is_covered) {
            take_points(*best, region, heir_from_gone);
        } else {
            take_region(*heir, region, gone, heir_from_gone);
        }
    }
}

void hand_over_looks(StoredKeyframe gone, StoredKeyframe& heir) {
    const Pose heir_from_world = heir.world_from_camera->inverse(Eigen::Isometry);
    const auto take = [&](StoredKeyframe view) {
        view.keyframe_from_camera = heir_from_world * *view.world_from_camera;
        heir.take_later(std::move(view));
    };
    for (StoredKeyframe& look : gone.later) take(std::move(look));
    gone.later.clear();
    gone.sight_planes = seen_planes(gone);
    if (!sees_change(gone, heir)) return;
    gone.regions = {};
    gone.vertices = {};
    take(std::move(gone));
}

}  // namespace planemap::map
