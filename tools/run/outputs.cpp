// SPDX-License-Identifier: BSD-3-Clause
#include "run/outputs.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "evaluate/evaluation.hpp"
#include "map/export.hpp"
#include "map/map_file.hpp"
#include "messages/convert.hpp"
#include "run/coverage.hpp"
#include "run/input.hpp"
#include "run/losses.hpp"
#include "run/pipeline.hpp"
#include "run/report.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kBytesPerPoint = 12;  // three floats, as the paper counts

double cpu_seconds() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_rss_mb() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts in KiB
}

Json stage(const Histogram& ms) {
    return {{"median", ms.median()}, {"p95", ms.p95()}, {"count", ms.count()}, {"total_s", ms.sum() / 1000}};
}

Json stages(Pipeline& pipeline) {
    return {
        {"decode", stage(pipeline.decoder().decode_ms())},
        {"segmentation", stage(pipeline.segmentation().status().work_ms())},
        {"odometry", stage(pipeline.odometry().status().work_ms())},
        {"graph", stage(pipeline.graph() != nullptr ? pipeline.graph()->status().work_ms() : Histogram())},
        {"map", stage(pipeline.map().status().work_ms())},
        {"octomap",
         stage(pipeline.octomap() != nullptr ? pipeline.octomap()->status().work_ms() : Histogram())}};
}

void add_sizes(Pipeline& pipeline, std::int64_t frames, Json& report) {
    const PlaneMap& map = pipeline.map().mapper().map();
    Json sizes;
    sizes["plane_map_memory"] = pipeline.map().mapper().memory_bytes();
    sizes["plane_map_message"] = to_message(map, 0).getEncodedSize();
    const CameraInfo* camera = pipeline.decoder().camera();
    const double pixels = camera != nullptr ? double(camera->depth.width) * camera->depth.height : 0;
    Json octomap = {{"resolution_m", nullptr}, {"nodes", nullptr}};
    Json coverage = {{"leaves_explained", nullptr}, {"area_supported", nullptr}};
    for (const char* key : {"octomap_memory", "octomap_bt", "octomap_ot", "octomap_occupied_leaves"})
        sizes[key] = nullptr;
    sizes["raw_cloud"] = static_cast<std::int64_t>(kBytesPerPoint * pixels * static_cast<double>(frames));
    sizes["voxel_cloud_1cm"] = nullptr;
    if (pipeline.octomap() != nullptr) {
        const OctomapBuilder& builder = pipeline.octomap()->builder();
        const OctomapSizes s = builder.sizes();
        sizes["octomap_memory"] = s.memory_bytes;
        sizes["octomap_bt"] = s.bt_bytes;
        sizes["octomap_ot"] = s.ot_bytes;
        sizes["octomap_occupied_leaves"] =
            static_cast<std::int64_t>(kBytesPerPoint * static_cast<double>(s.occupied_leaves));
        sizes["voxel_cloud_1cm"] =
            static_cast<std::int64_t>(kBytesPerPoint * static_cast<double>(builder.voxel_cloud_size(0.01)));
        const double resolution = builder.tree().getResolution();
        octomap = {{"resolution_m", resolution},
                   {"nodes", s.nodes},
                   {"leaves", s.leaves},
                   {"occupied_leaves", s.occupied_leaves},
                   {"rebuilds", builder.rebuilds()}};
        const Coverage c = coverage_of(map, builder.occupied_voxels(), resolution);
        coverage = {{"leaves_explained", c.leaves_explained}, {"area_supported", c.area_supported}};
    }
    report["sizes_bytes"] = sizes;
    report["octomap"] = octomap;
    report["coverage"] = coverage;
}

void add_accuracy(const Trajectory& truth, const Trajectory& estimate, Json& report) {
    const Evaluation evaluation = evaluate(truth, estimate, {});
    if (!evaluation.ate || !evaluation.rpe_frame) return;
    report["accuracy"] = {{"ate_rmse_m", evaluation.ate->metres.rmse},
                          {"rpe_frame_rmse_m", evaluation.rpe_frame->metres.rmse},
                          {"rpe_frame_rmse_deg", evaluation.rpe_frame->degrees.rmse},
                          {"scale", evaluation.ate->scale},
                          {"pairs", evaluation.pairs}};
}

}  // namespace

RunClock::RunClock() : start_(std::chrono::steady_clock::now()), cpu_start_(cpu_seconds()) {}

void RunClock::stop() {
    wall_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    cpu_s_ = cpu_seconds() - cpu_start_;
}

Json write_outputs(const std::filesystem::path& folder, const std::string& input_name, const Input& input,
                   Pipeline& pipeline, const RunClock& clock) {
    const PlaneMap& map = pipeline.map().mapper().map();
    const Trajectory trajectory = pipeline.trajectory();
    write_trajectory(folder / "trajectory.txt", trajectory);
    write_file(folder / "planes.json", planes_json(map, pipeline.map().mapper().sightings()));
    write_file(folder / "planes.ply", planes_ply(map));
    write_file(folder / "planes.obj", planes_obj(map));
    write_file(folder / "planes.mtl", planes_mtl(map));
    write_file(folder / "planes.glb", planes_glb(map));
    write_file(folder / "floor_plan.geojson", floor_plan_geojson(map, trajectory));
    write_plane_map(folder / "plane_map.lcmlog", map);
    write_file(folder / "overhead.svg", overhead_svg(map, trajectory));
    write_file(folder / "map.svg", perspective_svg(map, trajectory));
    if (pipeline.octomap() != nullptr) write_file(folder / "octomap.bt", pipeline.octomap()->builder().bt());
    input.write_truth(folder);

    const auto& estimates = pipeline.estimates();
    const auto tracked = std::count_if(estimates.begin(), estimates.end(),
                                       [](const auto& e) { return e.status != TrackingStatus::kLost; });
    const KeyframeTrajectory& keyframes = pipeline.keyframes();
    Json report;
    report["input"] = input_name;
    report["frames"] = input.frames();
    report["tracked"] = tracked;
    report["lost"] = static_cast<std::int64_t>(estimates.size()) - tracked;
    report["broken"] = input.frames() - static_cast<std::int64_t>(estimates.size());
    report["keyframes"] = keyframes.keyframes.size();
    report["loop_closures"] = keyframes.loop_closures;
    report["planes"] = map.planes.size();
    report["losses"] = losses_of(pipeline);
    report["wall_s"] = clock.wall_s();
    report["cpu_s"] = clock.cpu_s();
    report["peak_rss_mb"] = peak_rss_mb();
    report["stages_ms"] = stages(pipeline);
    const double octomap_s = report["stages_ms"]["octomap"]["total_s"].get<double>();
    report["frames_per_s_without_octomap"] =
        static_cast<double>(input.frames()) / std::max(clock.wall_s() - octomap_s, 1e-9);
    add_sizes(pipeline, input.frames(), report);
    if (const auto truth = input.truth()) add_accuracy(*truth, trajectory, report);
    write_file(folder / "report.md", report_markdown(report));
    write_file(folder / "report.json", report.dump(2) + "\n");
    return report;
}

}  // namespace planemap
