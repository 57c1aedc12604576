// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/run.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "bench_map/true_poses.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/module_status.hpp"
#include "run/depth_watch.hpp"
#include "run/input.hpp"

namespace planemap::bench_map {

namespace {

constexpr unsigned kNoiseSeed = 1;

MapRun map_run_of(const map::PlaneMapper& mapper, const Histogram& update_ms,
                  const KeyframeTrajectory& poses) {
    MapRun run;
    run.map = mapper.map();
    run.poses = poses;
    run.message_bytes = static_cast<std::size_t>(messages::to_message(run.map, 0).getEncodedSize());
    run.memory_bytes = mapper.memory_bytes();
    run.update_median_ms = update_ms.median();
    run.update_p95_ms = update_ms.p95();
    return run;
}

/// The map beside an OctoMap at the same poses.
Coverage coverage_at(const MapRun& run, octomap::OctomapBuilder& octomap) {
    octomap.update(run.poses);
    octomap.flush();
    return coverage_of(run.map, octomap.occupied_voxels(), octomap.tree().getResolution());
}

}  // namespace

SequenceRun run_sequence(const std::string& input_name, const RunOptions& options,
                         const std::function<void(std::int64_t)>& on_frame) {
    SequenceRun run;
    messages::Bus bus("memq://");
    pipeline::Pipeline pipeline(bus, options.pipeline);
    bus.subscribe(messages::channels::kKeyframe, [&run](const messages::RawMessage& message) {
        run.keyframes.push_back(messages::from_message(messages::decode<keyframe_t>(message.bytes)));
        run.keyframes.back().features = {};
    });
    const DepthWatch depth(pipeline.decoder());
    const std::unique_ptr<Input> input = open_input(input_name, bus, {.camera = options.pipeline.camera});
    feed_all(*input, options.frames, [&](std::int64_t frames) {
        pipeline.settle();
        on_frame(frames);
    });
    pipeline.finish();
    if (run.keyframes.empty()) throw std::runtime_error(input_name + ": no keyframe in it");
    run.frames = input->frames();
    run.truth = input->truth();

    const map::MapOptions& map_options = options.pipeline.map.map;
    octomap::OctomapShell* octomap = pipeline.octomap();
    map::MapShell& shell = pipeline.map();
    run.estimated = map_run_of(shell.mapper(), shell.status().work_cpu_ms(), pipeline.keyframes());
    run.estimated.rebuild_ms = time_rebuild(run.keyframes, run.estimated.poses, map_options);
    if (octomap != nullptr) run.estimated.coverage = coverage_at(run.estimated, octomap->builder());
    run.estimated.soundness = evaluation::soundness(run.estimated.map, depth.posed(pipeline.trajectory()));
    if (!run.truth) return run;
    const auto mapped_at = [&](const Trajectory& trajectory) {
        const KeyframeTrajectory poses = at_poses(run.keyframes, trajectory);
        MapRun mapped = map_at(run.keyframes, poses, map_options);
        mapped.rebuild_ms = time_rebuild(run.keyframes, poses, map_options);
        if (octomap != nullptr) mapped.coverage = coverage_at(mapped, octomap->builder());
        mapped.soundness = evaluation::soundness(mapped.map, depth.posed(trajectory));
        return mapped;
    };
    if (options.true_poses) run.true_poses = mapped_at(*run.truth);
    for (const PoseNoise& noise : options.noise)
        run.noisy.push_back(mapped_at(with_noise(*run.truth, noise, kNoiseSeed)));
    return run;
}

MapRun map_at(const std::vector<Keyframe>& keyframes, const KeyframeTrajectory& poses,
              const map::MapOptions& options) {
    map::PlaneMapper mapper(options);
    Histogram update_ms;
    KeyframeTrajectory so_far = poses;
    so_far.keyframes.clear();
    for (const KeyframePose& pose : poses.keyframes) {
        const auto keyframe = std::find_if(keyframes.begin(), keyframes.end(),
                                           [&](const Keyframe& k) { return k.id == pose.id; });
        if (keyframe == keyframes.end()) continue;
        so_far.keyframes.push_back(pose);
        so_far.utime = pose.utime;
        mapper.add(*keyframe);
        const double start_ms = messages::thread_cpu_ms();
        mapper.update(so_far);
        update_ms.add(messages::thread_cpu_ms() - start_ms);
    }
    mapper.settle();
    return map_run_of(mapper, update_ms, poses);
}

double time_rebuild(const std::vector<Keyframe>& keyframes, const KeyframeTrajectory& poses,
                    const map::MapOptions& options) {
    constexpr int kTimes = 6;
    map::PlaneMapper mapper(options);
    for (const Keyframe& keyframe : keyframes) mapper.add(keyframe);
    mapper.update(poses);
    KeyframeTrajectory moved = poses;
    Histogram rebuild_ms;
    for (int i = 0; i < kTimes; ++i) {
        ++moved.revision;
        for (KeyframePose& pose : moved.keyframes)
            pose.world_from_camera.pretranslate(Eigen::Vector3d(i % 2 == 0 ? 0.01 : -0.01, 0, 0));
        const auto start = std::chrono::steady_clock::now();  // a rebuild has several threads
        mapper.update(moved);
        rebuild_ms.add(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    return rebuild_ms.median();
}

}  // namespace planemap::bench_map
