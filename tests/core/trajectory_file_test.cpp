// SPDX-License-Identifier: BSD-3-Clause
#include "core/trajectory_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "core/files.hpp"
#include "core/random_values.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TrajectoryFile read_text(const test::TemporaryFolder& folder, const std::string& text) {
    write_file(folder / "t.txt", text);
    return read_trajectory_file(folder / "t.txt");
}

std::string error_of(const test::TemporaryFolder& folder, const std::string& text) {
    return test::error_of([&] { read_text(folder, text); });
}

constexpr std::int64_t kStart = 1500000000033333;

Trajectory some_poses() {
    test::Random random(3);
    Trajectory trajectory;
    for (int i = 0; i < 20; ++i) trajectory.push_back({kStart + 33333 * i, random.pose()});
    return trajectory;
}

/// A line with numbers of enough digits.
std::string line_of(const std::string& first, const std::vector<double>& values, char separator) {
    std::string line = first;
    for (const double value : values) {
        char text[40];
        std::snprintf(text, sizeof text, "%.12g", value);
        if (!line.empty()) line += separator;
        line += text;
    }
    return line + "\n";
}

/// The poses in TUM's order (x y z w), or w first.
std::string stamped(const Trajectory& poses, const std::string& zeros_or_point, char separator,
                    bool w_first) {
    std::string text;
    for (const StampedPose& pose : poses) {
        const Eigen::Vector3d t = pose.world_from_camera.translation();
        const Eigen::Quaterniond q(pose.world_from_camera.linear());
        std::string stamp = std::to_string(pose.utime);
        if (zeros_or_point == ".")
            stamp.insert(stamp.size() - 6, ".");
        else if (zeros_or_point == "ms")
            stamp.insert(stamp.size() - 3, ".");
        else
            stamp += zeros_or_point;
        text += w_first ? line_of(stamp, {t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()}, separator)
                        : line_of(stamp, {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}, separator);
    }
    return text;
}

void expect_same(const Trajectory& read, const Trajectory& written, bool stamps = true) {
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
        EXPECT_EQ(read[i].utime, stamps ? written[i].utime : static_cast<std::int64_t>(i) * 1000000);
        EXPECT_TRUE(read[i].world_from_camera.isApprox(written[i].world_from_camera, 1e-9)) << i;
    }
}

TEST(TrajectoryFile, TimestampsOfEveryUnitAreExact) {
    const test::TemporaryFolder folder;
    for (const char* unit : {".", "ms", "", "000"}) {
        const TrajectoryFile file = read_text(folder, stamped(some_poses(), unit, ' ', false));
        EXPECT_EQ(file.format, TrajectoryFormat::kTum) << unit;
        expect_same(file.poses, some_poses());
    }
}

TEST(TrajectoryFile, EurocByItsHeader) {
    const test::TemporaryFolder folder;
    const std::string lines = stamped(some_poses(), "000", ',', true);
    for (const char* header :
         {"#timestamp [ns],p_x,p_y,p_z,q_w,q_x,q_y,q_z\n",
          "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z "
          "[]\r\n",
          "timestamp,x,y,z,qw,qx,qy,qz\n", "\xef\xbb\xbf# Timestamp,tx,ty,tz,Qw,Qx,Qy,Qz\n"}) {
        const TrajectoryFile file = read_text(folder, header + lines);
        EXPECT_EQ(file.format, TrajectoryFormat::kEuroc) << header;
        expect_same(file.poses, some_poses());
    }
    EXPECT_THAT(error_of(folder, lines), AllOf(HasSubstr("t.txt:1:"), HasSubstr("header")))
        << "without it nothing says where w stands";
}

