// SPDX-License-Identifier: BSD-3-Clause
#include "convert/conversion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/trajectory_file.hpp"
#include "temporary_folder.hpp"

namespace planemap::convert {
namespace {

using test::error_of;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kSmall = "sim:office?frames=3&width=64&height=48";

TEST(ConvertOptions, EveryBadFieldIsNamed) {
    EXPECT_EQ(error_of([] { ConvertOptions().validate(); }), "");
    ConvertOptions options;
    options.max_color_gap_s = NAN;
    options.rate_hz = 0;
    options.depth_units_per_metre = 1;
    EXPECT_THAT(error_of([&] { options.validate(); }),
                AllOf(HasSubstr("color-gap"), HasSubstr("rate"), HasSubstr("depth-units")));
}

TEST(OpenInput, WhatIsNotReadIsKnownByItsNameOrItsFirstBytes) {
    const TemporaryFolder folder;
    folder.write("ros2/metadata.yaml", "");
    for (const auto& file : {folder.write("a.db3", ""), folder.write("b", "\x89MCAP0"), folder / "ros2"})
        EXPECT_THAT(error_of([&] { open_input(file, {}); }),
                    AllOf(HasSubstr(file.string()), HasSubstr("ROS 2")));
    EXPECT_THAT(error_of([&] { open_input(folder.write("c.mkv", ""), {}); }), HasSubstr("Matroska"));
    EXPECT_THAT(error_of([&] { open_input(folder.write("d.bag", "#ROSBAG V1.2\n"), {}); }),
                HasSubstr("rosbag fix"));
}

TEST(OpenInput, TopicsAreForBags) {
    ConvertOptions options;
    options.depth_topic = "/depth";
    EXPECT_THAT(error_of([&] { open_input(kSmall, options); }), HasSubstr("has no topics"));
    EXPECT_EQ(open_input(kSmall, {})->size(), 3u);
}

TEST(TruthOf, IsTheSimulatorsOrStandsBesideTheInput) {
    const auto simulated = open_input(kSmall, {});
    const Trajectory truth = truth_of(kSmall, *simulated);
    EXPECT_EQ(truth.size(), 3u);

    const TemporaryFolder folder;
    ConvertOptions options;
    options.quiet = true;
    convert(kSmall, folder / "recorded", options);
    const auto recorded = open_input(folder / "recorded", {});
    EXPECT_EQ(truth_of(folder / "recorded", *recorded).size(), 3u);
    folder.write("recorded/groundtruth.txt", "no trajectory\n");
    EXPECT_TRUE(truth_of(folder / "recorded", *recorded).empty()) << "it is said, and does not come over";
    std::filesystem::remove(folder / "recorded" / "groundtruth.txt");
    EXPECT_TRUE(truth_of(folder / "recorded", *recorded).empty());
}

}  // namespace
}  // namespace planemap::convert
