// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <stdexcept>

#include "places/synthetic.hpp"

namespace planemap::graph {
namespace {

using namespace planemap::test;
using testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Root mean square distance of positions to the truth; both start at the same pose.
double rms_error(const KeyframeTrajectory& trajectory, const std::vector<Pose>& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
        sum +=
            (trajectory.keyframes[i].world_from_camera.translation() - truth[i].translation()).squaredNorm();
    return std::sqrt(sum / static_cast<double>(truth.size()));
}

double rms_error_of_odometry(const Walk& walk) {
    double sum = 0;
    for (std::size_t i = 0; i < walk.keyframes.size(); ++i) {
        sum += (walk.keyframes[i].odom_from_camera.translation() - walk.world_from_camera[i].translation())
                   .squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(walk.keyframes.size()));
}

/// True when every closure is right within the given error.
bool all_true(const PoseGraph& graph, const std::vector<Pose>& truth, double metres, double radians) {
    for (const LoopClosure& loop : graph.loop_closures()) {
        const Pose expected = truth[static_cast<std::size_t>(loop.from_id)].inverse() *
                              truth[static_cast<std::size_t>(loop.to_id)];
        const Pose error = expected.inverse() * loop.from_from_to;
        if (error.translation().norm() > metres || rotation_angle(error) > radians) return false;
    }
    return true;
}

void expect_consistent(const KeyframeTrajectory& trajectory) {
    for (std::size_t i = 0; i < trajectory.keyframes.size(); ++i) {
        EXPECT_TRUE(is_valid(trajectory.keyframes[i].world_from_camera));
        if (i == 0) continue;
        EXPECT_GT(trajectory.keyframes[i].id, trajectory.keyframes[i - 1].id);
    }
    EXPECT_TRUE(is_valid(trajectory.world_from_odom));
}

class GraphTest : public testing::Test {
  protected:
    Random random_{1};
    std::vector<Landmark> room_ = make_room(random_, Eigen::Vector3d::Zero(), 3.5, 3000);
};

TEST_F(GraphTest, AChainWithoutLoopsIsTheOdometry) {
    const auto poses = square_loop(3, 12, 0.5);
    const Walk walk = test::walk(room_, poses, random_);
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    const KeyframeTrajectory& trajectory = graph.trajectory();
    ASSERT_EQ(trajectory.keyframes.size(), walk.keyframes.size());
    EXPECT_EQ(trajectory.loop_closures, 0);
    EXPECT_EQ(trajectory.revision, 0);
    EXPECT_TRUE(trajectory.world_from_odom.isApprox(Pose::Identity(), 1e-9));
    for (std::size_t i = 0; i < walk.keyframes.size(); ++i) {
        EXPECT_TRUE(
            trajectory.keyframes[i].world_from_camera.isApprox(walk.keyframes[i].odom_from_camera, 1e-9));
        EXPECT_EQ(trajectory.keyframes[i].utime, walk.keyframes[i].utime);
    }
    EXPECT_EQ(trajectory.utime, walk.keyframes.back().utime);
}

TEST_F(GraphTest, ALoopIsClosedAndTheErrorDropsByALargeFactor) {
    const auto poses = square_loop(3, 12, 1.2);
    const Walk walk = test::walk(room_, poses, random_);
    PoseGraph graph;
    int last_revision = 0;
    for (const Keyframe& keyframe : walk.keyframes) {
        const KeyframeTrajectory& trajectory = graph.add(keyframe);
        EXPECT_GE(trajectory.revision, last_revision);
        last_revision = trajectory.revision;
        const Pose newest = trajectory.world_from_odom * keyframe.odom_from_camera;
        EXPECT_TRUE(newest.isApprox(trajectory.keyframes.back().world_from_camera, 1e-9));
    }
    expect_consistent(graph.trajectory());
    EXPECT_GT(graph.trajectory().loop_closures, 3);
    EXPECT_EQ(graph.trajectory().loop_closures, static_cast<int>(graph.loop_closures().size()));
    EXPECT_GT(graph.trajectory().revision, 0);
    EXPECT_TRUE(all_true(graph, poses, 0.15, 0.04));
    EXPECT_LT(rms_error(graph.trajectory(), poses), rms_error_of_odometry(walk) / 4);
    EXPECT_EQ(graph.trajectory().keyframes[0].world_from_camera.matrix(),
              walk.keyframes[0].odom_from_camera.matrix());
}

TEST_F(GraphTest, TheSameInputGivesTheSameBytes) {
    const Walk walk = test::walk(room_, square_loop(3, 10, 1.2), random_);
    PoseGraph one, two;
    for (const Keyframe& keyframe : walk.keyframes) {
        one.add(keyframe);
        two.add(keyframe);
    }
    EXPECT_GT(one.trajectory().loop_closures, 0);
    for (std::size_t i = 0; i < walk.keyframes.size(); ++i) {
        EXPECT_EQ(one.trajectory().keyframes[i].world_from_camera.matrix(),
                  two.trajectory().keyframes[i].world_from_camera.matrix());
    }
}

TEST_F(GraphTest, RandomDescriptorsCloseNothing) {
    Walk walk = test::walk(room_, square_loop(3, 10, 1.2), random_);
    for (Keyframe& keyframe : walk.keyframes) {
        for (Feature& feature : keyframe.features) feature.descriptor = random_descriptor(random_);
    }
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    EXPECT_TRUE(graph.loop_closures().empty());
}

TEST_F(GraphTest, SameDescriptorsWithAnotherGeometryCloseNothing) {
    Walk walk = test::walk(room_, square_loop(3, 10, 1.2), random_);
    for (Keyframe& keyframe : walk.keyframes) {
        for (Feature& feature : keyframe.features)
            feature.point = (random_.vector(1.5) + Eigen::Vector3d(0, 0, 3)).cast<float>();
    }
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    EXPECT_TRUE(graph.loop_closures().empty());
}

TEST_F(GraphTest, TwoIdenticalRoomsAreNotJoined) {
    // A second room, 9 m on, holds the same things. The camera goes round in one, walks over and goes round
    // again.
    const Eigen::Vector3d offset(9, 0, 0);
    auto rooms = room_;
    for (const Landmark& landmark : room_) rooms.push_back({landmark.position + offset, landmark.descriptor});
    std::vector<Pose> poses = square_loop(3, 12, 1.0);
    const Pose leave = poses.back();
    for (int i = 1; i <= 25; ++i) {
        Pose pose = leave;
        pose.translation() += offset * i / 25.0;
        poses.push_back(pose);
    }
    for (const Pose& pose : square_loop(3, 12, 1.0, offset)) poses.push_back(pose);
    const Walk walk = test::walk(rooms, poses, random_);
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    EXPECT_GT(graph.loop_closures().size(), 1u) << "each room closes on itself";
    EXPECT_TRUE(all_true(graph, poses, 0.15, 0.04));
}

/// Two cells alike to the last feature, 3 m apart along a corridor of which each stretch looks different.
struct TwinCells {
    Random random{5};
    std::vector<Landmark> cell = make_room(random, {0, 0, 1.6}, 1.3, 1200);
    std::vector<Landmark> corridor;
    std::vector<Pose> poses;
    std::vector<double> cell_at;  ///< x of the cell that each pose looks into; NaN: it stands in the corridor

