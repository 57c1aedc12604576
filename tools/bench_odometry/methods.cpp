// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/methods.hpp"

#include <algorithm>
#include <map>

#include "bench_odometry/peers.hpp"
#include "benchmark/choices.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "run/input.hpp"

namespace planemap::bench_odometry {

namespace {

pipeline::PipelineOptions options_of(const std::string& method, pipeline::PipelineOptions options) {
    if (method.starts_with("paper")) options.odometry.method = "paper";
    options.with_graph = !method.ends_with("-no-graph");
    options.with_map = options.with_octomap = false;
    return options;
}

/// The graph's closures, at the moments that its keyframes' poses are of.
std::vector<evaluation::Closure> closures_of(pipeline::Pipeline& pipeline) {
    const auto pose_utime = [&](std::int64_t utime) {
        const auto& estimates = pipeline.estimates();
        const auto estimate =
            std::find_if(estimates.begin(), estimates.end(), [&](const auto& e) { return e.utime == utime; });
        return estimate == estimates.end() ? utime : estimate->pose_utime;
    };
    std::vector<evaluation::Closure> closures;
    for (const graph::LoopClosure& closure : pipeline.graph()->graph().loop_closures())
        closures.push_back(
            {pose_utime(closure.from_utime), pose_utime(closure.to_utime), closure.from_from_to});
    return closures;
}

/// What odometry says of frames against keyframes; `keyframes` are the moments of these by their ids.
std::vector<Relative> relatives_of(const pipeline::Pipeline& pipeline,
                                   const std::map<int, std::int64_t>& keyframes) {
    std::vector<Relative> relatives;
    for (const OdometryEstimate& estimate : pipeline.estimates()) {
        const auto keyframe = keyframes.find(estimate.keyframe_id);
        if (!is_tracked(estimate.status) || keyframe == keyframes.end()) continue;
        relatives.push_back(
            {keyframe->second, estimate.pose_utime, estimate.keyframe_from_camera, estimate.covariance});
    }
    return relatives;
}

MethodRun run_planemap(const std::string& input_name, std::int64_t max_frames,
                       const pipeline::PipelineOptions& options,
                       const std::function<void(std::int64_t)>& on_frame) {
    messages::Bus bus("memq://");
    pipeline::Pipeline pipeline(bus, options);
    std::map<int, std::int64_t> keyframes;
    bus.subscribe(messages::channels::kKeyframe, [&](const messages::RawMessage& message) {
        const Keyframe keyframe = messages::from_message(messages::decode<keyframe_t>(message.bytes));
        keyframes[keyframe.id] = keyframe.pose_utime;
    });
    const std::unique_ptr<Input> input = open_input(input_name, bus, {.camera = options.camera});
    feed_all(*input, max_frames, [&](std::int64_t frames) {
        pipeline.settle();
        on_frame(frames);
    });
    pipeline.finish();
    MethodRun run;
    run.frames = input->frames();
    run.trajectory = pipeline.trajectory();
    run.relatives = relatives_of(pipeline, keyframes);
    run.tracking = stage_time(pipeline.odometry().status().work_cpu_ms());
    run.segmentation = stage_time(pipeline.segmentation().status().work_cpu_ms());
    run.decoding = stage_time(pipeline.decoder().decode_ms());
    if (options.with_graph) {
        run.graph = stage_time(pipeline.graph()->status().work_cpu_ms());
        run.keyframes = static_cast<int>(pipeline.graph()->graph().trajectory().keyframes.size());
        run.closures = closures_of(pipeline);
    }
    return run;
}

}  // namespace

const std::vector<MethodInfo>& known_methods() {
    static const std::vector<MethodInfo> kMethods{
        {"default", "our odometry and graph with their default options"},
        {"default-no-graph", "the odometry alone: its drift before any closure"},
        {"paper", "the paper's odometry (planar points only, frame to frame), and our graph"},
        {"paper-no-graph", "the paper's odometry alone"},
        {"opencv-rgbd", "OpenCV's RgbdOdometry (Steinbruecker et al. 2011), frame to frame", true},
        {"opencv-rgbdicp", "OpenCV's RgbdICPOdometry, frame to frame", true},
    };
    return kMethods;
}

std::vector<MethodInfo> parse_methods(const std::string& list) {
    return benchmark::chosen("methods", list, known_methods());
}

MethodRun run_method(const std::string& method, const std::string& input, std::int64_t max_frames,
                     const pipeline::PipelineOptions& options,
                     const std::function<void(std::int64_t)>& on_frame) {
    if (method.starts_with("opencv-")) return run_peer(method, input, max_frames, on_frame);
    return run_planemap(input, max_frames, options_of(method, options), on_frame);
}

}  // namespace planemap::bench_odometry
