// SPDX-License-Identifier: BSD-3-Clause
// Asks a stored map: the plane nearest to a point, what a ray meets, and how two planes lie to each other.
//   03_ask_a_map plane_map.lcmlog [X Y Z]     a point of the world frame (metres); default: 1 m before the
//   first camera
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "map/map_file.hpp"
#include "map/queries.hpp"

namespace {

void ask(const char* file, const Eigen::Vector3d& p_world) {
    const planemap::PlaneMap map = planemap::map::read_plane_map(file);
    const planemap::map::MapQueries queries(map);

    const auto nearest = queries.nearest(p_world);
    if (nearest) std::printf("nearest: plane %d, %.3f m away\n", nearest->id, nearest->distance);

    const auto hit = queries.cast(p_world, Eigen::Vector3d::UnitZ(), 20);
    if (hit)
        std::printf("ray along z: plane %d after %.3f m\n", hit->id, hit->range);
    else
        std::puts("ray along z: nothing within 20 m");

    for (std::size_t i = 1; i < map.planes.size(); ++i) {
        const planemap::MapPlane &a = map.planes[0], &b = map.planes[i];
        const planemap::map::PlaneRelation r = planemap::map::relation(a, b);
        std::printf("planes %d and %d: %.2f deg", a.id, b.id, r.angle * 180 / 3.14159265358979);
        if (r.distance) std::printf(", %.3f m apart", *r.distance);
        std::printf("\n");
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2 && argc != 5) {
        std::fprintf(stderr, "Usage: %s plane_map.lcmlog [X Y Z]\n", argv[0]);
        return 2;
    }
    try {
        Eigen::Vector3d p_world(0, 0, 1);
        for (int i = 0; argc == 5 && i < 3; ++i) p_world[i] = std::strtod(argv[2 + i], nullptr);
        ask(argv[1], p_world);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return 1;
    }
}