    TwinCells() {
        for (int i = 0; i < 4000; ++i)
            corridor.push_back({{random.uniform(-6, 10), random.uniform(-1.4, 1.4), i % 2 == 0 ? 0.0 : -2.4},
                                random_descriptor(random)});
    }
    void go(const Pose& to, int steps, double in_cell) {
        for (int i = 1; i <= steps; ++i) {
            poses.push_back(poses.empty() ? to : interpolate(poses.back(), to, 1.0 / (steps - i + 1)));
            cell_at.push_back(in_cell);
        }
    }
    /// Along the corridor to the door, in, once round, out backwards and on: the same way for each.
    void visit(double x) {
        go(looking({x - 1.5, 0, -1.2}, M_PI / 2), 6, kNan);
        go(looking({x, 0, -1.2}, M_PI / 2), 5, kNan);
        go(looking({x, 0, -1.2}, 0), 4, kNan);
        go(looking({x, 0, 1.6}, 0), 8, x);
        for (int i = 1; i <= 16; ++i) go(looking({x, 0, 1.6}, i * M_PI / 8), 1, x);
        go(looking({x, 0, 0.2}, 0), 4, x);
        go(looking({x, 0, -1.2}, 0), 4, x);
        go(looking({x, 0, -1.2}, M_PI / 2), 4, kNan);
    }
    Walk walk() {
        Walk walk = test::walk({}, poses, random);
        for (std::size_t i = 0; i < poses.size(); ++i) {
            Pose inside = poses[i];
            if (!std::isnan(cell_at[i])) inside.translation().x() -= cell_at[i];
            walk.keyframes[i].features = see(std::isnan(cell_at[i]) ? corridor : cell, inside, random, 300);
        }
        return walk;
    }
};

/// Odometry is not asked: it may err by 10 m.
PoseGraph without_odometry_check() {
    GraphOptions options;
    options.drift_base_m = 10;
    return PoseGraph(options);
}

TEST_F(GraphTest, IdenticalRoomsThreeMetresApartAreNotJoinedWhateverOdometryAllows) {
    TwinCells cells;
    cells.visit(0);
    cells.visit(3);
    const Walk walk = cells.walk();
    PoseGraph graph = without_odometry_check();
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    EXPECT_GT(graph.loop_closures().size(), 4u) << "each room closes on itself";
    EXPECT_TRUE(all_true(graph, cells.poses, 0.2, 0.06));
}

TEST_F(GraphTest, ARoomEnteredAgainIsJoinedHoweverFarOdometryErred) {
    TwinCells cells;
    cells.visit(0);
    const std::size_t first = cells.poses.size();
    cells.visit(0);
    Walk walk = cells.walk();
    walk.keyframes[first].previous_from_camera.translation().x() += 3;
    PoseGraph graph = without_odometry_check();
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    const auto joins = [&](const LoopClosure& loop) {
        return loop.from_id < static_cast<int>(first) && loop.to_id >= static_cast<int>(first);
    };
    EXPECT_TRUE(std::any_of(graph.loop_closures().begin(), graph.loop_closures().end(), joins));
    EXPECT_TRUE(all_true(graph, cells.poses, 0.2, 0.06));
}

TEST_F(GraphTest, AWallSeenFromBothEndsTiesALongRoom) {
    // 16 m along a wall without any feature: odometry turns away, the wall does not.
    std::vector<Pose> poses;
    for (int i = 0; i <= 80; ++i) poses.push_back(looking({0.2 * i, 0, 0}, 0));
    Odometry odometry;
    odometry.bias << 0, 0, 0, 0, 0.002, 0;
    Walk walk = test::walk({}, poses, random_, odometry);
    for (Keyframe& keyframe : walk.keyframes) {
        Pose camera_from_wall = Pose::Identity();
        camera_from_wall.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).toRotationMatrix();
        camera_from_wall.translation().z() = 2.0;
        keyframe.regions.push_back(rectangle(camera_from_wall, 1.2, 0.9));
    }
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    graph.finish();
    const Pose error = poses.back().inverse() * graph.trajectory().keyframes.back().world_from_camera;
    const Pose drift = poses.back().inverse() * walk.keyframes.back().odom_from_camera;
    EXPECT_GT(std::abs(drift.translation().z()), 0.5);
    EXPECT_LT(std::abs(error.translation().z()), 0.1 * std::abs(drift.translation().z()));
    EXPECT_LT(rotation_angle(error), 0.2 * rotation_angle(drift));
}

TEST_F(GraphTest, KeyframesThatComeDuringAnOptimisationFollowIt) {
    const auto poses = square_loop(3, 12, 1.3);
    const Walk walk = test::walk(room_, poses, random_);
    PoseGraph graph;
    std::size_t next = 0;
    while (!graph.due()) graph.insert(walk.keyframes.at(next++));
    GraphOptimisation optimisation = graph.prepare();
    EXPECT_FALSE(graph.due());
    const std::size_t prepared = next;
    for (int i = 0; i < 5; ++i) graph.insert(walk.keyframes.at(next++));
    const KeyframeTrajectory before = graph.trajectory();
    optimisation.run();
    const KeyframeTrajectory after = graph.apply(optimisation);
    EXPECT_GT(after.revision, before.revision);
    for (std::size_t i = prepared; i < next; ++i) {
        const auto step = [&](const KeyframeTrajectory& trajectory) {
            return Pose(trajectory.keyframes[i - 1].world_from_camera.inverse() *
                        trajectory.keyframes[i].world_from_camera);
        };
        EXPECT_TRUE(step(after).isApprox(step(before), 1e-9));
    }
    expect_consistent(after);
}

TEST_F(GraphTest, OneFalseLoopDoesNotBendTheMap) {
    // A place 1.3 m aside looks like one seen before, within the bound of drift.
    const auto poses = square_loop(3, 12, 1.2);
    Walk walk = test::walk(room_, poses, random_);
    PoseGraph honest;
    for (const Keyframe& keyframe : walk.keyframes) honest.add(keyframe);

    Keyframe& mistaken = walk.keyframes[30];
    mistaken.features = see(room_, poses[4], random_);
    GraphOptions options;
    // Let it through the checks against odometry and against what else was seen.
    options.drift_base_m = options.drift_base_rad = options.surroundings_from_m = 10;
    PoseGraph graph(options);
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    EXPECT_FALSE(all_true(graph, poses, 0.3, 0.3)) << "the false one was accepted";
    for (const LoopClosure& loop : graph.loop_closures()) {
        if (loop.from_id != 30 && loop.to_id != 30) continue;
        EXPECT_LT(loop.weight, 0.05);
    }
    EXPECT_LT(rms_error(graph.trajectory(), poses), rms_error(honest.trajectory(), poses) + 0.03);
}

TEST_F(GraphTest, ALostStretchIsTiedInByALoopClosureAlone) {
    const auto poses = square_loop(3, 12, 1.3);
    Walk walk = test::walk(room_, poses, random_);
    // Lost at 20: from there on odometry starts over, turned and moved, as far as it may have gone.
    const Pose wrong = pose_from_twist((Twist() << 0.8, 0.1, -0.5, 0, 2.5, 0).finished());
    walk.keyframes[20].previous_id = -1;
    for (std::size_t i = 20; i < walk.keyframes.size(); ++i) {
        walk.keyframes[i].odom_from_camera = orthonormalised(wrong * walk.keyframes[i].odom_from_camera);
        walk.keyframes[i].utime += 2000000;
    }
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    expect_consistent(graph.trajectory());
    EXPECT_GT(graph.trajectory().loop_closures, 0);
    EXPECT_TRUE(all_true(graph, poses, 0.15, 0.04));
    EXPECT_LT(rms_error(graph.trajectory(), poses), 0.1);
}

/// The components that the trajectory names.
std::set<int> components_of(const PoseGraph& graph) {
    std::set<int> all;
    for (const KeyframePose& keyframe : graph.trajectory().keyframes) all.insert(keyframe.component);
    return all;
}

GraphOptions without_closures() {
    GraphOptions options;
    options.max_closures = 0;
    return options;
}

TEST_F(GraphTest, KeyframesThatNeverArrivedAreSpannedByTheOdomFrame) {
    Walk walk = test::walk(room_, square_loop(3, 12, 0.5), random_);
    for (Keyframe& keyframe : walk.keyframes) keyframe.chain = 0;
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) {
        if (keyframe.id != 7 && keyframe.id != 8) graph.add(keyframe);
    }
    expect_consistent(graph.trajectory());
    EXPECT_EQ(graph.trajectory().keyframes.size(), walk.keyframes.size() - 2);
    EXPECT_EQ(components_of(graph), std::set<int>{0});
}

