// SPDX-License-Identifier: BSD-3-Clause
// map_benchmark: what a keyframe costs, rebuilding the map, naming its planes, and questions to it. Prints
// times and asserts nothing.
#include <benchmark/benchmark.h>

#include <memory>

#include "core/furniture.hpp"
#include "core/random_values.hpp"
#include "map/labels.hpp"
#include "map/map.hpp"
#include "map/queries.hpp"

namespace planemap::map {
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

/// Keyframes that walk through 20 rooms of 6 x 5 m with 14 planes each, round after round; each sees a ragged
/// piece of 12 of them.
struct Walk {
    std::vector<Keyframe> keyframes;
    KeyframeTrajectory trajectory;
};

Walk walk(int count) {
    constexpr int kRooms = 20, kSeen = 12;
    test::Random random(3);
    std::vector<std::vector<scene::Rectangle>> rooms(kRooms);
    for (int i = 0; i < kRooms; ++i) {
        const double x = 6.2 * (i % 5), y = 5.2 * (i / 5);
        std::vector<scene::Rectangle>& room = rooms[static_cast<std::size_t>(i)];
        room = {scene::level(x, y, 0, 3, 2.5),
                scene::facing_down(scene::level(x, y, 2.5, 3, 2.5)),
                scene::upright(x, y - 2.5, 0, 0.5 * std::numbers::pi, 6, 2.5),
                scene::upright(x, y + 2.5, 0, -0.5 * std::numbers::pi, 6, 2.5),
                scene::upright(x - 3, y, 0, 0, 5, 2.5),
                scene::upright(x + 3, y, 0, std::numbers::pi, 5, 2.5)};
        for (int k = 0; k < 4; ++k) {
            const double at_x = x + random.uniform(-2, 2), at_y = y + random.uniform(-1.5, 1.5);
            room.push_back(scene::level(at_x, at_y, 0.45 + 0.2 * k, 0.6, 0.4));
            room.push_back(scene::upright(at_x, at_y - 0.4, 0, -0.5 * std::numbers::pi, 1.2, 0.45 + 0.2 * k));
        }
    }
    Walk walk;
    for (int id = 0; id < count; ++id) {
        const int room = id / 10 % kRooms;
        const Pose pose = scene::looking(
            {6.2 * (room % 5) + random.uniform(-1, 1), 5.2 * (room / 5) + random.uniform(-1, 1), 1.3},
            0.63 * id, 0.3);
        Keyframe keyframe;
        keyframe.id = id;
        keyframe.utime = id;
        for (int k = 0; k < kSeen; ++k) {
            const auto& planes = rooms[static_cast<std::size_t>(room)];
            const scene::Rectangle& whole =
                planes[static_cast<std::size_t>(random.integer(0, int(planes.size()) - 1))];
            // A window anywhere on it, cut at its edges.
            const auto cut = [&](double half, double size, double& middle) {
                const double at = random.uniform(-half, half);
                const double from = std::max(-half, at - size), to = std::min(half, at + size);
                middle = 0.5 * (from + to);
                return 0.5 * (to - from);
            };
            scene::Rectangle piece = whole;
            double x = 0, y = 0;
            piece.half_x = cut(whole.half_x, random.uniform(0.3, 1.2), x);
            piece.half_y = cut(whole.half_y, random.uniform(0.3, 0.8), y);
            piece.world_from_face.translation() = whole.world_from_face * Eigen::Vector3d(x, y, 0);
            PlanarRegion region = scene::region_of(piece, pose, 0.1, 0.003);
            Ring ring;
            for (int v = 0; v < 24; ++v) {
                const double angle = v * std::numbers::pi / 12, radius = random.uniform(0.85, 1.1);
                ring.emplace_back(radius * piece.half_x * std::cos(angle),
                                  radius * piece.half_y * std::sin(angle));
            }
            region.outline.rings = {ring};
            keyframe.regions.push_back(region);
        }
        walk.keyframes.push_back(keyframe);
        walk.trajectory.keyframes.push_back({id, id, pose});
    }
    return walk;
}

/// All keyframes move, some millimetres apart from each other.
void rebuild(benchmark::State& state) {
    const Walk walked = walk(static_cast<int>(state.range(0)));
    PlaneMapper mapper;
    for (const Keyframe& keyframe : walked.keyframes) mapper.add(keyframe);
    mapper.update(walked.trajectory);
    test::Random random(4);
    for (auto _ : state) {
        state.PauseTiming();
        KeyframeTrajectory moved = walked.trajectory;
        for (KeyframePose& pose : moved.keyframes) pose.world_from_camera.pretranslate(random.vector(0.005));
        state.ResumeTiming();
        mapper.update(moved);
    }
    state.counters["planes"] = static_cast<double>(mapper.map().planes.size());
}

/// What is asked when the map is written.
void seen_space(benchmark::State& state) {
    const Walk walked = walk(static_cast<int>(state.range(0)));
    PlaneMapper mapper;
    for (const Keyframe& keyframe : walked.keyframes) mapper.add(keyframe);
    mapper.update(walked.trajectory);
    double volume = 0;
    for (auto _ : state) volume = mapper.seen_space().volume();
    state.counters["m3"] = volume;
}

/// The last of so many keyframes.
void keyframe(benchmark::State& state) {
    const Walk walked = walk(static_cast<int>(state.range(0)));
    for (auto _ : state) {
        state.PauseTiming();
        auto mapper = std::make_unique<PlaneMapper>();
        for (std::size_t i = 0; i + 10 < walked.keyframes.size(); ++i) mapper->add(walked.keyframes[i]);
        mapper->update(walked.trajectory);
        state.ResumeTiming();
        for (std::size_t i = walked.keyframes.size() - 10; i < walked.keyframes.size(); ++i)
            mapper->add(walked.keyframes[i]);
        state.PauseTiming();
        mapper.reset();
        state.ResumeTiming();
    }
    state.SetLabel("ten of them");
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
        label_planes(map, poses);
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
    ask_all(state, [](auto& queries, auto& p, auto&) { return queries.free_height(p)->free; });
}
void gap(benchmark::State& state) {
    int i = 0;
    ask_all(state, [&](auto& queries, auto&, auto&) {
        i = (i + 1) % 299;
        return queries.gap(i, i + 1);
    });
}

BENCHMARK(rebuild)->Arg(200)->Arg(2000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(keyframe)->Arg(200)->Arg(2000)->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(seen_space)->Arg(200)->Arg(2000)->Unit(benchmark::kMillisecond)->Iterations(2);
BENCHMARK(name)->Arg(100)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(build)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(nearest)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(touching)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(cast)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(free_height)->Arg(300)->Unit(benchmark::kMicrosecond);
BENCHMARK(gap)->Arg(300)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace planemap::map

BENCHMARK_MAIN();
