// SPDX-License-Identifier: BSD-3-Clause
// planemap-convert as a user runs it: round trips that lose nothing, and refusals in one line.
#include <gmock/gmock.h>

#include "core/trajectory.hpp"
#include "data_folder.hpp"
#include "messages/log.hpp"
#include "tools/programs.hpp"

namespace planemap {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct ConvertTest : test::Programs {
    void convert(const std::string& from, const std::string& to) {
        const Outcome outcome = run("planemap-convert", from + " --output " + to);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    }
    std::string trajectory_of(const std::string& input, const std::string& output) {
        const Outcome outcome = run("planemap-run", input + " --no-octomap -q --output " + path(output));
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        return outcome.exit_code == 0 ? read_file(path(output) + "/trajectory.txt") : "";
    }
    /// depth.txt and the bytes of all that it names.
    std::string depth_of(const std::string& folder) {
        std::string all = read_file(path(folder) + "/depth.txt");
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(path(folder) + "/depth"))
            files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        for (const auto& file : files) all += file.filename().string() + read_file(file);
        return all;
    }
};

/// What is written once comes back as it was: depth, stamps, truth, and what planemap-run makes of it.
TEST_F(ConvertTest, FolderToLogToFolderLosesNothing) {
    for (const char* registered : {"", "&registered=0"}) {
        const std::string world =
            std::string("'sim:office?frames=8&width=320&height=240&seed=3") + registered + "'";
        const std::string n = std::to_string(std::string(registered).size());
        convert(world, path("a" + n));
        convert(path("a" + n), path("b" + n) + ".lcmlog");
        convert(path("b" + n) + ".lcmlog", path("c" + n));
        EXPECT_EQ(depth_of("a" + n), depth_of("c" + n));
        for (const char* file : {"/rgb.txt", "/associations.txt"})
            EXPECT_EQ(read_file(path("a" + n) + file), read_file(path("c" + n) + file));
        const Trajectory before = read_trajectory(path("a" + n) + "/groundtruth.txt"),
                         after = read_trajectory(path("c" + n) + "/groundtruth.txt");
        ASSERT_EQ(before.size(), after.size());
        for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(before[i].utime, after[i].utime);
        const std::string of_folder = trajectory_of(path("a" + n), "out_a" + n);
        EXPECT_EQ(of_folder, trajectory_of(path("b" + n) + ".lcmlog", "out_b" + n));
        EXPECT_EQ(of_folder, trajectory_of(path("c" + n), "out_c" + n));
    }
}

TEST_F(ConvertTest, ARecordingOfTheBenchmark) {
    PLANEMAP_NEEDS_DATA("cases");
    const std::string folder = test::data_folder("cases/step_10").string();
    convert(folder, path("step.lcmlog"));
    convert(path("step.lcmlog"), path("step"));
    const std::string of_folder = trajectory_of(folder, "out_a");
    EXPECT_EQ(of_folder, trajectory_of(path("step.lcmlog"), "out_b"));
    EXPECT_EQ(of_folder, trajectory_of(path("step"), "out_c"));
}

TEST_F(ConvertTest, OtherLogsBecomePlainOnes) {
    PLANEMAP_NEEDS_DATA("cases");
    const std::string cases = test::data_folder("cases").string();
    convert(cases + "/kinect_frame.lcmlog --camera " + cases + "/camera.json", path("k.lcmlog"));
    EXPECT_THAT(run("planemap-run", path("k.lcmlog") + " -q --no-octomap -o " + path("k")).out,
                HasSubstr("2 frames: 2 tracked"));
}

TEST_F(ConvertTest, WhatIsNotReadIsRefusedByNameWithTheWayOut) {
    const std::string to = " --output " + path("x.lcmlog");
    for (const char* name : {"a.db3", "a.mcap"}) {
        write_file(path(name), "whatever");
        expect_error("planemap-convert", path(name) + to,
                     "is a ROS 2 bag, which is not read: `rosbags-convert");
    }
    std::filesystem::create_directories(path("bag2"));
    write_file(path("bag2/metadata.yaml"), "rosbag2_bagfile_information:\n");
    expect_error("planemap-convert", path("bag2") + to, "is a ROS 2 bag");
    write_file(path("a.mkv"), "whatever");
    expect_error("planemap-convert", path("a.mkv") + to, "azure_kinect_mkv_reader.py");
    write_file(path("a.bag"), "#ROSBAG V2.0\nand then nothing");
    expect_error("planemap-convert", path("a.bag") + to, "a.bag: ");
    expect_error("planemap-run", path("a.bag") + to, "planemap-convert");
    expect_error("planemap-convert", path("none") + to, "no such folder");
    expect_error("planemap-convert", "sim:office --depth-topic /a" + to,
                 "--depth-topic and --color-topic are for ROS bags");
    EXPECT_FALSE(std::filesystem::exists(path("x.lcmlog")));
}

TEST_F(ConvertTest, NothingIsWrittenOver) {
    write_file(path("x.lcmlog"), "mine");
    std::filesystem::create_directories(path("folder"));
    write_file(path("folder/file"), "mine");
    const std::string world = "'sim:office?frames=2&width=64&height=48' --output ";
    expect_error("planemap-convert", world + path("x.lcmlog"), "x.lcmlog: is there already");
    expect_error("planemap-convert", world + path("folder"), "folder: is there already");
    EXPECT_EQ(read_file(path("x.lcmlog")), "mine");
    for (const auto& entry : std::filesystem::directory_iterator(folder_))
        EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr(".part")));
}

}  // namespace
}  // namespace planemap