TEST_F(GraphTest, AnEdgeFromAKeyframeThatNeverArrivedOfAChainThatNeverDidCountsAsALoss) {
    Walk walk = test::walk(room_, square_loop(3, 12, 0.5), random_);
    for (Keyframe& keyframe : walk.keyframes) keyframe.chain = keyframe.id < 7 ? 0 : 7;
    PoseGraph graph(without_closures());
    for (const Keyframe& keyframe : walk.keyframes)
        if (keyframe.id != 7) graph.add(keyframe);
    expect_consistent(graph.trajectory());
    EXPECT_EQ(components_of(graph), (std::set<int>{0, 8}));
}

TEST_F(GraphTest, ALossBeginsAComponentUntilALoopClosureTiesIt) {
    const auto poses = square_loop(3, 12, 1.3);
    Walk walk = test::walk(room_, poses, random_);
    walk.keyframes[20].previous_id = -1;
    PoseGraph graph, apart(without_closures());
    for (const Keyframe& keyframe : walk.keyframes) {
        graph.add(keyframe);
        apart.add(keyframe);
    }
    for (const KeyframePose& named : apart.trajectory().keyframes)
        EXPECT_EQ(named.component, named.id < 20 ? 0 : 20);
    EXPECT_EQ(components_of(graph), std::set<int>{0});
}

