// SPDX-License-Identifier: BSD-3-Clause
// A room of which a cupboard hides a part, as a map and as views saw it.
#pragma once

#include <list>
#include <map>
#include <vector>

#include "core/scene.hpp"
#include "map/inference.hpp"

namespace planemap::map::samples {

using scene::facing;
using scene::Rectangle;

// A room of 4 x 2.4 m, seen from its middle: x right, y down, z ahead. The wall is 3 m ahead, the floor 1.2 m
// below; a cupboard of 1 x 1.4 m stands half a metre before the wall and hides the wall from 1.2 x 1.44 m on.
constexpr int kWall = 1, kFloor = 2, kSide = 3, kCupboard = 4;
const Rectangle kFront{facing({0, 0.5, 2.5}, {0, 0, -1}, {1, 0, 0}), 0.5, 0.7, {}};
const Rectangle kWholeWall{facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0}), 2, 1.2, {}};
const Rectangle kWholeFloor{facing({0, 1.2, 2.5}, {0, -1, 0}, {1, 0, 0}), 2, 0.5, {}};  // in view

inline MapPlane map_plane(int id, PlaneLabel label, const Pose& world_from_face, const Outline& outline) {
    const Rectangle face{world_from_face, 2, 2, {}};
    PlanarRegion region = scene::region_of(face, Pose::Identity(), 0.2);
    region.outline = outline;
    MapPlane plane(id, region, 5);
    plane.label = label;
    return plane;
}

/// What is seen of the wall; y of its face goes up.
inline Outline wall_outline() {
    return {
        {{{-2, -1.2}, {-0.6, -1.2}, {-0.6, 0.24}, {0.6, 0.24}, {0.6, -1.2}, {2, -1.2}, {2, 1.2}, {-2, 1.2}}}};
}

/// A map's planes and what cameras see of the whole things; the nearest is seen.
struct Room {
    PlaneMap map;
    std::list<StoredKeyframe> keyframes;
    std::vector<Viewpoint> views;

    Room() {
        map.up = {0, -1, 0};
        const Pose wall = facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0});
        map.planes.push_back(map_plane(kWall, PlaneLabel::kWall, wall, wall_outline()));
        const Pose floor = facing({0, 1.2, 1.5}, {0, -1, 0}, {1, 0, 0});
        map.planes.push_back(map_plane(
            kFloor, PlaneLabel::kFloor, floor,
            {{{{-2, -1.5}, {2, -1.5}, {2, 1.5}, {0.6, 1.5}, {0.6, 1}, {-0.6, 1}, {-0.6, 1.5}, {-2, 1.5}}}}));
    }
    struct Thing {
        int plane;
        Rectangle rectangle;
    };
    void look(const std::vector<Thing>& things, const Eigen::Vector3d& from = {0, 0, 0}) {
        const Pose world_from_camera = scene::camera_at(from);
        std::vector<PlanarRegion> regions;
        for (const Thing& thing : things)
            regions.push_back(scene::region_of(thing.rectangle, world_from_camera, 0.1));
        StoredKeyframe& keyframe = keyframes.emplace_back(stored(1000, regions));
        for (std::size_t i = 0; i < things.size(); ++i) keyframe.regions[i].plane = things[i].plane;
        keyframe.world_from_camera = world_from_camera;
        views.emplace_back(keyframe);
    }
    void look_at_all() { look({{kWall, kWholeWall}, {kFloor, kWholeFloor}, {kCupboard, kFront}}); }

    std::map<int, InferredCells> infer(const std::map<int, PlanePart>& told = {}) const {
        return Inference(map, views, told, 0.025).infer();
    }
    double area(int plane) const {
        const auto inferred = infer();
        const auto at = inferred.find(plane);
        return at == inferred.end() ? 0 : area(at->second);
    }
    static double area(const InferredCells& cells) {
        return static_cast<double>(cells.cells.count()) * cells.cell_m * cells.cell_m;
    }
};

}  // namespace planemap::map::samples
