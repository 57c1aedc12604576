// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/run.hpp"

#include <nlohmann/json.hpp>

namespace planemap::bench_odometry {

namespace {

using Json = nlohmann::json;

Json pose_to_json(const Pose& pose) {
    Json json = Json::array();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) json.push_back(pose.matrix()(row, column));
    return json;
}

Pose pose_from_json(const Json& json) {
    Pose pose = Pose::Identity();
    for (std::size_t i = 0; i < 12; ++i)
        pose.matrix()(static_cast<int>(i / 4), static_cast<int>(i % 4)) = json.at(i).get<double>();
    return pose;
}

Json stage_to_json(const StageTime& stage) {
    return {stage.median_ms, stage.p95_ms, stage.total_s, stage.count};
}

StageTime stage_from_json(const Json& json) {
    return {json.at(0), json.at(1), json.at(2), json.at(3)};
}

}  // namespace

StageTime stage_time(const Histogram& ms) {
    return {ms.median(), ms.p95(), ms.sum() / 1000, ms.count()};
}

Json to_json(const MethodRun& run) {
    Json trajectory = Json::array(), closures = Json::array();
    for (const StampedPose& pose : run.trajectory)
        trajectory.push_back({pose.utime, pose_to_json(pose.world_from_camera)});
    for (const Closure& c : run.closures)
        closures.push_back({c.from_utime, c.to_utime, pose_to_json(c.from_from_to)});
    return {{"frames", run.frames},
            {"trajectory", trajectory},
            {"tracking", stage_to_json(run.tracking)},
            {"graph", stage_to_json(run.graph)},
            {"segmentation", stage_to_json(run.segmentation)},
            {"decoding", stage_to_json(run.decoding)},
            {"keyframes", run.keyframes},
            {"closures", closures}};
}

MethodRun run_from_json(const Json& json) {
    MethodRun run;
    run.frames = json.at("frames");
    for (const Json& pose : json.at("trajectory"))
        run.trajectory.push_back({pose.at(0).get<std::int64_t>(), pose_from_json(pose.at(1))});
    run.tracking = stage_from_json(json.at("tracking"));
    run.graph = stage_from_json(json.at("graph"));
    run.segmentation = stage_from_json(json.at("segmentation"));
    run.decoding = stage_from_json(json.at("decoding"));
    run.keyframes = json.at("keyframes");
    for (const Json& c : json.at("closures"))
        run.closures.push_back(
            {c.at(0).get<std::int64_t>(), c.at(1).get<std::int64_t>(), pose_from_json(c.at(2))});
    return run;
}

}  // namespace planemap::bench_odometry
