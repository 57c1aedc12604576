// SPDX-License-Identifier: BSD-3-Clause
// map_benchmark: what questions to a map cost, and naming its planes. Prints times and asserts nothing.
#include <benchmark/benchmark.h>

#include "core/random_values.hpp"
#include "map/furniture.hpp"
#include "map/labels.hpp"
#include "map/queries.hpp"

namespace planemap {
namespace {

/// A storey of 40 x 30 m: rooms' walls, tables, shelves and floors, with ragged outlines of 32 vertices as
/// segmented planes have.
PlaneMap storey(int planes) {
    test::Random random(1);
    std::vector<scene::Rectangle> rectangles;
    while (rectangles.size() < static_cast<std::size_t>(planes)) {
        const double x = random.uniform(-20, 20), y = random.uniform(-15, 15);
        switch (rectangles.size() % 4) {
            case 0:
                rectangles.push_back(scene::level(x, y, 0, random.uniform(1, 5), random.uniform(1, 4)));
                break;
            case 1:
                rectangles.push_back(scene::level(x, y, random.uniform(0.4, 2), random.uniform(0.2, 1), 0.3));
                break;
            default:
                rectangles.push_back(scene::upright(x, y, 0, random.integer(0, 3) * std::numbers::pi / 2,
                                                    random.uniform(0.5, 6), random.uniform(0.8, 2.8)));
        }
    }
    PlaneMap map = scene::map_of(rectangles);
    for (MapPlane& plane : map.planes) {
        Outline outline;
        Ring& ring = outline.rings.emplace_back();
        for (int i = 0; i < 32; ++i) {
            const double angle = i * std::numbers::pi / 16, radius = random.uniform(0.9, 1.1);
            ring.emplace_back(radius * plane.half_extents.x() * std::cos(angle),
                              radius * plane.half_extents.y() * std::sin(angle));
        }
        plane.outline = MapOutline(outline);
    }
    map.up = Eigen::Vector3f::UnitZ();
    return map;
}

std::vector<Eigen::Vector3d> points() {
    test::Random random(2);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 1024; ++i)
        points.emplace_back(random.uniform(-20, 20), random.uniform(-15, 15), random.uniform(0, 2));
    return points;
}

void build(benchmark::State& state) {
    const PlaneMap map = storey(static_cast<int>(state.range(0)));
    for (auto _ : state) benchmark::DoNotOptimize(MapQueries(map));
}

void name(benchmark::State& state) {
    PlaneMap map = storey(static_cast<int>(state.range(0)));
    const std::vector<Pose> poses = scene::looking_around(1.4, 0.3);
    for (auto _ : state) {
        name_planes(map, poses);
        benchmark::DoNotOptimize(map);
    }
}

/// Asks about one point after the other; `ask` takes queries, point and the next point.
template <typename Ask>
void ask_all(benchmark::State& state, const Ask& ask) {
    const MapQueries queries(storey(static_cast<int>(state.range(0))));
    const std::vector<Eigen::Vector3d> p = points();
    std::size_t i = 0;
    for (auto _ : state) {
        benchmark::DoNotOptimize(ask(queries, p[i % p.size()], p[(i + 1) % p.size()]));
        ++i;
    }
}

void nearest(benchmark::State& state) {
    ask_all(state, [](auto& queries, auto& p, auto&) { return queries.nearest(p); });
}
void touching(benchmark::State& state) {
    const Eigen::Vector3d half(0.4, 0.4, 0.8);
    ask_all(state, [&](auto& queries, auto& p, auto&) {
        return queries.touching(Eigen::AlignedBox3d(p - half, p + half));
    });
}
void cast(benchmark::State& state) {
    ask_all(state, [](auto& queries, auto& p, auto& q) { return queries.cast(p, q - p); });
}
void free_height(benchmark::State& state) {
    ask_all(state, [](auto& queries, auto& p, auto&) { return queries.free_height(p); });
}
void gap(benchmark::State& state) {
    int i = 0;
    ask_all(state, [&](auto& queries, auto&, auto&) {
        i = (i + 1) % 299;
        return queries.gap(i, i + 1);
    });
}

BENCHMARK(name)->Arg(100)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(build)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(nearest)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(touching)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(cast)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(free_height)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(gap)->Arg(300)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace planemap

BENCHMARK_MAIN();