TEST_F(GraphTest, WhereTimeGoesBackNothingIsKnownOfTheWay) {
    const auto poses = square_loop(3, 12, 1.3);
    Walk walk = test::walk(room_, poses, random_);
    // The sensor started again 5 m away.
    const Pose wrong = pose_from_twist((Twist() << 5, 0, 0, 0, 1, 0).finished());
    walk.keyframes[20].previous_id = -1;
    for (std::size_t i = 20; i < walk.keyframes.size(); ++i) {
        walk.keyframes[i].odom_from_camera = orthonormalised(wrong * walk.keyframes[i].odom_from_camera);
        walk.keyframes[i].utime -= walk.keyframes[20].utime;
    }
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    EXPECT_EQ(components_of(graph), std::set<int>{0}) << "true loop closures are not refused";
    EXPECT_LT(rms_error(graph.trajectory(), poses), 0.1);
}

TEST_F(GraphTest, TimesAtBothEndsOfTheirRangeDoNotStopIt) {
    Walk walk = test::walk(room_, square_loop(3, 5, 1.3), random_);
    for (Keyframe& keyframe : walk.keyframes)
        keyframe.utime = keyframe.id % 2 == 0 ? std::numeric_limits<std::int64_t>::min()
                                              : std::numeric_limits<std::int64_t>::max();
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    expect_consistent(graph.trajectory());
}

