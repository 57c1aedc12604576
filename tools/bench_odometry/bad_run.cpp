// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/bad_run.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "bench_odometry/scripted_source.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "sensor/sensor_shell.hpp"

namespace planemap::bench_odometry {

namespace {

/// Truth is recorded at 25 to 100 Hz; a fifth of a second without is a gap.
constexpr std::int64_t kMaxGap_us = 200000;

sensor::SensorShellOptions in_process() {
    sensor::SensorShellOptions options;
    options.speed = 0;
    options.color = options.depth = "raw";
    return options;
}

/// The last frame of that stamp: stamps may come twice.
std::size_t frame_at(const std::vector<std::int64_t>& stamps, std::int64_t utime) {
    const auto last = std::find(stamps.rbegin(), stamps.rend(), utime);
    return last == stamps.rend() ? stamps.size() : static_cast<std::size_t>(stamps.rend() - last) - 1;
}

}  // namespace

const ToldKeyframe* Told::find(int id) const {
    const auto found = std::find_if(keyframes.begin(), keyframes.end(),
                                    [&](const ToldKeyframe& keyframe) { return keyframe.id == id; });
    return found == keyframes.end() ? nullptr : &*found;
}

Told run_script(std::unique_ptr<FrameSource> source, const Script& script, const Trajectory& truth,
                const pipeline::PipelineOptions& options, const std::function<void(std::int64_t)>& on_frame) {
    messages::Bus bus("memq://");
    pipeline::Pipeline pipeline(bus, options);
    Told told;
    std::vector<std::int64_t> stamps;
    bus.subscribe(messages::channels::kKeyframe, [&](const messages::RawMessage& message) {
        const Keyframe keyframe = messages::from_message(messages::decode<keyframe_t>(message.bytes));
        told.keyframes.push_back({keyframe.id, keyframe.previous_id, frame_at(stamps, keyframe.utime),
                                  keyframe.odom_from_camera, keyframe.covariance});
    });
    auto scripted = std::make_unique<ScriptedSource>(std::move(source), script);
    const ScriptedSource& shown = *scripted;
    sensor::SensorShell sensor(bus, std::move(scripted), in_process());
    std::size_t heard = 0;
    const auto hear = [&] {
        for (; heard < pipeline.estimates().size(); ++heard) {
            const OdometryEstimate& estimate = pipeline.estimates()[heard];
            const std::size_t frame = frame_at(stamps, estimate.utime);
            if (frame < told.frames.size()) told.frames[frame].estimate = estimate;
        }
    };
    while (sensor.poll() >= 0) {
        if (stamps.size() == shown.moments().size()) continue;
        stamps.push_back(sensor.last_utime());
        told.frames.push_back({{}, pose_at(truth, shown.moments().back(), kMaxGap_us)});
        pipeline.settle();
        hear();
        on_frame(static_cast<std::int64_t>(stamps.size()));
    }
    pipeline.finish();
    hear();
    if (told.frames.size() < script.size())
        throw std::runtime_error("it has frames for " + std::to_string(told.frames.size()) + " of " +
                                 std::to_string(script.size()) + " that are shown");
    if (options.with_graph)
        for (const graph::LoopClosure& closure : pipeline.graph()->graph().loop_closures())
            told.closures.push_back({closure.from_id, closure.to_id, closure.from_from_to});
    return told;
}

}  // namespace planemap::bench_odometry
