// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace planemap::simulator {
namespace {

TEST(HandPath, IsSmoothAndKeepsItsDistance) {
    const World office = make_office(1, 8);
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u}) {
        const Trajectory path = make_hand_path(office.tour, 30, 1000000, {}, seed);
        ASSERT_GT(path.size(), 3600u);
        double length = 0;
        for (std::size_t i = 1; i < path.size(); ++i) {
            const Pose step = path[i - 1].world_from_camera.inverse() * path[i].world_from_camera;
            const double dt = static_cast<double>(path[i].utime - path[i - 1].utime) * 1e-6;
            EXPECT_LT(step.translation().norm() / dt, 0.7);
            EXPECT_LT(rotation_angle(step) / dt, 1.1);
            EXPECT_TRUE(is_valid(path[i].world_from_camera));
            length += step.translation().norm();
        }
        EXPECT_GT(length, 8);
        for (std::size_t i = 0; i < path.size(); i += 12) {
            EXPECT_GT(office.clearance(path[i].world_from_camera.translation()), 0.33);
        }
    }
}

TEST(HandPath, ComesBackToItsStartWithinThirtySeconds) {
    const World office = make_office(1, 8);
    const double round = tour_duration(office.tour, {}, 1);
    EXPECT_LT(round, 29);
    const Trajectory path = make_hand_path(office.tour, 30, 0, {}, 1);
    const Pose again = pose_at(path, std::llround(round * 1e6));
    const Pose apart = path.front().world_from_camera.inverse() * again;
    EXPECT_LT(apart.translation().norm(), 0.02);
    EXPECT_LT(rotation_angle(apart), 0.05);
}

TEST(HandPath, ALongerWalkStartsTheSame) {
    const World office = make_office(1, 8);
    const Trajectory brief = make_hand_path(office.tour, 2, 0, {}, 7),
                     longer = make_hand_path(office.tour, 4, 0, {}, 7);
    for (std::size_t i = 0; i < brief.size(); ++i) {
        EXPECT_EQ(brief[i].world_from_camera.matrix(), longer[i].world_from_camera.matrix());
    }
}

TEST(PoseAt, InterpolatesAndStaysAtTheEnds) {
    Trajectory two(2);
    two[0].utime = 100;
    two[1].utime = 200;
    two[1].world_from_camera.translation() = Eigen::Vector3d(1, 0, 0);
    EXPECT_NEAR(pose_at(two, 125).translation().x(), 0.25, 1e-12);
    EXPECT_EQ(pose_at(two, 0).translation().x(), 0);
    EXPECT_EQ(pose_at(two, 500).translation().x(), 1);
}

TEST(FitPath, KeepsTheMotionAndStaysClear) {
    const char* set = std::getenv("PLANEMAP_DATA");
    const std::filesystem::path data = set != nullptr ? set : PLANEMAP_SOURCE "/../shared/data";
    if (!std::filesystem::exists(data / "handheld_poses")) GTEST_SKIP() << "no handheld_poses in " << data;
    const World office = make_office(1, 8);
    for (const char* name : {"kt0.txt", "kt1.txt", "kt2.txt", "kt3.txt"}) {
        const Trajectory recorded = read_trajectory(data / "handheld_poses" / name);
        const Trajectory path = fit_path(recorded, office);
        ASSERT_EQ(path.size(), recorded.size());
        double upright = 0;
        for (std::size_t i = 0; i < path.size(); i += 50) {
            const auto before = recorded.front().world_from_camera.inverse() * recorded[i].world_from_camera;
            const auto after = path.front().world_from_camera.inverse() * path[i].world_from_camera;
            EXPECT_LT((before.matrix() - after.matrix()).norm(), 1e-9);
            EXPECT_GT(office.clearance(path[i].world_from_camera.translation()), 0.1) << name << " " << i;
            upright -= path[i].world_from_camera.linear()(2, 1);  // the camera's y points down
        }
        EXPECT_GT(upright, 0) << name;
    }
}

}  // namespace
}  // namespace planemap::simulator