/// Largest distance of a kept keyframe to where it truly stood.
double worst_error(const PoseGraph& graph, const std::vector<Pose>& truth) {
    double worst = 0;
    for (const KeyframePose& keyframe : graph.trajectory().keyframes) {
        const Pose& true_pose = truth[static_cast<std::size_t>(keyframe.id)];
        worst = std::max(worst, (keyframe.world_from_camera.translation() - true_pose.translation()).norm());
    }
    return worst;
}

TEST_F(GraphTest, APlaceWalkedRoundAgainAndAgainTakesNoMoreKeyframes) {
    const auto poses = square_loop(3, 12, 7);
    const Walk walk = test::walk(room_, poses, random_);
    GraphOptions keep_all;
    keep_all.max_alike = 0;
    PoseGraph graph, keeping(keep_all);
    std::size_t after_five = 0, bytes_after_five = 0;
    for (const Keyframe& keyframe : walk.keyframes) {
        graph.add(keyframe);
        keeping.add(keyframe);
        EXPECT_EQ(graph.trajectory().keyframes.back().id, keyframe.id);
        if (keyframe.id != 5 * 48) continue;
        after_five = graph.trajectory().keyframes.size();
        bytes_after_five = graph.memory_bytes();
    }
    graph.finish();
    keeping.finish();
    EXPECT_EQ(keeping.trajectory().keyframes.size(), walk.keyframes.size());
    EXPECT_LT(after_five, 4u * 48);
    EXPECT_LT(graph.trajectory().keyframes.size(), after_five + 12);
    EXPECT_LT(graph.memory_bytes(), bytes_after_five + bytes_after_five / 8);
    EXPECT_EQ(graph.counts().replaced, walk.keyframes.size() - graph.trajectory().keyframes.size());
    expect_consistent(graph.trajectory());
    EXPECT_EQ(graph.trajectory().keyframes[0].world_from_camera.matrix(),
              walk.keyframes[0].odom_from_camera.matrix());
    EXPECT_LT(worst_error(graph, poses), 1.5 * worst_error(keeping, poses) + 0.02);
    EXPECT_LT(worst_error(graph, poses), rms_error_of_odometry(walk) / 4);
}

