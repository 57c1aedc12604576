// SPDX-License-Identifier: BSD-3-Clause
#include "run/report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace planemap {
namespace {

using Json = nlohmann::ordered_json;

Json sample() {
    return Json::parse(R"({
        "input": "kitchen", "frames": 10, "tracked": 9, "lost": 1, "broken": 0, "keyframes": 3, "loop_closures": 1, "planes": 4,
        "wall_s": 1.5, "cpu_s": 1.4, "peak_rss_mb": 80,
        "stages_ms": {"decode": {"median": 1, "p95": 2, "count": 10}, "octomap": {"median": 0, "p95": 0, "count": 0}},
        "sizes_bytes": {"plane_map_message": 2000, "plane_map_memory": 5000, "octomap_memory": 1000000, "octomap_bt": 19000,
                        "octomap_ot": 200000, "octomap_occupied_leaves": 60000, "raw_cloud": 36864000, "voxel_cloud_1cm": 120000},
        "octomap": {"resolution_m": 0.05, "nodes": 1000},
        "coverage": {"leaves_explained": 0.75, "area_supported": 0.9}})");
}

TEST(Report, PrintsRatiosWithTheirCoverage) {
    const std::string text = report_markdown(sample());
    EXPECT_NE(text.find("| OctoMap 5 cm, in memory | 1.0 MB | 500 |"), std::string::npos) << text;
    EXPECT_NE(text.find("| OctoMap 5 cm, .bt file | 19.0 kB | 9.50 |"), std::string::npos) << text;
    EXPECT_NE(text.find("**75.0 %**"), std::string::npos) << text;
    EXPECT_NE(text.find("**90.0 %**"), std::string::npos) << text;
    EXPECT_LT(text.find("75.0 %"), text.find("| 500 |")) << "the coverage stands before the savings";
}

TEST(Report, WhatWasNotMeasuredIsSaid) {
    Json report = sample();
    report["coverage"]["leaves_explained"] = nullptr;
    report["sizes_bytes"]["octomap_bt"] = nullptr;
    const std::string text = report_markdown(report);
    EXPECT_NE(text.find("**not measured**"), std::string::npos) << text;
    EXPECT_NE(text.find(".bt file | not measured"), std::string::npos) << text;
}

TEST(Report, AnEmptyMapHasNoRatio) {
    Json report = sample();
    report["sizes_bytes"]["plane_map_message"] = 0;
    EXPECT_EQ(report_markdown(report).find("inf"), std::string::npos);
}

TEST(Report, WhatWasNotUsedIsSaidOnceAReason) {
    Json report = sample();
    EXPECT_EQ(report_markdown(report).find("Not used"), std::string::npos) << "from before losses were told";
    report["losses"] = Json::object();
    EXPECT_EQ(report_markdown(report).find("Not used"), std::string::npos);
    report["losses"] = {
        {"segmentation", {{"frames whose stamp went back", 39}}},
        {"odometry", {{"frames whose stamp went back", 39}, {"messages that were corrupt", 2}}}};
    const std::string text = report_markdown(report);
    EXPECT_NE(text.find("- 39 frames whose stamp went back (segmentation, odometry)\n"), std::string::npos)
        << text;
    EXPECT_NE(text.find("- 2 messages that were corrupt (odometry)\n"), std::string::npos) << text;
}

TEST(Report, SomethingElseIsAnError) {
    EXPECT_THROW(report_markdown(Json::parse("{}")), std::runtime_error);
    EXPECT_THROW(report_markdown(Json::parse("[1]")), std::runtime_error);
}

}  // namespace
}  // namespace planemap