TEST(TrajectoryFile, EurocsStateHas17Columns) {
    const test::TemporaryFolder folder;
    std::string lines;
    std::istringstream in(stamped(some_poses(), "000", ',', true));
    for (std::string line; std::getline(in, line);) lines += line + ",1,2,3,4,5,6,7,8,9\n";
    expect_same(read_text(folder, lines).poses, some_poses());
    const std::string header =
        "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
        "v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad "
        "s^-1], "
        "b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], b_a_RS_S_z [m s^-2]\n";
    expect_same(read_text(folder, header + lines).poses, some_poses());
}

TEST(TrajectoryFile, AHeaderSaysTheOrderWhereverItStands) {
    const test::TemporaryFolder folder;
    const Trajectory poses = some_poses();
    expect_same(
        read_text(folder, "# timestamp tx ty tz qw qx qy qz\n" + stamped(poses, ".", ' ', true)).poses,
        poses);
    expect_same(
        read_text(folder, "# timestamp tx ty tz qx qy qz qw\n" + stamped(poses, ".", ' ', false)).poses,
        poses);
    expect_same(
        read_text(folder, "timestamp [us],tx,ty,tz,qx,qy,qz,qw\n" + stamped(poses, "", ',', false)).poses,
        poses);
    // A unit in brackets counts, however small the numbers are.
    const std::string since_start =
        "#timestamp [ns],p_x,p_y,p_z,q_w,q_x,q_y,q_z\n0,1,2,3,1,0,0,0\n33333000,1,2,3,1,0,0,0\n";
    EXPECT_EQ(read_text(folder, since_start).poses.at(1).utime, 33333);
    // A remark is no header.
    expect_same(
        read_text(folder, "# time and poses of a walk on a sunny day\n" + stamped(poses, ".", ' ', false))
            .poses,
        poses);
}

TEST(TrajectoryFile, KittiHasNoTimestamps) {
    const test::TemporaryFolder folder;
    std::string text;
    for (const StampedPose& pose : some_poses()) {
        const Eigen::Matrix<double, 3, 4, Eigen::RowMajor> m = pose.world_from_camera.matrix().topRows<3>();
        text += line_of("", {m.data(), m.data() + 12}, ' ');
    }
    const TrajectoryFile file = read_text(folder, text);
    EXPECT_EQ(file.format, TrajectoryFormat::kKitti);
    expect_same(file.poses, some_poses(), false);
    try {
        read_trajectory(folder / "t.txt");
        FAIL() << "read as a trajectory with timestamps";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("t.txt"), HasSubstr("KITTI"), HasSubstr("no timestamps")));
    }
    EXPECT_THAT(error_of(folder, "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 2 0 0 0 0 1 0\n"),
                AllOf(HasSubstr("t.txt:2:"), HasSubstr("no rotation")));
    EXPECT_THAT(error_of(folder, "1 0 0 0 0 1 0 0 0 0 -1 0\n"), HasSubstr("no rotation")) << "a mirror";
}

TEST(TrajectoryFile, OtherFormsAreRefusedByNameAndLine) {
    const test::TemporaryFolder folder;
    const auto zeros = [](int count) {
        std::string line = "1";
        for (int i = 1; i < count; ++i) line += " 0";
        return "\n# a remark\n" + line + "\n";
    };
    for (const auto& [count, name] : {std::pair(3, "Redwood"),
                                      {4, "4 x 4 matrix"},
                                      {7, "without timestamps"},
                                      {13, "KITTI-360"},
                                      {16, "4 x 4 matrices"},
                                      {9, "9 numbers a line"}})
        EXPECT_THAT(error_of(folder, zeros(count)), AllOf(HasSubstr("t.txt:3:"), HasSubstr(name)));
    EXPECT_THAT(error_of(folder, "{\"poses\": []}"), AllOf(HasSubstr("t.txt:1:"), HasSubstr("JSON")));
}