TEST_F(GraphTest, AnEdgeFromAKeyframeThatWasReplacedLeadsFromItsKeeper) {
    const auto poses = square_loop(3, 12, 5);
    Walk walk = test::walk(room_, poses, random_);
    PoseGraph graph;
    for (std::size_t i = 0; i + 1 < walk.keyframes.size(); ++i) graph.add(walk.keyframes[i]);
    const auto is_kept = [&](int id) {
        const auto& kept = graph.trajectory().keyframes;
        return std::any_of(kept.begin(), kept.end(), [&](const KeyframePose& k) { return k.id == id; });
    };
    // The camera is found again against one of the first lap, which has gone.
    int gone = 40;
    while (gone > 0 && is_kept(gone)) --gone;
    ASSERT_GT(gone, 0);
    Keyframe found = walk.keyframes.back();
    found.previous_id = gone;
    found.previous_from_camera = poses[static_cast<std::size_t>(gone)].inverse() * poses.back();
    found.odom_from_camera.translation().x() += 3;  // odometry is astray, as after a loss
    found.features.clear();                         // no loop closure tells
    graph.add(found);
    const Pose& placed = graph.trajectory().keyframes.back().world_from_camera;
    EXPECT_LT((placed.translation() - poses.back().translation()).norm(), 0.1);
    EXPECT_LT(rotation_angle(placed.inverse() * poses.back()), 0.04);
}

TEST_F(GraphTest, ARoomThatLooksDifferentKeepsBothItsLooks) {
    // Three laps, then the same room in another light: other descriptors on half of it tell, three laps more.
    std::vector<Landmark> other_light = room_;
    for (std::size_t i = 0; i < other_light.size(); ++i) {
        if (i % 8 != 0) other_light[i].descriptor = random_descriptor(random_);
    }
    const auto poses = square_loop(3, 12, 8);
    Walk walk = test::walk(room_, poses, random_);
    const int change = 4 * 48;
    for (Keyframe& keyframe : walk.keyframes) {
        if (keyframe.id >= change)
            keyframe.features = see(other_light, poses[static_cast<std::size_t>(keyframe.id)], random_);
    }
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    int before = 0, after = 0;
    for (const KeyframePose& keyframe : graph.trajectory().keyframes)
        ++(keyframe.id < change ? before : after);
    EXPECT_GT(before, 30) << "the first light comes back";
    EXPECT_GT(after, 40);
    EXPECT_GT(graph.counts().replaced, 100u);
}

