// SPDX-License-Identifier: BSD-3-Clause
#include "core/trajectory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/files.hpp"
#include "core/random_values.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;

Trajectory read_text(const test::TemporaryFolder& folder, const std::string& text) {
    write_file(folder / "t.txt", text);
    return read_trajectory(folder / "t.txt");
}

std::string error_of(const test::TemporaryFolder& folder, const std::string& text) {
    return test::error_of([&] { read_text(folder, text); });
}

TEST(Trajectory, WrittenAndReadBack) {
    const test::TemporaryFolder folder;
    test::Random random(1);
    Trajectory trajectory;
    for (int i = 0; i < 100; ++i) trajectory.push_back({1311868164363181 + i * 33333, random.pose()});
    write_trajectory(folder / "a.txt", trajectory);
    const Trajectory back = read_trajectory(folder / "a.txt");
    ASSERT_EQ(back.size(), trajectory.size());
    for (std::size_t i = 0; i < back.size(); ++i) {
        EXPECT_EQ(back[i].utime, trajectory[i].utime);
        EXPECT_TRUE(back[i].world_from_camera.isApprox(trajectory[i].world_from_camera, 1e-6));
        EXPECT_TRUE(is_valid(back[i].world_from_camera));
    }
    write_trajectory(folder / "b.txt", trajectory);
    EXPECT_EQ(read_file(folder / "a.txt"), read_file(folder / "b.txt"));
}

TEST(Trajectory, ExtremeValuesSurvive) {
    const test::TemporaryFolder folder;
    Trajectory trajectory(3);
    trajectory[0].utime = -1500000;
    trajectory[1].utime = -5;
    trajectory[2].utime = 7;
    trajectory[1].world_from_camera.translation() = Eigen::Vector3d(1e8, -1e8, 1e-7);
    write_trajectory(folder / "t.txt", trajectory);
    const Trajectory back = read_trajectory(folder / "t.txt");
    ASSERT_EQ(back.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(back[i].utime, trajectory[i].utime);
    EXPECT_TRUE(
        back[1].world_from_camera.translation().isApprox(trajectory[1].world_from_camera.translation()));
}

TEST(Trajectory, CommentsBlankLinesCommasAndLineEndings) {
    const test::TemporaryFolder folder;
    const Trajectory trajectory = read_text(
        folder, "# a comment\r\n\n   \t\r\n  # another\n2.5 1 2 3 0 0 0 1\r\n1.25,4,5,6,0,0,0.6,0.8 extra\n");
    ASSERT_EQ(trajectory.size(), 2u);
    EXPECT_EQ(trajectory[0].utime, 1250000) << "sorted by time";
    EXPECT_EQ(trajectory[0].world_from_camera.translation(), Eigen::Vector3d(4, 5, 6));
    EXPECT_EQ(trajectory[1].utime, 2500000);
    EXPECT_TRUE(read_text(folder, "").empty());
    EXPECT_TRUE(read_text(folder, "# only a comment").empty());
}

TEST(Trajectory, StampsMayBeInAnyUnitAndAreExact) {
    const test::TemporaryFolder folder;
    for (const char* text : {"\xef\xbb\xbf"
                             "1311868164.363181 1 2 3 0 0 0 1\n1311868164.396514 1 2 3 0 0 0 1\n",
                             "1311868164363181000 1 2 3 0 0 0 1\n1311868164396514000 1 2 3 0 0 0 1\n",
                             "1.311868164363181e+09 1 2 3 0 0 0 1\n1.311868164396514e+09 1 2 3 0 0 0 1\n"}) {
        const Trajectory trajectory = read_text(folder, text);
        ASSERT_EQ(trajectory.size(), 2u) << text;
        EXPECT_EQ(trajectory[0].utime, 1311868164363181) << text;
        EXPECT_EQ(trajectory[1].utime, 1311868164396514) << text;
    }
    EXPECT_THAT(error_of(folder, "1311868164.3 0 0 0 0 0 0 1\n1311868164363181000 0 0 0 0 0 0 1\n"),
                testing::AllOf(HasSubstr("t.txt:2:"), HasSubstr("is in nanoseconds")));
}

TEST(Trajectory, HostileLinesAreNamed) {
    const test::TemporaryFolder folder;
    const std::string good = "1 0 0 0 0 0 0 1\n";
    for (const std::string bad :
         {"1 2 3", "1 0 0 0 0 0 0", "1 nan 0 0 0 0 0 1", "inf 0 0 0 0 0 0 1", "1 0 0 x 0 0 0 1",
          "1 0 0 0 0 0 0 0", "1 0 0 1e999 0 0 0 1", "1e300 0 0 0 0 0 0 1", "-1e14 0 0 0 0 0 0 1",
          "1 0 0 0 1e200 1e200 0 1", "\x01\xff\xfe", "1 0 0 0 0 0 0 1abc"}) {
        const std::string error = error_of(folder, good + bad + "\n" + good);
        EXPECT_THAT(error, HasSubstr("t.txt:2:")) << bad;
    }
    EXPECT_THAT(error_of(folder, std::string("1 0 0\0 0 0 0 0 1\n", 18)), HasSubstr("t.txt:1:"));
}

TEST(PoseAt, InterpolatesOnlyOverSmallGaps) {
    const auto at = [](std::int64_t utime, double x) {
        return StampedPose{utime, make_pose({x, 0, 0}, Eigen::Quaterniond::Identity())};
    };
    const Trajectory trajectory{at(100, 0), at(200, 1), at(400, 2)};
    EXPECT_NEAR(pose_at(trajectory, 150, 100).value().translation().x(), 0.5, 1e-12);
    EXPECT_EQ(pose_at(trajectory, 200, 0).value().translation().x(), 1);
    EXPECT_EQ(pose_at(trajectory, 400, 100).value().translation().x(), 2);
    EXPECT_FALSE(pose_at(trajectory, 300, 100)) << "the two around it are 200 apart";
    EXPECT_TRUE(pose_at(trajectory, 300, 200));
    EXPECT_FALSE(pose_at(trajectory, 99, 1000)) << "nothing is carried on beyond the ends";
    EXPECT_FALSE(pose_at(trajectory, 401, 1000));
    EXPECT_FALSE(pose_at({}, 1, 1000));
}

TEST(Trajectory, MissingFileIsNamed) {
    const test::TemporaryFolder folder;
    try {
        read_trajectory(folder / "missing.txt");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("missing.txt"));
    }
    EXPECT_THROW(write_trajectory(folder / "no_folder/t.txt", {}), std::runtime_error);
}

}  // namespace
}  // namespace planemap
