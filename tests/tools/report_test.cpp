// SPDX-License-Identifier: BSD-3-Clause
#include "run/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
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
    EXPECT_NE(text.find("| OctoMap 5 cm, its working tree, in memory | 1.0 MB | 500 |"), std::string::npos)
        << text;
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

TEST(Report, SaysWhatIsComparedWithWhat) {
    Json report = sample();
    report["sizes_bytes"]["plane_map_zstd"] = 1500;
    report["sizes_bytes"]["plane_map_working"] = 800000;
    report["sizes_bytes"]["octomap_working"] = 4000000;
    report["sizes_bytes"]["octomap_bt_zstd"] = 9000;
    report["sizes_bytes"]["octomap_bt_memory"] = 600000;
    report["sizes_bytes"]["octomap_bt_occupied"] = 7000;
    report["sizes_bytes"]["octomap_bt_occupied_zstd"] = 4500;
    report["octomap"]["resolution_m"] = 0.035;
    const std::string text = report_markdown(report);
    for (const char* line :
         {"| plane map, the message, zstd | 1.5 kB | 0.75 |",
          "| plane map, to go on mapping: with keyframes' regions and rasters, in memory | 800.0 kB | 400 |",
          "| OctoMap 3.5 cm, .bt file, zstd | 9.0 kB | 4.50 |",
          "| OctoMap 3.5 cm, .bt file of the occupied space alone | 7.0 kB | 3.50 |",
          "| OctoMap 3.5 cm, .bt file of the occupied space alone, zstd | 4.5 kB | 2.25 |",
          "| OctoMap 3.5 cm, .bt file loaded, in memory | 600.0 kB | 300 |",
          "| OctoMap 3.5 cm, to go on mapping: tree and keyframes' depth, in memory | 4.0 MB | 2000 |",
          "9.50 times as a file, 6.00 times as a file compressed by zstd, 3.00 times as such a file of the "
          "occupied space alone.",
          "In memory OctoMap's rows here are its own count", "with depth or without"})
        EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
    EXPECT_EQ(text.find("OctoMap 4 cm"), std::string::npos);
    // No size of an OctoMap without its resolution.
    for (auto at = text.find("| OctoMap "); at != std::string::npos; at = text.find("| OctoMap ", at + 1))
        EXPECT_EQ(text.compare(at, 16, "| OctoMap 3.5 cm"), 0) << text.substr(at, 60);
}

TEST(Report, WithoutAnOctoMapItIsSaid) {
    Json report = sample();
    report["octomap"] = {{"resolution_m", nullptr}, {"nodes", nullptr}};
    report["coverage"] = {{"leaves_explained", nullptr}, {"area_supported", nullptr}};
    for (const char* key :
         {"octomap_memory", "octomap_bt", "octomap_ot", "octomap_occupied_leaves", "voxel_cloud_1cm"})
        report["sizes_bytes"][key] = nullptr;
    const std::string text = report_markdown(report);
    EXPECT_NE(text.find("There is no OctoMap of this run"), std::string::npos) << text;
    EXPECT_EQ(text.find("explain **not measured**"), std::string::npos) << text;
    EXPECT_EQ(text.find("| OctoMap"), std::string::npos) << text;
}

TEST(Report, AccuracyWithItsNotesAndWarnings) {
    Json report = sample();
    report["accuracy"] = {{"ate_rmse_m", 0.0123},
                          {"rpe_frame_rmse_m", nullptr},
                          {"rpe_frame_rmse_deg", nullptr},
                          {"rpe_frame_why", "not measured: the truth has poses 1 s apart"}};
    report["accuracy_note"] = "of the poses that were given";
    report["warnings"] = {"frames are far apart"};
    report["version"] = "1.2.3";
    report["date"] = "2026-01-01T00:00:00Z";
    report["seed"] = 7;
    const std::string text = report_markdown(report);
    for (const char* line : {"ATE 0.0123 m, RPE per frame not measured: the truth has poses 1 s apart.",
                             "Accuracy: of the poses that were given.", "**Warning:** frames are far apart.",
                             "planemap 1.2.3, 2026-01-01T00:00:00Z, seed 7;"})
        EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
}

TEST(Report, WhatWasWrongWithTheInputIsListed) {
    EXPECT_EQ(report_markdown(sample()).find("What was wrong"), std::string::npos)
        << "an older report has no list";
    Json report = sample();
    report["complaints"] = {"a.lcmlog is cut short", "colour left out (12 times)"};
    const std::string text = report_markdown(report);
    EXPECT_NE(text.find("- a.lcmlog is cut short\n- colour left out (12 times)\n"), std::string::npos)
        << text;
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

std::string error_of(const std::function<void()>& body) {
    try {
        body();
    } catch (const std::exception& error) {
        return error.what();
    }
    return {};
}

TEST(Report, SomethingElseIsAnErrorThatNamesTheField) {
    const auto error = [](const Json& report) { return error_of([&] { report_markdown(report); }); };
    EXPECT_EQ(error(Json::object()), "is no report of planemap-run: input is missing");
    EXPECT_EQ(error(Json::parse("[1]")), "is no report of planemap-run: is array, not object");
    Json report = sample();
    report["sizes_bytes"]["plane_map_message"] = "large";
    EXPECT_EQ(error(report),
              "is no report of planemap-run: sizes_bytes/plane_map_message is string, not number");
    report = sample();
    report["stages_ms"]["decode"].erase("count");
    EXPECT_NE(error(report).find("is no report of planemap-run: "), std::string::npos);
    EXPECT_NE(error(report).find("count"), std::string::npos);
}

TEST(Report, AFolderWithoutOneSaysWhyAndABrokenOneWhere) {
    const test::TemporaryFolder folder;
    const auto error = [&] { return error_of([&] { read_report(folder.path()); }); };
    EXPECT_THAT(error(), AllOf(HasSubstr("report.json: "), HasSubstr("no output folder of a planemap-run")));
    std::filesystem::create_directories(folder / ".partial");
    EXPECT_THAT(error(), AllOf(HasSubstr("goes on or did not end"), HasSubstr((folder / ".partial").string()),
                               HasSubstr("the next planemap-run into this folder keeps")));
    std::filesystem::create_directories(folder / ".partial-whole");
    EXPECT_THAT(error(), AllOf(HasSubstr("they are whole"), HasSubstr((folder / ".partial-whole").string())));
    write_file(folder / "report.json", "{\n\"input\": }");
    EXPECT_THAT(error(),
                AllOf(HasSubstr("report.json: line 2, column 10: "), Not(HasSubstr("json.exception"))));
    write_file(folder / "report.json", sample().dump());
    EXPECT_EQ(read_report(folder.path()).begin().key(), "input") << "in its own order";
    EXPECT_THAT(error_of([&] { read_report(folder / "none"); }), HasSubstr("no such folder"));
}

}  // namespace
}  // namespace planemap
