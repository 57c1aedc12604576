// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/edge_judge.hpp"

#include <gtest/gtest.h>

#include "evaluate/room.hpp"
#include "evaluate/statistics.hpp"

namespace planemap::evaluation {
namespace {

/// Floor, west and north wall, 4 m x 3 m x 2.4 m: three edges of together 9.4 m, one corner.
std::vector<Face> corner_of_a_room() {
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                          z = Eigen::Vector3d::UnitZ();
    return {{"floor", {2, 1.5, 0}, z, x, 2, 1.5},
            {"west wall", {0, 1.5, 1.2}, x, y, 1.5, 1.2},
            {"south wall", {2, 0, 1.2}, y, x, 2, 1.2}};
}

/// The map of the faces, with the given lines between planes 10, 11, 12 and points of all three.
PlaneMap map_with(const std::vector<std::pair<Eigen::Vector3f, Eigen::Vector3f>>& lines,
                  const std::vector<Eigen::Vector3f>& points) {
    PlaneMap map = map_of(corner_of_a_room());
    for (const auto& [from, to] : lines) map.lines.push_back({10, 11, from, to});
    for (const Eigen::Vector3f& p : points) map.points.push_back({{10, 11, 12}, p});
    return map;
}

TEST(EdgeJudge, AllEdgesAndTheCornerOfARoom) {
    const PlaneMap map =
        map_with({{{0, 0, 0}, {4, 0, 0}}, {{0, 0, 0}, {0, 3, 0}}, {{0, 0, 0}, {0, 0, 2.4f}}}, {{0, 0, 0}});
    const EdgeJudgement edges = judge_edges(truth_of(corner_of_a_room()), map, Pose::Identity());
    EXPECT_NEAR(edges.true_m, 9.4, 0.3);
    EXPECT_GT(edges.edges_found().value(), 0.98);
    EXPECT_EQ(edges.lines_right(), 1.0);
    EXPECT_EQ(edges.corners_found(), 1.0);
    EXPECT_EQ(edges.points_right(), 1.0);
}

TEST(EdgeJudge, ALineThatIsNoneAndAnEdgeWithoutOne) {
    const PlaneMap map = map_with({{{0, 0, 0}, {4, 0, 0}}, {{0, 1, 1}, {4, 1, 1}}}, {{0.1f, 0, 0}});
    const EdgeJudgement edges = judge_edges(truth_of(corner_of_a_room()), map, Pose::Identity());
    EXPECT_NEAR(edges.edges_found().value(), 4 / 9.4, 0.02);
    EXPECT_NEAR(edges.lines_right().value(), 0.5, 0.02);
    EXPECT_EQ(edges.corners_found(), 0.0) << "10 cm off";
    EXPECT_EQ(edges.points_right(), 0.0);
}

TEST(EdgeJudge, ALineAcrossAnEdgeIsNotTheEdge) {
    const PlaneMap map = map_with({{{2, -0.04f, 0}, {2, 0.04f, 0}}}, {});
    const EdgeJudgement edges = judge_edges(truth_of(corner_of_a_room()), map, Pose::Identity());
    EXPECT_EQ(edges.found_m, 0);
    EXPECT_EQ(edges.right_m, 0);
}

TEST(EdgeJudge, DoesNotDependOnTheMapsWorld) {
    const PlaneMap map = map_with({{{0, 0, 0}, {4, 0, 0}}}, {{0, 0, 0}});
    Pose truth_from_map = Pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
    truth_from_map.translation() << 1, -2, 3;
    PlaneMap moved = map;
    const auto moved_to_map = [&](Eigen::Vector3f& p) {
        p = (truth_from_map.inverse(Eigen::Isometry) * p.cast<double>()).cast<float>();
    };
    moved_to_map(moved.lines[0].from);
    moved_to_map(moved.lines[0].to);
    moved_to_map(moved.points[0].position);
    const EdgeJudgement here = judge_edges(truth_of(corner_of_a_room()), map, Pose::Identity()),
                        there = judge_edges(truth_of(corner_of_a_room()), moved, truth_from_map);
    EXPECT_NEAR(there.found_m, here.found_m, 0.05);
    EXPECT_EQ(there.met, here.met);
}

TEST(EdgeJudge, OfNothing) {
    const EdgeJudgement edges = judge_edges({}, {}, Pose::Identity());
    EXPECT_FALSE(edges.edges_found());
    EXPECT_FALSE(edges.lines_right());
    EXPECT_FALSE(edges.corners_found());
    EXPECT_FALSE(edges.points_right());
    EXPECT_TRUE(outline_gaps({}).empty());
}

TEST(OutlineGaps, HowFarTheOutlineEndsFromTheLine) {
    std::vector<Face> faces = corner_of_a_room();
    faces[1].centre.z() += 0.06;  // the wall begins 6 cm above the floor
    PlaneMap map = map_of(faces);
    map.lines.push_back({10, 11, {0, 0.1f, 0}, {0, 2.9f, 0}});
    const std::vector<double> gaps = outline_gaps(map);
    EXPECT_EQ(gaps.size(), 2u * 140) << "every 2 cm, two planes";
    EXPECT_NEAR(nearest_rank(gaps, 0.25), 0, 1e-3);
    EXPECT_NEAR(nearest_rank(gaps, 0.75), 0.06, 2e-3);
}

TEST(OutlineGaps, APlaneThatGoesThroughHasNone) {
    PlaneMap map = map_of(corner_of_a_room());
    map.lines.push_back({10, 12, {2, 0.5f, 0}, {2, 2.5f, 0}});  // amid the floor, square to the wall
    EXPECT_TRUE(outline_gaps(map).empty());
}

}  // namespace
}  // namespace planemap::evaluation
