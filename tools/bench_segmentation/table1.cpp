// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/table1.hpp"

#include <cmath>
#include <optional>
#include <set>

#include "bench_segmentation/metrics.hpp"
#include "core/geometry/angle.hpp"

namespace planemap::bench {

namespace {

constexpr int kFrames = 5;
constexpr double kDistances_m[] = {1.5, 2.5, 3.5};

/// The table as printed in the paper, on its machine.
const std::vector<Table1Row> kPaper{
    {1.5, {"paper", 1}, 2.37, 234813, 1.49, 0}, {1.5, {"paper", 2}, 0.23, 58797, 1.48, 0},
    {1.5, {"paper", 4}, 0.07, 14545, 1.49, 0},  {2.5, {"paper", 1}, 7.26, 125107, 2.44, 1},
    {2.5, {"paper", 2}, 1.78, 32320, 2.41, 2},  {2.5, {"paper", 4}, 0.4, 8619, 2.41, 0},
    {3.5, {"paper", 1}, 7.57, 62209, 3.32, 2},  {3.5, {"paper", 2}, 1.72, 14637, 3.37, 1},
    {3.5, {"paper", 4}, 0.4, 1904, 3.36, 0}};

/// The true surface that a found plane lies on: within 10 deg, and within tolerance() (at least 5 cm) of the
/// true plane where its middle ray meets it. -1 for none.
int surface_of(const Plane& found, const Truth& truth) {
    for (const TruePiece& piece : truth.pieces) {
        if (angle_between(found.normal, piece.plane.normal) > radians(10)) continue;
        if (std::abs(found.d - piece.plane.d) <= std::max(0.05, tolerance(piece.plane.d)))
            return piece.surface;
    }
    return -1;
}

/// What a method found in one frame.
struct Found {
    std::optional<double> distance_m;  // of the wall
    double inliers = 0;                // of the wall
    int false_planes = 0;
};

/// `wall` is the wall's surface. Of several regions on a surface the first is true: methods return the
/// largest first.
Found judge(const segmentation::Segmentation& segmentation, const Truth& truth, int wall) {
    Found found;
    std::set<int> seen;
    for (const PlanarRegion& region : segmentation.regions) {
        const int surface = surface_of(region.plane, truth);
        if (surface < 0 || !seen.insert(surface).second) {
            ++found.false_planes;
        } else if (surface == wall) {
            found.distance_m = region.plane.d;
            found.inliers = region.moments.count;
        }
    }
    return found;
}

/// The surface of most pixels.
int largest_surface(const Truth& truth) {
    const auto largest =
        std::max_element(truth.pieces.begin(), truth.pieces.end(),
                         [](const TruePiece& a, const TruePiece& b) { return a.pixels < b.pixels; });
    return largest == truth.pieces.end() ? -1 : largest->surface;
}

Json to_json(const Table1Row& row) {
    return {{"table", 1},
            {"method", row.method.name},
            {"distance_m", row.distance_m},
            {"subsampling", row.method.subsampling},
            {"runtime_s", row.seconds},
            {"inliers", row.inliers},
            {"estimated_distance_m", results::number(row.estimated_distance_m)},
            {"false_planes", row.false_planes}};
}

}  // namespace

BenchFrame wall_scene(double distance_m, std::uint64_t seed, const CameraInfo& camera) {
    using Eigen::Vector3d;
    const Vector3d east = Vector3d::UnitX(), north = Vector3d::UnitY(), down = -Vector3d::UnitZ();
    simulator::WorldBuilder builder("wall", seed, 8);
    builder.add_panel("wall", {-4, 0, 3}, east, down, 8, 3, {});
    builder.add_panel("floor", {-4, 0, 0}, east, -north, 8, 6, {});
    builder.add_box("box", {{0.45, -0.4, 0}, east, -down}, {0.3, 0.4, 0.95}, {}, {}, {});
    Pose world_from_camera = Pose::Identity();
    const double turn = radians(1.5 * static_cast<double>(seed % 5));
    Eigen::Matrix3d level;
    level << east, down, north;
    world_from_camera.linear() = Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * level;
    world_from_camera.translation() = Vector3d(0, -distance_m, 1.2);
    return render_frame(builder.world(), camera, world_from_camera, true, seed);
}

Table1Row measure_table1(const MethodName& name, double distance_m, const std::vector<BenchFrame>& frames,
                         const CameraInfo& camera) {
    Method method(name);
    std::vector<double> seconds, inliers, distances;
    double false_planes = 0;
    for (const BenchFrame& frame : frames) {
        seconds.push_back(1e-3 * method.run(frame.depth, camera));
        const Found found =
            judge(method.result(frame.depth, camera), *frame.truth, largest_surface(*frame.truth));
        false_planes += found.false_planes;
        inliers.push_back(found.inliers);
        if (found.distance_m) distances.push_back(*found.distance_m);
    }
    return {distance_m,        name,
            median(seconds),   median(inliers),
            median(distances), false_planes / static_cast<double>(frames.size())};
}

void print_table1(const std::vector<MethodName>& methods, benchmark::Report& report) {
    const results::Table table{{"method", "method", -19},      {"real m", "distance_m", 8, 1},
                               {"sub", "subsampling", 4},      {"runtime s", "runtime_s", 12, 5},
                               {"inliers", "inliers", 9},      {"estimate m", "estimated_distance_m", 10, 3},
                               {"false", "false_planes", 8, 1}};
    report.print(
        "\nTable 1 of the paper: a wall in front of a rendered Kinect, a box and the floor in view; " +
        std::to_string(kFrames) +
        " frames a row.\nInliers are counted as the method counts them: subsampled points.\n" +
        table.heading());
    for (const Table1Row& row : kPaper) report.print(table.line(to_json(row)));
    const CameraInfo camera = kinect_camera();
    for (const double distance : kDistances_m) {
        std::vector<BenchFrame> frames;
        for (int seed = 1; seed <= kFrames; ++seed)
            frames.push_back(wall_scene(distance, static_cast<std::uint64_t>(seed), camera));
        for (const MethodName& method : methods)
            report.add(to_json(measure_table1(method, distance, frames, camera)), table);
    }
}

}  // namespace planemap::bench