TEST_F(GraphTest, NothingAlikeInOnePlaceIsBoundedToo) {
    GraphOptions options;
    options.max_place = 5;
    PoseGraph graph(options);
    Walk walk =
        test::walk(room_, std::vector<Pose>(80, looking({0, 0, 0}, 0)), random_, {Twist::Zero(), 0, 0});
    for (Keyframe& keyframe : walk.keyframes) {
        keyframe.covariance.setZero();
        for (Feature& feature : keyframe.features) feature.descriptor = random_descriptor(random_);
        graph.add(keyframe);
    }
    EXPECT_LE(graph.trajectory().keyframes.size(), 5u + 1 + 24);
    EXPECT_EQ(graph.trajectory().keyframes.front().id, 0);
    EXPECT_EQ(graph.trajectory().keyframes.back().id, 79);
}

TEST_F(GraphTest, IdsFarFromTheLastAreRefusedAndAStrayFirstOneDoesNotStopIt) {
    const Walk walk = test::walk(room_, square_loop(3, 12, 0.3), random_);
    PoseGraph graph;
    EXPECT_TRUE(graph.expects(2147483647)) << "of the first nobody can tell";
    Keyframe stray = walk.keyframes[0];
    stray.id = 2147483647;
    stray.features.emplace_back().point.setZero();
    graph.add(stray);
    EXPECT_FALSE(graph.expects(0));
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    EXPECT_EQ(graph.trajectory().keyframes.size(), walk.keyframes.size());
    EXPECT_EQ(graph.counts().features_left_out, 1u) << "the stray's still counts";
    const int last = walk.keyframes.back().id;
    EXPECT_TRUE(graph.expects(last + 1));
    EXPECT_TRUE(graph.expects(last + 10000));
    EXPECT_FALSE(graph.expects(last + 10001));
    EXPECT_FALSE(graph.expects(last));
    EXPECT_FALSE(graph.expects(-1));
    EXPECT_THROW(graph.add(stray), std::invalid_argument);
    EXPECT_EQ(graph.trajectory().keyframes.size(), walk.keyframes.size());
}

TEST_F(GraphTest, WorldIsTheOdomFrameOfTheFirstKeyframe) {
    Walk walk = test::walk(room_, square_loop(3, 10, 0.3), random_);
    const Pose other = random_.pose();
    for (Keyframe& keyframe : walk.keyframes)
        keyframe.odom_from_camera = orthonormalised(other * keyframe.odom_from_camera);
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    EXPECT_EQ(graph.trajectory().keyframes[0].world_from_camera.matrix(),
              walk.keyframes[0].odom_from_camera.matrix());
    EXPECT_TRUE(graph.trajectory().world_from_odom.isApprox(Pose::Identity(), 1e-9));
}

