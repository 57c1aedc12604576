// SPDX-License-Identifier: BSD-3-Clause
#include "run/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "evaluate/evaluation_report.hpp"
#include "pipeline/pipeline.hpp"
#include "run/input.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

void add_errors(const Trajectory& truth, const Trajectory& estimate, Json& report) {
    const Evaluation evaluation = evaluate(truth, estimate, {});
    if (!evaluation.ate) {
        report["accuracy_note"] = "not measured: " + std::to_string(evaluation.pairs) +
                                  " poses match the truth beside the input in time, at least 3 are needed";
        return;
    }
    report["accuracy"] = evaluation::accuracy_figures(evaluation);
    const double scale = evaluation.ate->scale;
    const bool is_known = std::isfinite(scale) && scale > 0;
    report["accuracy"]["ate_scaled_rmse_m"] =
        is_known ? Json(absolute_error(truth, estimate, associate(truth, estimate, {}), scale)->metres.rmse)
                 : Json(nullptr);
}

}  // namespace

bool is_part_of(const Trajectory& trajectory, const Trajectory& truth) {
    constexpr std::int64_t kRounding_us = 2;
    constexpr double kRounding_m = 1e-5, kRounding_rad = 1e-4;
    return !trajectory.empty() &&
           std::all_of(trajectory.begin(), trajectory.end(), [&](const StampedPose& pose) {
               auto same = std::lower_bound(truth.begin(), truth.end(), pose.utime - kRounding_us,
                                            [](const StampedPose& p, std::int64_t t) { return p.utime < t; });
               for (; same != truth.end() && same->utime <= pose.utime + kRounding_us; ++same) {
                   const Pose apart = same->world_from_camera.inverse() * pose.world_from_camera;
                   if (apart.translation().norm() < kRounding_m &&
                       std::abs(rotation_angle(apart)) < kRounding_rad)
                       return true;
               }
               return false;
           });
}

void add_accuracy(const Input& input, pipeline::Pipeline& pipeline, Json& report) {
    const pipeline::GivenPoses* given = pipeline.given_poses();
    std::optional<Trajectory> truth;
    try {
        truth = input.truth();
    } catch (const std::runtime_error& error) {
        report["accuracy_note"] = std::string("not measured: ") + error.what();
        return;
    }
    if (given != nullptr && truth && is_part_of(given->poses(), *truth)) {
        report["accuracy_note"] =
            "not measured: poses were given (--poses), and they are the truth beside the input itself";
        return;
    }
    if (given != nullptr) {
        report["accuracy_note"] = truth ? "of the poses that were given (--poses), not of what was tracked"
                                        : "not measured: poses were given (--poses)";
    }
    if (truth) add_errors(*truth, pipeline.trajectory(), report);
}

}  // namespace planemap
