// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/run.hpp"

#include <nlohmann/json.hpp>

namespace nlohmann {

template <>
struct adl_serializer<planemap::Pose> {
    static void to_json(json& out, const planemap::Pose& pose) {
        out = std::vector<double>(pose.data(), pose.data() + 16);
    }
    static void from_json(const json& in, planemap::Pose& pose) {
        pose.matrix() = Eigen::Map<const Eigen::Matrix4d>(in.get<std::vector<double>>().data());
    }
};

template <>
struct adl_serializer<planemap::Matrix6d> {
    static void to_json(json& out, const planemap::Matrix6d& matrix) {
        out = std::vector<double>(matrix.data(), matrix.data() + matrix.size());
    }
    static void from_json(const json& in, planemap::Matrix6d& matrix) {
        matrix = Eigen::Map<const planemap::Matrix6d>(in.get<std::vector<double>>().data());
    }
};

template <>
struct adl_serializer<planemap::StampedPose> {
    static void to_json(json& out, const planemap::StampedPose& pose) {
        out = {pose.utime, json(pose.world_from_camera)};
    }
    static void from_json(const json& in, planemap::StampedPose& pose) {
        in.at(0).get_to(pose.utime);
        in.at(1).get_to(pose.world_from_camera);
    }
};

}  // namespace nlohmann

namespace planemap::evaluation {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Closure, from_utime, to_utime, from_from_to)

}  // namespace planemap::evaluation

namespace planemap::bench_odometry {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(StageTime, median_ms, p95_ms, total_s, count)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Relative, keyframe_utime, utime, keyframe_from_camera, covariance)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(MethodRun, frames, trajectory, tracking, graph, segmentation, decoding,
                                   keyframes, closures, relatives)

StageTime stage_time(const Histogram& ms) {
    return {ms.median(), ms.p95(), ms.sum() / 1000, ms.count()};
}

nlohmann::json to_json(const MethodRun& run) {
    nlohmann::json json;
    to_json(json, run);
    return json;
}

MethodRun run_from_json(const nlohmann::json& json) {
    return json.get<MethodRun>();
}

}  // namespace planemap::bench_odometry