TEST_F(GraphTest, HostileKeyframesAreRefusedByNameAndLeaveTheGraphAsItWas) {
    const Walk walk = test::walk(room_, square_loop(3, 12, 0.3), random_);
    PoseGraph graph;
    for (std::size_t i = 0; i < 6; ++i) graph.add(walk.keyframes[i]);
    const auto refusal = [&](auto change) -> std::string {
        Keyframe bad = walk.keyframes[6];
        change(bad);
        try {
            graph.add(bad);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(refusal([](auto& k) { k.id = 5; }), HasSubstr("id is 5"));
    EXPECT_THAT(refusal([](auto& k) { k.id = -4; }), HasSubstr("id is -4"));
    EXPECT_THAT(refusal([](auto& k) { k.previous_id = k.id; }), HasSubstr("previous_id"));
    EXPECT_THAT(refusal([](auto& k) { k.previous_id = -2; }), HasSubstr("previous_id"));
    EXPECT_THAT(refusal([](auto& k) { k.odom_from_camera.translation().x() = kNan; }),
                HasSubstr("odom_from_camera"));
    EXPECT_THAT(refusal([](auto& k) { k.odom_from_camera.linear().setZero(); }),
                HasSubstr("odom_from_camera"));
    EXPECT_THAT(refusal([](auto& k) { k.odom_from_camera.translation().x() = 1e300; }),
                HasSubstr("odom_from_camera"));
    EXPECT_THAT(refusal([](auto& k) { k.previous_from_camera.linear() *= 2; }),
                HasSubstr("previous_from_camera"));
    EXPECT_THAT(refusal([](auto& k) { k.features[3].point.z() = static_cast<float>(kNan); }),
                HasSubstr("features[3].point"));
    EXPECT_THAT(refusal([](auto& k) { k.features[2].pixel.x() = static_cast<float>(kNan); }),
                HasSubstr("features[2].pixel"));
    EXPECT_THAT(refusal([](auto& k) { k.features[1].region = 0; }), HasSubstr("features[1].region"));
    EXPECT_THAT(refusal([](auto& k) { k.regions.emplace_back(); }), HasSubstr("regions[0]"));
    EXPECT_EQ(graph.trajectory().keyframes.size(), 6u);
    EXPECT_NO_THROW(graph.add(walk.keyframes[6]));
}

TEST_F(GraphTest, UnusableCovariancesDoNotStopALoop) {
    const auto poses = square_loop(3, 10, 1.2);
    Walk walk = test::walk(room_, poses, random_);
    for (Keyframe& keyframe : walk.keyframes) {
        switch (keyframe.id % 5) {
            case 0:
                keyframe.covariance.setConstant(kNan);
                break;
            case 1:
                keyframe.covariance.setZero();
                break;
            case 2:
                keyframe.covariance = -Matrix6d::Identity();
                break;
            case 3:
                keyframe.covariance.setConstant(1e300);
                break;
            default:
                keyframe.covariance.setOnes();
                break;
        }
    }
    PoseGraph graph;
    for (const Keyframe& keyframe : walk.keyframes) graph.add(keyframe);
    expect_consistent(graph.trajectory());
    EXPECT_GT(graph.trajectory().loop_closures, 0);
}

TEST_F(GraphTest, StrangeFeaturesAreHandled) {
    PoseGraph graph;
    for (int id = 0; id < 24; ++id) {
        Keyframe keyframe;
        keyframe.id = 3 * id;
        keyframe.utime =
            id % 2 == 0 ? std::numeric_limits<std::int64_t>::max() : std::numeric_limits<std::int64_t>::min();
        keyframe.previous_id = id % 3 == 0 ? -1 : 3 * (id - 1);
        for (int i = 0; i < (id == 20 ? 5000 : 200 * (id % 3)); ++i) {
            Feature feature;
            const float sizes[] = {0.0f, -1.0f, 1e-30f, 2.0f, std::numeric_limits<float>::max()};
            feature.point = {sizes[random_.integer(0, 4)], sizes[random_.integer(0, 4)],
                             sizes[random_.integer(0, 4)]};
            if (id % 4 == 0) feature.descriptor = random_descriptor(random_);
            keyframe.features.push_back(feature);
        }
        graph.add(keyframe);
    }
    expect_consistent(graph.trajectory());
}

TEST_F(GraphTest, EveryBadOptionIsNamed) {
    GraphOptions options;
    EXPECT_NO_THROW(options.validate());
    options.min_inliers = 0;
    options.matching_ratio = kNan;
    options.loop_sigma_m = 0;
    try {
        PoseGraph graph(options);
        FAIL();
    } catch (const std::invalid_argument& error) {
        for (const char* field : {"min_inliers", "matching_ratio", "loop_sigma_m"})
            EXPECT_THAT(error.what(), HasSubstr(field));
    }
}

}  // namespace
}  // namespace planemap::graph
