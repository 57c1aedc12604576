// SPDX-License-Identifier: BSD-3-Clause
// graph_benchmark: what the pose graph costs in a large building. Prints CPU times and asserts nothing.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "graph/graph.hpp"
#include "graph/optimisation.hpp"
#include "places/place_index.hpp"
#include "places/synthetic.hpp"

namespace planemap::graph {
namespace {

using namespace planemap::test;
using Eigen::Vector3d;

/// CPU time of this thread: what other programs on the machine do not lengthen.
class Stopwatch {
  public:
    double ms() const { return now_ms() - start_; }

  private:
    static double now_ms() {
        timespec now = {};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
    }
    double start_ = now_ms();
};

void print(const char* what, std::vector<double> ms) {
    if (ms.empty()) return;
    std::sort(ms.begin(), ms.end());
    const auto at = [&](double share) {
        return ms[static_cast<std::size_t>(share * static_cast<double>(ms.size() - 1))];
    };
    std::printf("%-46s median %8.2f ms   95 %% %8.2f ms   worst %8.2f ms\n", what, at(0.5), at(0.95),
                ms.back());
}

// A corridor of 2.4 m around a block of `kSide` metres; y down, floor at 1.4 m.
constexpr double kSide = 25, kHalfWidth = 1.2, kFloor = 1.4, kCeiling = -1.3;
constexpr int kStepsASide = 50, kLap = 4 * kStepsASide;

/// One of the corridor's four sides: its frame has z along it, x to the right, the origin at its start.
Pose world_from_side(int side) {
    const Vector3d corners[] = {{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}, {1, 0, -1}};
    return looking(kSide / 2 * corners[side % 4], side * M_PI / 2);
}

std::vector<test::Landmark> wall_features(Random& random) {
    std::vector<test::Landmark> landmarks;
    for (int i = 0; i < 24000; ++i) {
        const Vector3d p(i % 2 == 0 ? kHalfWidth : -kHalfWidth, random.uniform(kCeiling, kFloor),
                         random.uniform(-1.2, kSide + 1.2));
        landmarks.push_back({world_from_side(i % 4) * p, random_descriptor(random)});
    }
    return landmarks;
}

/// Floor, ceiling, both walls from 1 to 5 m before a camera `along` metres down a side, and its end.
std::vector<PlanarRegion> corridor_regions(int side, double along, const Pose& world_from_camera) {
    const double from = along + 1, to = std::min(along + 5, kSide + kHalfWidth);
    const Pose camera_from_side = world_from_camera.inverse(Eigen::Isometry) * world_from_side(side);
    std::vector<PlanarRegion> regions;
    const auto add = [&](const Vector3d& centre, const Vector3d& u, const Vector3d& normal, double half_u,
                         double half_v) {
        Pose side_from_box = Pose::Identity();
        side_from_box.linear() << u, normal.cross(u), normal;
        side_from_box.translation() = centre;
        if (half_u > 0.3) regions.push_back(rectangle(camera_from_side * side_from_box, half_u, half_v));
    };
    const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
    const double middle = (from + to) / 2, half = (to - from) / 2, height = (kFloor - kCeiling) / 2;
    add({0, kFloor, middle}, z, -y, half, kHalfWidth);
    add({0, kCeiling, middle}, z, y, half, kHalfWidth);
    add({-kHalfWidth, 0, middle}, z, x, half, height);
    add({kHalfWidth, 0, middle}, z, -x, half, height);
    if (along + 5 > kSide + kHalfWidth) add({0, 0, kSide + kHalfWidth}, x, -z, kHalfWidth, height);
    return regions;
}

/// Round after round, turning over the last 2 m of each side.
Pose building_pose(int i) {
    const double along = kSide * (i % kStepsASide) / kStepsASide;
    const double turn = std::clamp(along - (kSide - 2), 0.0, 2.0) / 2 * M_PI / 2;
    return world_from_side(i / kStepsASide) * looking({0.1 * std::sin(0.03 * i), 0, along}, turn);
}

Walk building_walk(int count, Random& random, bool with_features) {
    std::vector<Pose> poses;
    for (int i = 0; i < count; ++i) poses.push_back(building_pose(i));
    Odometry odometry;
    odometry.bias << 0.001, 0.0005, -0.002, 0.0001, 0.0004, -0.0001;
    Walk walk = test::walk(with_features ? wall_features(random) : std::vector<test::Landmark>(), poses,
                           random, odometry);
    for (int i = 0; i < count; ++i) {
        walk.keyframes[static_cast<std::size_t>(i)].regions = corridor_regions(
            i / kStepsASide % 4, kSide * (i % kStepsASide) / kStepsASide, poses[static_cast<std::size_t>(i)]);
    }
    return walk;
}

double rms_error_m(const KeyframeTrajectory& trajectory, const std::vector<Pose>& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
        sum +=
            (trajectory.keyframes[i].world_from_camera.translation() - truth[i].translation()).squaredNorm();
    return std::sqrt(sum / static_cast<double>(truth.size()));
}

/// A whole walk through PoseGraph::add(), one after the other.
void time_graph(int count) {
    Random random(1);
    const Walk walk = building_walk(count, random, true);
    PoseGraph graph;
    std::vector<double> all, late;
    Stopwatch whole;
    for (const Keyframe& keyframe : walk.keyframes) {
        Stopwatch stopwatch;
        graph.add(keyframe);
        all.push_back(stopwatch.ms());
        if (keyframe.id >= count - 200) late.push_back(all.back());
    }
    std::printf("%d keyframes in %.1f s, %zu loop closures, RMS error %.3f m\n", count, whole.ms() / 1000,
                graph.loop_closures().size(), rms_error_m(graph.trajectory(), walk.world_from_camera));
    print("  add(), optimisation included, all", all);
    print("  add(), optimisation included, last 200", late);
    Stopwatch finish;
    graph.finish();
    std::printf("  finish() %.1f ms, RMS error %.3f m\n", finish.ms(),
                rms_error_m(graph.trajectory(), walk.world_from_camera));
}

/// The poses, edges and sightings of a walk whose every keyframe has two loop closures to earlier rounds.
struct Problem {
    std::vector<Pose> truth, poses;
    std::vector<PoseEdge> edges;
    Landmarks landmarks{landmark_options({})};

