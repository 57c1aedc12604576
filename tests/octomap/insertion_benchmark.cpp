// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/insertion_benchmark.hpp"

#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <optional>

#include "core/trajectory.hpp"
#include "core/trajectory_file.hpp"
#include "messages/module_status.hpp"
#include "octomap/keyframe_tracer.hpp"
#include "octomap/octomap_sizes.hpp"
#include "octomap/scan_insertion.hpp"
#include "octomap/tree_blocks.hpp"
#include "sensor/source.hpp"

namespace planemap::octomap {

namespace {

constexpr std::int64_t kMaxGapUs = 100000;  // between two poses

struct View {
    std::shared_ptr<const StoredScan> scan;
    Pose world_from_camera;
};

std::vector<View> views_of(const std::string& input, const Trajectory& poses, int every) {
    const std::unique_ptr<FrameSource> source = sensor::open_source(input);
    std::vector<View> views;
    SensorFrame frame;
    for (int i = 0;; ++i) {
        const ReadResult read = source->next(frame);
        if (read.status == ReadResult::Status::kEnd) return views;
        if (read.status != ReadResult::Status::kFrame || i % every != 0) continue;
        if (const std::optional<Pose> pose = pose_at(poses, frame.utime, kMaxGapUs))
            views.push_back({std::make_shared<StoredScan>(frame.depth, source->camera()), *pose});
    }
}

double cpu_ms(const std::function<void()>& work) {
    const double start = messages::thread_cpu_ms();
    work();
    return messages::thread_cpu_ms() - start;
}

void print(const char* what, double total_ms, std::size_t views, double unit_ms) {
    std::printf("%-58s %8.2f ms a view  x %.3f\n", what, total_ms / static_cast<double>(views),
                total_ms / unit_ms);
}

int run(const std::string& input, const std::string& poses, double resolution_m, int every) {
    const std::vector<View> views = views_of(input, read_trajectory_file(poses).poses, every);
    if (views.empty()) throw std::runtime_error(poses + ": has no pose within 0.1 s of the frames");
    std::printf("%zu views of %s, %g m\n", views.size(), input.c_str(), resolution_m);
    ::octomap::OcTree plain(resolution_m), lazy(resolution_m), ours(resolution_m);
    double plain_ms = 0, lazy_ms = 0, points_ms = 0, trace_ms = 0, apply_ms = 0;
    ScanInserter inserter;
    for (const View& view : views) {
        const double max_range = view.scan->camera().depth_max_m;
        const ::octomap::point3d origin = view.scan->origin(view.world_from_camera);
        std::vector<::octomap::point3d> points;
        points_ms += cpu_ms([&] { points = view.scan->points(view.world_from_camera, 1); });
        ::octomap::Pointcloud cloud;
        for (const ::octomap::point3d& p : points) cloud.push_back(p);
        plain_ms += cpu_ms([&] { plain.insertPointCloud(cloud, origin, max_range); });
        lazy_ms += cpu_ms([&] { lazy.insertPointCloud(cloud, origin, max_range, true, true); });
        trace_ms += cpu_ms([&] { inserter.trace(ours, points, origin, max_range); });
        apply_ms += cpu_ms([&] { inserter.apply(ours); });
    }
    lazy_ms += cpu_ms([&] {
        lazy.updateInnerOccupancy();
        lazy.prune();
    });
    const double finish_ms = cpu_ms([&] { bring_up_to_date(ours); });
    const double ours_ms = points_ms + trace_ms + apply_ms + finish_ms;
    print("OctoMap's insertPointCloud()", plain_ms, views.size(), plain_ms);
    print("OctoMap's, discretize and lazy_eval, and its end", lazy_ms, views.size(), plain_ms);
    print("ours, stored depth to tree", ours_ms, views.size(), plain_ms);
    print("  stored depth to points", points_ms, views.size(), plain_ms);
    print("  points to cells", trace_ms, views.size(), plain_ms);
    print("  cells to tree", apply_ms, views.size(), plain_ms);
    print("  the end: inner nodes, pruning", finish_ms, views.size(), plain_ms);
    const bool is_same = ot_of(ours) == ot_of(lazy);
    std::printf("%zu nodes; the tree is %s OctoMap's\n", ours.size(), is_same ? "the same as" : "NOT");
    return is_same ? 0 : 1;
}

}  // namespace

int insertion_benchmark(const std::vector<std::string>& arguments) {
    try {
        if (arguments.size() < 2) throw std::runtime_error("insertion INPUT POSES [resolution] [every]");
        return run(arguments[0], arguments[1], arguments.size() > 2 ? std::stod(arguments[2]) : 0.05,
                   arguments.size() > 3 ? std::stoi(arguments[3]) : 10);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "octomap_benchmark: %s\n", error.what());
        return 2;
    }
}

}  // namespace planemap::octomap
