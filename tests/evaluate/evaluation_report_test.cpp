// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/evaluation_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluate/walks.hpp"

namespace planemap::evaluation {
namespace {

using results::Json;
using test::circle;
using testing::ElementsAre;

std::vector<std::string> keys_of(const Json& json) {
    std::vector<std::string> keys;
    for (const auto& [key, unused] : json.items()) keys.push_back(key);
    return keys;
}

/// A circle that is estimated too large: every figure is above 0.
Trajectory too_large(Trajectory path) {
    for (StampedPose& pose : path) pose.world_from_camera.translation() *= 1.02;
    return path;
}

TEST(EvaluationReport, TheThreeFormsSayTheSameUnderTheirOwnKeys) {
    const Trajectory truth = circle(1);
    const Evaluation evaluation = evaluate(truth, too_large(truth), {});
    const Json all = all_figures(evaluation), run = accuracy_figures(evaluation),
               row = row_figures(evaluation);
    EXPECT_THAT(keys_of(all), ElementsAre("truth_poses", "estimate_poses", "pairs", "matched_share",
                                          "path_length_m", "scale", "ate", "rpe_frame", "rpe_1s"));
    EXPECT_THAT(keys_of(run), ElementsAre("ate_rmse_m", "rpe_frame_rmse_m", "rpe_frame_rmse_deg", "scale",
                                          "pairs", "path_length_m", "extent_m"));
    EXPECT_THAT(keys_of(row), ElementsAre("path_m", "ate_m", "rpe_frame_m", "rpe_frame_deg", "rpe_1s_m",
                                          "rpe_1s_deg", "scale"));
    EXPECT_GT(row["ate_m"], 0.01);
    EXPECT_EQ(all["ate"]["rmse"], row["ate_m"]);
    EXPECT_EQ(run["ate_rmse_m"], row["ate_m"]);
    EXPECT_EQ(all["rpe_frame"]["trans"]["rmse"], row["rpe_frame_m"]);
    EXPECT_EQ(run["rpe_frame_rmse_m"], row["rpe_frame_m"]);
    EXPECT_EQ(all["rpe_1s"]["rot_deg"]["rmse"], row["rpe_1s_deg"]);
    EXPECT_EQ(all["path_length_m"], row["path_m"]);
}

TEST(EvaluationReport, WhatWasNotMeasuredIsNullAndSaysWhy) {
    Trajectory truth = circle(1);
    truth.resize(10);  // a third of a second
    const Evaluation evaluation = evaluate(truth, truth, {});
    const Json all = all_figures(evaluation), row = row_figures(evaluation);
    EXPECT_TRUE(all["rpe_1s"].is_null());
    EXPECT_NE(all["rpe_1s_why"], "");
    EXPECT_TRUE(row["rpe_1s_m"].is_null());
    EXPECT_FALSE(row["ate_m"].is_null());
    EXPECT_TRUE(relative_figures(std::nullopt).is_null());
    const Json none = row_figures(std::nullopt);
    for (const auto& [key, value] : none.items()) EXPECT_TRUE(value.is_null()) << key;
}

}  // namespace
}  // namespace planemap::evaluation
