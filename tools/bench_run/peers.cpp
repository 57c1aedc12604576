// SPDX-License-Identifier: BSD-3-Clause
#include "bench_run/peers.hpp"

#include <octomap/OcTree.h>

#include <algorithm>
#include <functional>

#include "benchmark/child.hpp"
#include "benchmark/rgbd_plane.hpp"
#include "core/histogram.hpp"
#include "core/trajectory.hpp"
#include "core/trajectory_file.hpp"
#include "messages/module_status.hpp"
#include "octomap/options.hpp"
#include "octomap/stored_scan.hpp"
#include "sensor/source.hpp"

namespace planemap::bench_run {

namespace {

using results::Json;

constexpr std::int64_t kMaxGap_us = 100000;  // between two poses
constexpr int kStep = 4;                     // RgbdPlane takes every 4th pixel

/// What a method takes a frame, ms of CPU; negative: it did not take this one.
using Measured = std::function<double(const SensorFrame&, const CameraInfo&)>;

/// Frames to leave out between two, so that at most `most` are taken; of a source that does not tell its
/// size, none.
std::size_t stride(const FrameSource& source, int frames, int most) {
    std::size_t size = source.size().value_or(0);
    if (frames > 0) size = std::min(size, static_cast<std::size_t>(frames));
    return std::max<std::size_t>(
        1, (size + static_cast<std::size_t>(most) - 1) / static_cast<std::size_t>(most));
}

Json measure(const std::string& input, int frames, int most, const Measured& measured) {
    const std::unique_ptr<FrameSource> source = sensor::open_source(input);
    const std::size_t every = stride(*source, frames, most);
    Histogram ms;
    SensorFrame frame;
    for (std::size_t i = 0; frames == 0 || i < static_cast<std::size_t>(frames); ++i) {
        const ReadResult read = source->next(frame);
        if (read.status == ReadResult::Status::kEnd) break;
        if (read.status != ReadResult::Status::kFrame || i % every != 0) continue;
        if (const double took = measured(frame, source->camera()); took >= 0) ms.add(took);
    }
    return {{"frames", ms.count()}, {"median_ms", ms.median()}, {"total_ms", ms.sum()}};
}

Json in_child(const std::function<Json()>& work) {
    const benchmark::ChildResult child = benchmark::run_in_child([&] { return nlohmann::json(work()); });
    Json result = child.value;
    result["peak_rss_mb"] = child.peak_rss_mb;
    return result;
}

}  // namespace

Json measure_rgbd_plane(const std::string& input, int frames, int most) {
    return in_child([&] {
        const auto finder = benchmark::make_rgbd_plane(benchmark::rgbd_plane_block_px(kStep), false);
        return measure(input, frames, most, [&](const SensorFrame& frame, const CameraInfo& camera) {
            return benchmark::timed_find(*finder, frame.depth, camera, kStep);
        });
    });
}

Json measure_octomap(const std::string& input, const std::filesystem::path& trajectory, int frames,
                     int most) {
    return in_child([&] {
        const Trajectory poses = read_trajectory_file(trajectory).poses;
        const octomap::OctomapOptions options;
        ::octomap::OcTree tree(options.resolution_m);
        return measure(input, frames, most, [&](const SensorFrame& frame, const CameraInfo& camera) {
            const std::optional<Pose> pose = pose_at(poses, frame.utime, kMaxGap_us);
            if (!pose) return -1.0;
            const octomap::StoredScan scan(frame.depth, camera);
            ::octomap::Pointcloud cloud;
            for (const ::octomap::point3d& p : scan.points(*pose, 1)) cloud.push_back(p);
            const double start_ms = messages::thread_cpu_ms();
            tree.insertPointCloud(cloud, scan.origin(*pose), camera.depth_max_m, true, true);
            return messages::thread_cpu_ms() - start_ms;
        });
    });
}

}  // namespace planemap::bench_run
