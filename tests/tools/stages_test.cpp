// SPDX-License-Identifier: BSD-3-Clause
#include "run/stages.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

using Json = nlohmann::ordered_json;

TEST(Stages, TellsTheClockAndTheProcessorApart) {
    Histogram ms, cpu_ms;
    for (int i = 0; i < 10; ++i) {
        ms.add(20);
        cpu_ms.add(5);
    }
    const Json stage = stage_figures(ms, cpu_ms, "decode");
    EXPECT_NEAR(stage["median"].get<double>(), 20, 0.5);
    EXPECT_NEAR(stage["cpu_median"].get<double>(), 5, 0.1);
    EXPECT_NEAR(stage["total_s"].get<double>(), 0.2, 1e-9);
    EXPECT_NEAR(stage["cpu_total_s"].get<double>(), 0.05, 1e-9);
    EXPECT_EQ(stage["count"], 10);
    EXPECT_EQ(stage["part_of"], "decode");
    EXPECT_FALSE(stage_figures(ms, cpu_ms).contains("part_of"));
}

TEST(Stages, WhatIsDoneOnceCountsOnce) {
    const StageTimer timer;
    const Json first = timer.figures();
    EXPECT_EQ(first["count"], 1);
    EXPECT_LE(first["total_s"].get<double>(), timer.figures()["total_s"].get<double>());
}

TEST(Stages, AReportOfBeforeHasNoCpuTimes) {
    Json report{{"wall_s", 2}, {"cpu_s", 1}, {"peak_rss_mb", 80}};
    report["stages_ms"]["map"] = {{"median", 1}, {"p95", 2}, {"count", 3}};
    report["stages_ms"]["registration"] = stage_figures({}, {}, "decode");
    const std::string text = stages_markdown(report);
    EXPECT_NE(text.find("| map | 1.00 | 2.00 | - | - | 3 | - |"), std::string::npos) << text;
    EXPECT_NE(text.find("| registration (in decode) | - | - | - | - | 0 | - |"), std::string::npos) << text;
}

}  // namespace
}  // namespace planemap