    void add_edge(int from, int to, double sigma_m, double sigma_rad, bool robust, Random& random) {
        Twist error;
        for (int k = 0; k < 6; ++k) error[k] = random.normal(k < 3 ? sigma_m : sigma_rad);
        edges.push_back({from, to,
                         truth[static_cast<std::size_t>(from)].inverse(Eigen::Isometry) *
                             truth[static_cast<std::size_t>(to)] * pose_from_twist(error),
                         sqrt_information(Matrix6d::Zero(), sigma_m, sigma_rad), robust});
    }
    OptimisationReport optimise() {
        std::vector<Landmark> planes = landmarks.landmarks();
        const OptimisationReport report =
            graph::optimise(poses, edges, 0, {3.0, 30}, &planes, landmarks.shared());
        landmarks.follow(planes, {});
        return report;
    }
};

Problem dense_problem(int count, Random& random) {
    Problem problem;
    for (const Keyframe& keyframe : building_walk(count, random, false).keyframes) {
        const int i = keyframe.id;
        problem.truth.push_back(building_pose(i));
        problem.landmarks.add(i, keyframe.regions, problem.truth.back(), keyframe.noise);
        problem.poses.push_back(problem.truth.back());
        if (i == 0) continue;
        problem.add_edge(i - 1, i, 0.006, 0.005, false, random);
        problem.poses.back() =
            problem.poses[static_cast<std::size_t>(i - 1)] * problem.edges.back().from_from_to;
        for (int k = 0; k < 2 && i >= kLap; ++k) {
            const int from = i - kLap * random.integer(1, i / kLap) + random.integer(-2, 2);
            problem.add_edge(std::max(0, from), i, 0.011, 0.006, true, random);
        }
    }
    return problem;
}

/// From odometry's poses, and again after one more loop closure that pulls by 5 cm.
void time_optimisation(int count) {
    Random random(3);
    Problem problem = dense_problem(count, random);
    Stopwatch cold;
    const OptimisationReport first = problem.optimise();
    std::printf(
        "optimisation of %d keyframes, %zu edges, %zu sightings\n  from odometry's poses: %.1f ms, %d "
        "iterations\n",
        count, problem.edges.size(), problem.landmarks.shared().size(), cold.ms(), first.iterations);
    problem.add_edge(count / 2, count - 1, 0.03, 0.006, true, random);
    Stopwatch warm;
    const OptimisationReport second = problem.optimise();
    std::printf("  after one more loop closure: %.1f ms, %d iterations\n", warm.ms(), second.iterations);
}

/// Descriptors of places that share much, as real ones do: half of a place's are of a small stock.
std::vector<Descriptor> place(Random& random, const std::vector<Descriptor>& stock, int count) {
    std::vector<Descriptor> descriptors;
    for (int i = 0; i < count; ++i) {
        descriptors.push_back(
            i % 2 == 0
                ? with_flips(
                      stock[static_cast<std::size_t>(random.integer(0, static_cast<int>(stock.size()) - 1))],
                      20, random)
                : random_descriptor(random));
    }
    return descriptors;
}

void time_index(int count) {
    Random random(2);
    const std::vector<Descriptor> stock = place(random, {Descriptor{}}, 20000);
    places::PlaceIndex index;
    std::vector<double> add, query;
    for (int i = 0; i < count; ++i) {
        const std::vector<Descriptor> descriptors = place(random, stock, 600);
        Stopwatch adding;
        index.add(descriptors);
        add.push_back(adding.ms());
        if (i < count - 100) continue;
        Stopwatch asking;
        index.scores(descriptors);
        query.push_back(asking.ms());
    }
    std::printf("index of %d places with 600 descriptors: %.0f MB\n", count,
                1e-6 * static_cast<double>(index.memory_bytes()));
    print("  add()", add);
    print("  scores(), last 100", query);
}

}  // namespace
}  // namespace planemap::graph

int main(int argc, char** argv) {
    const int keyframes = argc > 1 ? std::atoi(argv[1]) : 2000;
    const int places = argc > 2 ? std::atoi(argv[2]) : 10000;
    if (keyframes < 2 || places < 0 || argc > 3) {
        std::fprintf(stderr,
                     "Usage: graph_benchmark [KEYFRAMES, 2 or more [PLACES, 0: optimisation alone]]\n");
        return 2;
    }
    planemap::graph::time_optimisation(keyframes);
    if (places == 0) return 0;
    planemap::graph::time_graph(keyframes);
    planemap::graph::time_index(places);
}
