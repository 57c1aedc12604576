// SPDX-License-Identifier: BSD-3-Clause
#include "run/size_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "exports/corner.hpp"
#include "run/report_text.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

TEST(SizeReport, AMapAloneTellsItsOwnSizesAndNoOthers) {
    Json report;
    add_map_sizes(scene::corner(), report);
    const Json& sizes = report.at("sizes_bytes");
    for (const char* key : {"plane_map_memory", "plane_map_message", "plane_map_zstd"})
        EXPECT_GT(sizes.at(key), 0) << key;
    for (const char* key :
         {"octomap_memory", "octomap_bt", "octomap_ot", "octomap_occupied_leaves", "raw_cloud",
          "voxel_cloud_1cm", "plane_map_working", "octomap_bt_zstd", "octomap_working"})
        EXPECT_TRUE(sizes.at(key).is_null()) << key;
    EXPECT_TRUE(report.at("octomap").at("resolution_m").is_null());
    for (const auto& [key, value] : report.at("coverage").items()) EXPECT_TRUE(value.is_null()) << key;
    const std::string text = sizes_markdown(report);
    EXPECT_THAT(text, HasSubstr("There is no OctoMap of this run"));
    EXPECT_THAT(text, Not(HasSubstr("| OctoMap")));
}

TEST(SizeReport, AnOctomapThatCannotBeReadLeavesTheReportAsItWas) {
    const test::TemporaryFolder folder;
    Json report;
    add_map_sizes(scene::corner(), report);
    const Json before = report;
    const auto file = folder.write("octomap.bt", "no tree");
    EXPECT_THAT(test::error_of([&] { add_stored_octomap(file, scene::corner(), report); }),
                HasSubstr(file.string()));
    EXPECT_EQ(report, before);
}

TEST(BytesText, HasThreeDigitsOrFewerAndAUnit) {
    EXPECT_EQ(bytes_text(812), "812 B");
    EXPECT_EQ(bytes_text(2150), "2.1 kB");
    EXPECT_EQ(bytes_text(2156, 2), "2.16 kB");
    EXPECT_EQ(bytes_text(1.25e6, 0), "1 MB");
    EXPECT_EQ(bytes_text(3.456e9), "3.46 GB");
}

}  // namespace
}  // namespace planemap
