// SPDX-License-Identifier: BSD-3-Clause
#include "run/outputs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/components.hpp"
#include "core/files.hpp"
#include "core/processor_time.hpp"
#include "evaluate/point_sample.hpp"
#include "evaluate/soundness_report.hpp"
#include "map/map_file.hpp"
#include "messages/convert.hpp"
#include "pipeline/pipeline.hpp"
#include "run/accuracy.hpp"
#include "run/depth_watch.hpp"
#include "run/doubts.hpp"
#include "run/growth.hpp"
#include "run/input.hpp"
#include "run/leaf_accuracy.hpp"
#include "run/losses.hpp"
#include "run/map_results.hpp"
#include "run/report.hpp"
#include "run/size_report.hpp"
#include "run/size_rows.hpp"
#include "run/stages.hpp"
#include "run/warnings.hpp"
#include "run/worth.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

constexpr char kPointsComment[] =
    "planemap: depth readings of a run and the planes that explain them, world frame";

double cpu_seconds() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return processor_seconds(usage);
}

double peak_rss_mb() {
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;  // Linux counts in KiB
}

}  // namespace

RunClock::RunClock() : start_(std::chrono::steady_clock::now()), cpu_start_(cpu_seconds()) {}

void RunClock::stop() {
    wall_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    cpu_s_ = cpu_seconds() - cpu_start_;
}

std::int64_t tracked_frames(const pipeline::Pipeline& pipeline) {
    const auto& estimates = pipeline.estimates();
    if (pipeline.given_poses() != nullptr) {  // whatever was seen: a frame has its pose where they have one
        const auto parts = pipeline.trajectories();
        return std::accumulate(parts.begin(), parts.end(), std::int64_t{0},
                               [](std::int64_t sum, const auto& part) {
                                   return sum + static_cast<std::int64_t>(part.trajectory.size());
                               });
    }
    return std::count_if(estimates.begin(), estimates.end(), [](const auto& e) { return is_placed(e); });
}

namespace {

/// Empty for a component that no frame is of.
Trajectory trajectory_of(const pipeline::Pipeline& pipeline, int component) {
    for (ComponentTrajectory& part : pipeline.trajectories())
        if (part.component == component) return std::move(part.trajectory);
    return {};
}

/// Of a component.
MapSource map_source(pipeline::Pipeline& pipeline, const map::PlaneMapper& mapper) {
    // The map in memory: what is exported from the stored one later is the same to 5 mm.
    return {std::make_shared<const PlaneMap>(mapper.map()),
            [&pipeline, component = mapper.map().component] { return trajectory_of(pipeline, component); },
            [&mapper] { return mapper.sightings(); }, [&mapper] { return mapper.seen_space(); }};
}

}  // namespace

std::vector<Result> essential_results(pipeline::Pipeline& pipeline) {
    std::vector<Result> results;
    std::size_t number = 0;
    for (const map::PlaneMapper* mapper : pipeline.map().maps().all()) {
        if (++number > kMostComponentFiles) break;
        for (Result& result : essential_results(map_source(pipeline, *mapper), number))
            results.push_back(std::move(result));
    }
    return results;
}