TEST(TrajectoryFile, LinesOfDifferentFormsAreRefused) {
    const test::TemporaryFolder folder;
    const std::string tum = "1 0 0 0 0 0 0 1\n", kitti = "1 0 0 0 0 1 0 0 0 0 1 0\n";
    EXPECT_THAT(error_of(folder, tum + kitti), HasSubstr("t.txt:2: 12 numbers"));
    EXPECT_THAT(error_of(folder, kitti + tum), HasSubstr("t.txt:2: 8 numbers"));
    EXPECT_THAT(error_of(folder, "# timestamp tx ty tz qx qy qz qw\n" + kitti),
                HasSubstr("t.txt:2: 12 numbers"));
    EXPECT_THAT(error_of(folder, tum + "1500000000033333499 0 0 0 0 0 0 1\n"),
                AllOf(HasSubstr("t.txt:2:"), HasSubstr("nanoseconds")));
}

TEST(TrajectoryFile, AbsurdPositionsAreRefusedByLineAndField) {
    const test::TemporaryFolder folder;
    const std::string good = "1 0 0 0 0 0 0 1\n";
    EXPECT_THAT(error_of(folder, good + "2 0 1e308 0 0 0 0 1\n"),
                HasSubstr("t.txt:2: ty is 1e+308 m, must be -1e+08 to 1e+08 m"));
    EXPECT_THAT(error_of(folder, good + "2 -1.1e8 0 0 0 0 0 1\n"), HasSubstr("t.txt:2: tx is -1.1e+08 m"));
    EXPECT_THAT(error_of(folder, "1 0 0 0 0 1 0 0 0 0 1 1e9\n"), HasSubstr("t.txt:1: tz is 1e+09 m"));
    EXPECT_THAT(error_of(folder, "0 0 0 1e400 0 0 0 1\n"), HasSubstr("not finite"));
    EXPECT_EQ(read_text(folder, "1 691607.3 5335932.1 520 0 0 0 1\n").poses.size(), 1u) << "UTM";
}

TEST(TrajectoryFile, QuaternionsThatAreNoRotationAreRefused) {
    const test::TemporaryFolder folder;
    for (const char* q : {"0 0 0 3", "0 0 0 0", "0 0 0 1.02", "0 0.5 0.5 0.5"}) {
        EXPECT_THAT(
            error_of(folder, "1 0 0 0 0 0 0 1\n2 0 0 0 " + std::string(q) + "\n"),
            AllOf(HasSubstr("t.txt:2: the quaternion is not of unit length"), HasSubstr("0.99 to 1.01")));
    }
    EXPECT_EQ(error_of(folder, "1 0 0 0 0 0 0.71 0.71\n"), "") << "two digits";
}

TEST(TrajectoryFile, PosesOfOneStampAreCountedInOneLine) {
    const test::TemporaryFolder folder;
    const std::string first = "1 0 0 0 0 0 0 1\n", moved = "1 2 0 0 0 0 0 1\n", later = "2 0 0 0 0 0 0 1\n";
    EXPECT_TRUE(read_text(folder, first + later).notes.empty());
    EXPECT_THAT(read_text(folder, first + first + later).notes,
                testing::ElementsAre(testing::EndsWith("t.txt: 1 pose stands there twice")));
    const TrajectoryFile both = read_text(folder, later + first + first + first + moved);
    EXPECT_THAT(both.notes,
                testing::ElementsAre(testing::EndsWith(
                    "t.txt: 2 poses stand there twice, 1 pose says something else than another of the same "
                    "stamp, of which the last is taken")));
    std::vector<std::string> notes;
    EXPECT_EQ(read_trajectory(folder / "t.txt", &notes).size(), both.poses.size());
    EXPECT_EQ(notes, both.notes);
}

TEST(TrajectoryFile, WhatATrajectoryCovers) {
    EXPECT_EQ(span_text({}), "nothing");
    EXPECT_EQ(span_text(some_poses()), "1500000000.033 to 1500000000.667 s");
    EXPECT_NO_THROW(require_poses("t.txt", some_poses()));
    EXPECT_THROW(require_poses("t.txt", {}), std::runtime_error);
}

}  // namespace
}  // namespace planemap
