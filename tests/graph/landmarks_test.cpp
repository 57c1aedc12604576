// SPDX-License-Identifier: BSD-3-Clause
#include "graph/landmarks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "graph/optimisation.hpp"

namespace planemap::graph {
namespace {

/// A flat rectangle as a camera at the given pose sees it.
PlanarRegion rectangle(const Pose& world_from_camera, const Eigen::Vector3d& centre, const Eigen::Vector3d& u,
                       const Eigen::Vector3d& v) {
    PlanarRegion region;
    std::vector<Eigen::Vector3d> points;
    for (int i = -10; i <= 10; ++i) {
        for (int j = -10; j <= 10; ++j) {
            points.push_back(world_from_camera.inverse() * (centre + 0.1 * i * u + 0.1 * j * v));
            region.moments.add(points.back());
        }
    }
    region.plane = fit_plane(region.moments).plane;
    region.box = bound(principal_axes(region.plane, region.moments), points);
    return region;
}

const DepthNoise kNoise;
const Eigen::Vector3d kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

PlanarRegion floor_seen(const Pose& world_from_camera, double height = -1) {
    return rectangle(world_from_camera, {0, 0, height}, 1.5 * kX, 1.0 * kY);
}

TEST(Landmarks, AFloorSeenAgainIsTheSameLandmark) {
    Landmarks landmarks(landmark_options({}));
    for (int node = 0; node < 3; ++node) {
        const Pose pose = make_pose({0.1 * node, 0, 0.01 * node}, Eigen::Quaterniond(1, 0.005 * node, 0, 0));
        EXPECT_LT(landmarks.add(node, {floor_seen(Pose::Identity())}, pose, kNoise), node == 0 ? 1e-9 : 10.0);
    }
    ASSERT_EQ(landmarks.landmarks().size(), 1u);
    EXPECT_EQ(landmarks.shared().size(), 3u);
}

TEST(Landmarks, OtherPlanesAreOtherLandmarks) {
    Landmarks landmarks(landmark_options({}));
    const Pose eye = Pose::Identity();
    landmarks.add(0, {floor_seen(eye)}, eye, kNoise);
    landmarks.add(1, {floor_seen(eye, -1.1)}, eye, kNoise);  // a step of 10 cm
    landmarks.add(2, {rectangle(eye, {0, 0, 1}, 1.5 * kX, 1.0 * kY)}, eye,
                  kNoise);  // the ceiling: faces the other way
    landmarks.add(3, {rectangle(eye, {6, 0, -1}, 1.5 * kX, 1.0 * kY)}, eye,
                  kNoise);  // level with the floor, elsewhere
    landmarks.add(4, {rectangle(eye, {0, 2, 0}, 1.5 * kX, 1.0 * kZ)}, eye, kNoise);    // a wall
    landmarks.add(5, {rectangle(eye, {0, 2, 0.5}, 0.1 * kX, 0.1 * kZ)}, eye, kNoise);  // too small
    EXPECT_EQ(landmarks.landmarks().size(), 5u);
    EXPECT_TRUE(landmarks.shared().empty());
}

TEST(Landmarks, ARegionThatFitsTwoIsLeftOut) {
    Landmarks landmarks(landmark_options({}));
    const Pose eye = Pose::Identity();
    landmarks.add(0, {floor_seen(eye, -1.0)}, eye, kNoise);
    landmarks.add(0, {floor_seen(eye, -1.08)}, eye, kNoise);
    landmarks.add(1, {floor_seen(eye, -1.04)}, eye, kNoise);
    EXPECT_EQ(landmarks.landmarks().size(), 2u);
    EXPECT_TRUE(landmarks.shared().empty());
}

TEST(Landmarks, MergeJoinsWhatCoincidesAfterTheGraphMoved) {
    Landmarks landmarks(landmark_options({}));
    const Pose eye = Pose::Identity();
    landmarks.add(0, {floor_seen(eye)}, eye, kNoise);
    landmarks.add(1, {floor_seen(eye)}, make_pose({0, 0, 0.2}, Eigen::Quaterniond::Identity()), kNoise);
    ASSERT_EQ(landmarks.landmarks().size(), 2u);
    std::vector<Landmark> optimised = landmarks.landmarks();
    optimised[1].plane = optimised[0].plane;
    landmarks.follow(optimised, {eye, eye});
    landmarks.merge();
    EXPECT_EQ(landmarks.shared().size(), 2u);
    for (const Sighting& sighting : landmarks.shared()) EXPECT_EQ(sighting.landmark, 0);
    landmarks.add(2, {floor_seen(eye)}, eye, kNoise);
    EXPECT_EQ(landmarks.shared().back().landmark, 0) << "the newer one takes no more part";
}

TEST(Landmarks, ANodeThatGoesLeavesWhatItSawToItsKeeper) {
    Landmarks landmarks(landmark_options({}));
    const Pose eye = Pose::Identity();
    const Pose aside = make_pose({1, 0, 0}, Eigen::Quaterniond::Identity());
    const auto wall = [](const Pose& pose) { return rectangle(pose, {0, 2, 0}, 1.5 * kX, 1.0 * kZ); };
    landmarks.add(0, {floor_seen(eye)}, eye, kNoise);
    landmarks.add(1, {floor_seen(eye), wall(eye)}, eye, kNoise);
    landmarks.add(2, {floor_seen(aside), wall(aside)}, aside, kNoise);
    ASSERT_EQ(landmarks.shared().size(), 5u);
    // Node 1 goes, node 0 keeps: it has seen the floor itself, and now stands for the view of the wall.
    landmarks.hand_over(1, 0, Pose::Identity());
    EXPECT_EQ(landmarks.landmarks().size(), 2u);
    ASSERT_EQ(landmarks.shared().size(), 4u);
    for (const Sighting& sighting : landmarks.shared()) {
        ASSERT_LE(sighting.node, 1) << "node 2 is node 1 now";
        const Plane& plane = landmarks.landmarks()[static_cast<std::size_t>(sighting.landmark)].plane;
        EXPECT_LT(sighting_error(sighting, sighting.node == 0 ? eye : aside, plane).norm(), 1e-6);
    }
    // Nobody else sees what the last one saw: the landmark stays as long as its keeper does.
    landmarks.add(2, {rectangle(eye, {6, 0, -1}, 1.5 * kX, 1.0 * kY)}, eye, kNoise);
    EXPECT_EQ(landmarks.landmarks().size(), 3u);
    landmarks.hand_over(2, 1, aside.inverse());
    EXPECT_EQ(landmarks.landmarks().size(), 3u);
}

/// A floor that the poses put 15 cm apart: two landmarks, until the map says that it is one surface.
TEST(Landmarks, ASurfaceOfTheMapIsOneLandmark) {
    Landmarks landmarks(landmark_options({}));
    const Pose eye = Pose::Identity(), raised = make_pose({0, 0, 0.15}, Eigen::Quaterniond::Identity());
    const PlanarRegion wall = rectangle(eye, {0, 2, 0}, 1.5 * kX, 1.0 * kZ);
    const std::vector<Pose> poses{eye, eye, raised, raised};
    for (int node = 0; node < 4; ++node)
        landmarks.add(node, {wall, floor_seen(eye)}, poses[static_cast<std::size_t>(node)], kNoise);
    ASSERT_EQ(landmarks.landmarks().size(), 3u);
    EXPECT_LT(landmarks.worst_error(poses), 1e-6);

    EXPECT_TRUE(landmarks.adopt({{4, 7}, {4, 7}, {4, 7}, {4, 7}}, poses));
    ASSERT_EQ(landmarks.landmarks().size(), 2u);
    EXPECT_EQ(landmarks.shared().size(), 8u);
    EXPECT_NEAR(landmarks.landmarks()[1].plane.signed_distance({0, 0, 0}), 1 - 0.075, 1e-9);
    EXPECT_GT(landmarks.worst_error(poses), 1);
    EXPECT_FALSE(landmarks.adopt({{9, 2}, {9, 2}, {9, 2}, {9, 2}}, poses)) << "other names of the same";
    landmarks.merge();
    EXPECT_EQ(landmarks.shared().size(), 8u);
    // Two again: what the map does not name follows most others.
    EXPECT_TRUE(landmarks.adopt({{4, 7}, {}, {4, 8}, {4, 8}}, poses));
    EXPECT_EQ(landmarks.landmarks().size(), 3u);
    ASSERT_EQ(landmarks.shared().size(), 7u) << "one floor is seen by node 0 alone";
    EXPECT_EQ(landmarks.shared()[1].landmark, landmarks.shared()[0].landmark);
    EXPECT_EQ(landmarks.shared()[2].landmark, landmarks.shared().back().landmark);
}

/// One that fits two landmarks is of neither, until the map knows.
TEST(Landmarks, TheMapTellsWhichOfTwoARegionShows) {
    Landmarks landmarks(landmark_options({}));
    const Pose eye = Pose::Identity();
    landmarks.add(0, {floor_seen(eye, -1.0)}, eye, kNoise);
    landmarks.add(1, {floor_seen(eye, -1.08)}, eye, kNoise);
    landmarks.add(2, {floor_seen(eye, -1.04)}, eye, kNoise);
    EXPECT_TRUE(landmarks.shared().empty());
    EXPECT_TRUE(landmarks.adopt({{0}, {1}, {1}}, {eye, eye, eye}));
    ASSERT_EQ(landmarks.shared().size(), 2u);
    EXPECT_EQ(landmarks.shared()[0].node, 1);
    landmarks.hand_over(2, 1, Pose::Identity());
    EXPECT_TRUE(landmarks.shared().empty());
}

TEST(Landmarks, SurfacesOfNothingChangeNothing) {
    Landmarks landmarks(landmark_options({}));
    EXPECT_FALSE(landmarks.adopt({}, {}));
    landmarks.add(0, {floor_seen(Pose::Identity())}, Pose::Identity(), kNoise);
    EXPECT_FALSE(landmarks.adopt({{-1, 3, 4}}, {Pose::Identity()}));
    EXPECT_EQ(landmarks.landmarks().size(), 1u);
}

TEST(Landmarks, NothingComesOfRegionsWithoutAPlane) {
    Landmarks landmarks(landmark_options({}));
    EXPECT_EQ(landmarks.add(0, {PlanarRegion{}}, Pose::Identity(), kNoise), 0);
    EXPECT_TRUE(landmarks.landmarks().empty());
}

/// What the graph weighs sightings by: a noisier sensor's are let go farther.
TEST(Landmarks, ASensorOfTwiceTheNoiseWeighsLess) {
    DepthNoise twice = kNoise;
    twice.base_m *= 2;
    twice.quadratic_per_m *= 2;
    const LandmarkOptions options = landmark_options({});
    const auto weight_of = [&](const DepthNoise& noise, double depth) {
        Landmarks landmarks(options);
        for (int node = 0; node < 2; ++node)
            landmarks.add(node, {rectangle(Pose::Identity(), depth * kZ, 1.5 * kX, 1.0 * kY)},
                          Pose::Identity(), noise);
        return landmarks.shared().at(0).sqrt_weight;
    };
    for (const double depth : {1.0, 2.0, 4.0}) {
        EXPECT_NEAR(weight_of(kNoise, depth), 1 / std::hypot(options.sigma_m, kNoise.sigma(depth)), 1e-9);
        EXPECT_NEAR(weight_of(twice, depth), 1 / std::hypot(options.sigma_m, 2 * kNoise.sigma(depth)), 1e-9);
    }
    EXPECT_LT(weight_of(twice, 4), 0.55 * weight_of(kNoise, 4))
        << "far away the sensor's noise is nearly all";
}

/// How far a drifted node is drawn back to the floor by its sightings, of 2 cm.
TEST(Landmarks, ASensorOfTwiceTheNoiseDrawsTheGraphLess) {
    DepthNoise twice = kNoise;
    twice.base_m *= 2;
    twice.quadratic_per_m *= 2;
    const auto drawn = [&](const DepthNoise& noise) {
        std::vector<Pose> poses(2, Pose::Identity());
        poses[1].translation().z() = 0.02;
        Landmarks landmarks(landmark_options({}));
        const PlanarRegion seen = rectangle(Pose::Identity(), 4 * kZ, 1.5 * kX, 1.0 * kY);
        for (int node = 0; node < 2; ++node) landmarks.add(node, {seen}, Pose::Identity(), noise);
        const std::vector<PoseEdge> edges{{0, 1, poses[1], Matrix6d::Identity() / 0.02, false}};
        std::vector<Landmark> planes = landmarks.landmarks();
        optimise(poses, edges, 0, {}, &planes, landmarks.shared());
        return 0.02 - poses[1].translation().z();
    };
    EXPECT_GT(drawn(kNoise), 0.001);
    EXPECT_GT(drawn(twice), 0);
    EXPECT_LT(drawn(twice), drawn(kNoise));
}

/// A walk over a floor with noisy odometry: the shared floor holds height, roll and pitch.
TEST(Landmarks, ASharedFloorStopsDrift) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> noise(0, 0.01);
    std::vector<Pose> truth{Pose::Identity()}, drifting{Pose::Identity()};
    Pose odometry = Pose::Identity();
    std::vector<PoseEdge> edges;
    Landmarks landmarks(landmark_options({}));
    landmarks.add(0, {floor_seen(truth[0])}, truth[0], kNoise);
    for (int node = 1; node < 30; ++node) {
        Twist step = Twist::Zero(), error;
        step[0] = 0.05;
        for (int i = 0; i < 6; ++i) error[i] = noise(random);
        truth.push_back(truth.back() * pose_from_twist(step));
        const Pose measured = pose_from_twist(step) * pose_from_twist(error);
        drifting.push_back(drifting.back() * measured);
        odometry = odometry * measured;
        edges.push_back({node - 1, node, measured, Matrix6d::Identity() / 0.01, false});
        landmarks.add(node, {floor_seen(truth.back())}, drifting.back(), kNoise);
        std::vector<Landmark> optimised = landmarks.landmarks();
        optimise(drifting, edges, 0, {}, &optimised, landmarks.shared());
        landmarks.follow(optimised, {});
        landmarks.merge();
    }
    const auto height_error = [&](const Pose& p) {
        return std::abs((truth.back().inverse() * p).translation().z());
    };
    const auto tilt_error = [&](const Pose& p) {
        return angle_between((truth.back().inverse() * p).linear() * kZ, kZ);
    };
    EXPECT_LT(height_error(drifting.back()), 0.03);
    EXPECT_LT(tilt_error(drifting.back()), 0.02);
    EXPECT_LT(height_error(drifting.back()) + tilt_error(drifting.back()),
              0.5 * (height_error(odometry) + tilt_error(odometry)));
    EXPECT_EQ(landmarks.landmarks().size(), 1u);
}

/// One wrong sighting among many right ones does not bend the graph.
TEST(Landmarks, AWrongSightingIsLetGo) {
    std::vector<Pose> poses(5, Pose::Identity());
    std::vector<PoseEdge> edges;
    Landmarks landmarks(landmark_options({}));
    for (int node = 0; node < 5; ++node) {
        if (node > 0) edges.push_back({node - 1, node, Pose::Identity(), Matrix6d::Identity() / 0.01, false});
        landmarks.add(node, {floor_seen(poses[static_cast<std::size_t>(node)])},
                      poses[static_cast<std::size_t>(node)], kNoise);
    }
    std::vector<Sighting> sightings = landmarks.shared();
    for (auto& p : sightings[2].points_camera) p.z() += 0.5;
    std::vector<Landmark> planes = landmarks.landmarks();
    optimise(poses, edges, 0, {}, &planes, sightings);
    EXPECT_LT(poses[2].translation().norm(), 0.02);
}

}  // namespace
}  // namespace planemap::graph