namespace {

/// Unit vector, world; null if it is not known.
Json up_of(const PlaneMap& map) {
    if (map.up.isZero()) return nullptr;
    Json direction = Json::array();
    for (int i = 0; i < 3; ++i)
        direction.push_back(std::round(1e6 * static_cast<double>(map.up[i])) / 1e6 + 0.0);
    return direction;
}

/// What the graph says of the sensor's depth, at a range where a room's walls are: how far readings are off,
/// RMS over the image's nodes, how certain that is, and what readings scatter by. Null without a graph.
Json depth_off(pipeline::Pipeline& pipeline) {
    constexpr double kRange_m = 3;
    const CameraInfo* camera = pipeline.decoder().camera();
    if (pipeline.graph() == nullptr || camera == nullptr) return nullptr;
    const graph::BentDepth bent = pipeline.graph()->graph().bent_depth(*camera, {});
    if (!bent.is_known) return nullptr;
    const auto rms_m = [](const auto& per_metre) {
        double squares = 0;
        for (const double value : per_metre) squares += value * value;
        return kRange_m * kRange_m * std::sqrt(squares / static_cast<double>(per_metre.size()));
    };
    return {{"range_m", kRange_m},
            {"off_m", rms_m(bent.correction.offsets)},
            {"sigma_m", rms_m(bent.correction.sigmas)},
            {"noise_m", camera->noise.sigma(kRange_m)}};
}

/// What hangs together and what does not, the largest first: all other figures, and the pictures, are of
/// that.
Json components_of(pipeline::Pipeline& pipeline) {
    std::map<int, std::size_t> keyframes;
    for (const KeyframePose& keyframe : pipeline.keyframes().keyframes) ++keyframes[keyframe.component];
    const auto time = [](const StampedPose& pose) {
        const std::int64_t ms = pose.utime / 1000;
        return static_cast<double>(ms) / 1000;
    };
    Json components = Json::array();
    for (const map::PlaneMapper* mapper : pipeline.map().maps().all()) {
        const int id = mapper->map().component;
        const Trajectory trajectory = trajectory_of(pipeline, id);
        const std::size_t number = components.size() + 1;
        Json& component = components.emplace_back();
        component["component"] = id;
        component["keyframes"] = keyframes[id];
        component["frames"] = trajectory.size();
        component["planes"] = mapper->map().planes.size();
        component["from_s"] = trajectory.empty() ? Json() : Json(time(trajectory.front()));
        component["to_s"] = trajectory.empty() ? Json() : Json(time(trajectory.back()));
        component["trajectory"] =
            number <= kMostComponentFiles ? Json(component_file("trajectory.txt", number)) : Json();
    }
    return components;
}

/// Holds the map, as the message gives it whose size is told, against the depth of the run: figures into the
/// report; the readings' sample.
std::vector<CloudPoint> judge(pipeline::Pipeline& pipeline, const DepthWatch& depth, Json& report) {
    const std::vector<evaluation::PosedView> views = depth.posed(pipeline.trajectory());
    const PlaneMap sent = messages::from_message(messages::to_message(pipeline.map().mapper().map(), 0));
    evaluation::PointSample sample(views);
    LeafAccuracy accuracy(pipeline.octomap() != nullptr ? &pipeline.octomap()->builder().tree() : nullptr);
    const evaluation::Soundness soundness = evaluation::soundness(sent, views, {}, [&](const auto& reading) {
        sample.add(reading);
        accuracy.add(reading);
    });
    report.update(evaluation::soundness_figures(soundness));
    report["coverage"].update(evaluation::coverage_figures(soundness));
    report["accuracy_beside_size"] = accuracy.figures();
    return sample.points();
}

std::vector<std::string> doubts_of(pipeline::Pipeline& pipeline, const RunWatch& watch) {
    std::vector<std::string> doubts = doubts_of_depth(watch.depth.count());
    if (const pipeline::GivenPoses* given = pipeline.given_poses())
        doubts.push_back(doubt_of_given_poses(given->poses(), pipeline.estimates()));
    doubts.push_back(doubt_of_start(watch.start, pipeline.map().mapper().map()));
    std::erase(doubts, "");
    return doubts;
}

/// What a report is of, and what came to light with it.
// As PageSource.
// NOLINTNEXTLINE(bugprone-exception-escape)
struct Reported {
    Json report;
    std::vector<CloudPoint> points;
};

Reported report_of(const std::string& input_name, const Input& input, pipeline::Pipeline& pipeline,
                   const RunWatch& watch, const Json& about) {
    const PlaneMap& map = pipeline.map().mapper().map();
    const auto& estimates = pipeline.estimates();
    const std::int64_t tracked = tracked_frames(pipeline);
    const KeyframeTrajectory& keyframes = pipeline.keyframes();
    const StageTimer whole;
    Json report;
    report["input"] = input_name;
    report["frames"] = input.frames();
    report["tracked"] = tracked;
    const auto with_status = [&](TrackingStatus status) {
        return std::count_if(estimates.begin(), estimates.end(),
                             [&](const auto& e) { return e.status == status; });
    };
    report["lost"] = static_cast<std::int64_t>(estimates.size()) - tracked;
    report["stale"] = with_status(TrackingStatus::kStale);
    report["degenerate"] = with_status(TrackingStatus::kDegenerate);
    report["broken"] = input.frames() - static_cast<std::int64_t>(estimates.size());
    report["interrupted"] = !input.is_at_end();
    report["keyframes"] = keyframes.keyframes.size();
    report["loop_closures"] = keyframes.loop_closures;
    report["components"] = components_of(pipeline);
    report["planes"] = map.planes.size();
    report["up"] = {{"direction", up_of(map)}, {"why", pipeline.map().mapper().why_up()}};
    report["depth_off"] = depth_off(pipeline);
    report["losses"] = losses_of(pipeline);
    report["wall_s"] = watch.clock.wall_s();
    report["cpu_s"] = watch.clock.cpu_s();
    report["peak_rss_mb"] = peak_rss_mb();
    report["stages_ms"] = stages_of(input, pipeline);
    const double octomap_s = report["stages_ms"]["octomap"]["total_s"].get<double>();
    report["frames_per_s_without_octomap"] =
        static_cast<double>(input.frames()) / std::max(watch.clock.wall_s() - octomap_s, 1e-9);
    std::vector<std::string> complaints = input.complaints();
    if (!input.failure().empty()) complaints.push_back(input.failure());
    for (const std::string& line : pipeline.complaints().totals()) complaints.push_back(line);
    report["complaints"] = complaints;
    const StageTimer sizing;
    add_sizes(pipeline, input.frames(), watch.size_resolutions_m, report);
    Json sizes = sizing.figures();
    add_accuracy(input, pipeline, report);
    std::vector<CloudPoint> points = judge(pipeline, watch.depth, report);
    report["growth"] = watch.growth.figures();
    report["headline"] = headline_of(report);
    std::vector<std::string> warnings =
        warnings_of(estimates, pipeline.given_poses() != nullptr, pipeline.reason_lost(), report);
    for (const std::string& remark : remarks_of(pipeline)) warnings.push_back(remark);
    for (const std::string& doubt : doubts_of(pipeline, watch)) warnings.push_back(doubt);
    report["warnings"] = warnings;
    report.update(about);
    report["stages_ms"]["report"] = whole.figures();
    sizes["part_of"] = "report";
    report["stages_ms"]["sizes"] = std::move(sizes);
    return {std::move(report), std::move(points)};
}

/// What can be had from the essential results, or is less than them: the small first, the largest last.
std::vector<Result> further_results(const Input& input, pipeline::Pipeline& pipeline,
                                    const Reported& reported, const ResultFolder& folder) {
    std::vector<Result> results = report_results(reported.report);
    const MapSource source = map_source(pipeline, pipeline.map().mapper());
    for (Result& truth : input.truth_results()) results.push_back(std::move(truth));
    for (Result& drawn : drawn_results(source)) results.push_back(std::move(drawn));
    if (!reported.report.is_null()) {
        results.push_back({kPointsFile, [&points = reported.points](const auto& file) {
                               write_file(file, exports::points_ply(points, kPointsComment));
                           }});
    }
    for (Result& page : page_results(source, reported.report, folder.made(kPointsFile)))
        results.push_back(std::move(page));
    if (pipeline.octomap() != nullptr)
        results.push_back({kOctomapFile, [&pipeline](const auto& file) {
                               write_file(file, pipeline.octomap()->builder().bt());
                           }});
    return results;
}

/// Why the results must not take the place of the earlier ones in the folder; empty if they may.
std::string why_poorer(const std::filesystem::path& folder, const Input& input,
                       pipeline::Pipeline& pipeline) {
    const RunWorth run{input.frames(), tracked_frames(pipeline), !input.is_at_end()};
    std::string why = why_not_replace(run, worth_in(folder));
    if (!why.empty() || !pipeline.map().mapper().map().planes.empty()) return why;
    return map::may_hold_planes(folder / "plane_map.lcmlog") ? "no planes in its map" : "";
}

}  // namespace

