// SPDX-License-Identifier: BSD-3-Clause
// Asks a stored map: the plane nearest to a point, which planes a robot would touch there, what a ray meets
// and how far the way there is known to be free, how high it is free above a point, and how two planes lie to
// each other.
//   03_ask_a_map plane_map.lcmlog [X Y Z]     a point of the world frame (metres); default: 1 m before the
//   first camera
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "map/map_file.hpp"
#include "map/queries.hpp"

namespace {

const char* name_of(planemap::map::Place place) {
    using enum planemap::map::Place;
    return place == kFree ? "free" : place == kOccupied ? "occupied" : "unknown";
}

void tell(const char* what, const planemap::map::MapQueries::Stretch& seen) {
    std::printf("%s: free for %.3f m, then %s", what, seen.free, name_of(seen.end));
    if (seen.hit)
        std::printf("; plane %d after %.3f m%s\n", seen.hit->id, seen.hit->range,
                    seen.hit->from_front ? "" : ", from behind");
    else
        std::puts("; no plane");
}

void ask(const char* file, const Eigen::Vector3d& p_world) {
    const planemap::PlaneMap map = planemap::map::read_plane_map(file);
    const planemap::map::MapQueries queries(map, planemap::map::read_seen_space(file));

    const auto nearest = queries.nearest(p_world);
    if (nearest) std::printf("nearest: plane %d, %.3f m away\n", nearest->id, nearest->distance);

    std::printf("the point is %s\n", name_of(queries.state_at(p_world)));

    constexpr double kHalf_m = 0.3;  // of a robot that would stand there
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(kHalf_m);
    std::printf("in a cube of %.1f m around it:", 2 * kHalf_m);
    const std::vector<int> touched = queries.touching({p_world - half, p_world + half});
    for (const int id : touched) std::printf(" plane %d", id);
    std::puts(touched.empty() ? " no plane" : "");

    if (const auto ahead = queries.look_along(p_world, Eigen::Vector3d::UnitZ(), 20))
        tell("ray along z", *ahead);
    if (const auto above = queries.free_height(p_world))
        tell("up", *above);
    else
        std::puts("up: which way that is, is not known");

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
