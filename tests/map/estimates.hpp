// SPDX-License-Identifier: BSD-3-Clause
// Estimates of planes, and keyframes as they are kept, of flat things.
#pragma once

#include <map>
#include <vector>

#include "core/geometry/outline_frame.hpp"
#include "core/scene.hpp"
#include "map/plane_estimate.hpp"
#include "map/rules.hpp"
#include "map/stored_keyframe.hpp"

namespace planemap::map::samples {

using scene::facing;
using scene::Rectangle;

const MergeRules kRules = merge_rules({});
const OutlineOptions kOutline{1, 0.01, 0.03, 0};

/// A square that is seen from the origin, along z.
inline Rectangle wall_at(double x, double y, double z, double half = 0.5) {
    return {facing({x, y, z}, {0, 0, -1}, {1, 0, 0}), half, half, {}};
}

/// A keyframe in the map that sees these; its regions are of the planes with these ids, of none without.
inline StoredKeyframe stored_at(const Pose& world_from_camera, const std::vector<Rectangle>& seen,
                                const std::vector<int>& planes = {}) {
    std::vector<PlanarRegion> regions;
    for (const Rectangle& r : seen) regions.push_back(scene::region_of(r, world_from_camera, 0.05));
    StoredKeyframe keyframe = stored(0, regions);
    keyframe.world_from_camera = world_from_camera;
    for (std::size_t i = 0; i < planes.size(); ++i) keyframe.regions[i].plane = planes[i];
    return keyframe;
}

inline PlaneEstimate estimate_of(const Rectangle& rectangle, int id, const Reliability& reliability = {}) {
    const StoredKeyframe keyframe = stored(0, {scene::region_of(rectangle, Pose::Identity(), 0.05)});
    FlatPolygon polygon;
    outline_in(Pose::Identity(), keyframe.regions[0], keyframe, polygon);
    PlaneEstimate estimate(PlacedRegion(Pose::Identity(), keyframe.regions[0]), polygon, reliability);
    estimate.id = id;
    estimate.grid = EvidenceGrid(estimate.box.frame_from_box, 0.025);
    return estimate;
}

/// The same with its shape drawn, seen by so many looks with a support of 2^strength.
inline PlaneEstimate drawn_estimate_of(const Rectangle& rectangle, int id, int strength = 0, int looks = 1) {
    PlaneEstimate estimate = estimate_of(rectangle, id);
    const Pose grid_from_face =
        estimate.grid.world_from_grid().inverse(Eigen::Isometry) * rectangle.world_from_face;
    FlatPolygon polygon;
    polygon.assign(projected(grid_from_face, scene::outline_of(rectangle)));
    estimate.grid.add(polygon, strength, looks);
    estimate.count_keyframe(0, 1);
    return estimate;
}

/// Points of all estimates together.
inline double points_of(const std::vector<PlaneEstimate>& estimates) {
    double points = 0;
    for (const PlaneEstimate& estimate : estimates) points += estimate.moments.count;
    return points;
}

}  // namespace planemap::map::samples