std::vector<std::string> result_names(const std::filesystem::path& folder, const Input& input) {
    std::vector<std::string> names = map_result_names();
    for (const char* name : {kOctomapFile, kPointsFile}) names.emplace_back(name);
    const std::vector<std::string> truth{"groundtruth.txt", "planes_truth.json"};
    std::error_code ignored;
    bool simulated_before = false;
    try {
        const Json report = Json::parse(read_file(folder / "report.json"));
        simulated_before = report.at("input").get<std::string>().starts_with("sim:");
    } catch (const std::exception&) {
        // No earlier run, or none that can be read: then nothing there is known to be its truth.
    }
    if (simulated_before) {
        names.insert(names.end(), truth.begin(), truth.end());
        return names;
    }
    for (const Result& result : input.truth_results()) {
        if (std::filesystem::exists(folder / result.name, ignored)) {
            throw std::runtime_error((folder / result.name).string() +
                                     ": is there, and not of an earlier run on the simulator: give another "
                                     "--output");
        }
        names.push_back(result.name);
    }
    return names;
}

Outputs write_outputs(ResultFolder& folder, const std::string& input_name, const Input& input,
                      pipeline::Pipeline& pipeline, const RunWatch& watch, const Json& about) {
    Outputs outputs;
    const auto attempt = [&](const std::function<void()>& action) {
        try {
            action();
            return true;
        } catch (const std::exception& error) {
            outputs.failures.emplace_back(error.what());
            return false;
        }
    };
    const auto make = [&](const std::vector<Result>& results) {
        for (const Result& result : results)
            if (attempt([&] { folder.make(result); })) outputs.files.push_back(result.name);
    };
    make(essential_results(pipeline));  // before the report, which takes a while
    Reported reported;
    attempt([&] { reported = report_of(input_name, input, pipeline, watch, about); });
    make(further_results(input, pipeline, reported, folder));
    outputs.report = std::move(reported.report);

    const bool whole = outputs.failures.empty(), holds_earlier = folder.holds_earlier();
    if (holds_earlier) outputs.why_aside = why_poorer(folder.path(), input, pipeline);
    const bool poorer = !outputs.why_aside.empty();
    if (poorer && tracked_frames(pipeline) == 0) {
        attempt([&] { folder.discard(); });
    } else if (poorer || (!whole && holds_earlier)) {
        attempt([&] { outputs.folder = folder.set_aside(); });
    } else if (attempt([&] { folder.replace(); })) {
        outputs.folder = folder.path();
    }
    outputs.kept_earlier = outputs.folder != folder.path() && folder.holds_earlier();
    return outputs;
}

}  // namespace planemap
