// SPDX-License-Identifier: BSD-3-Clause
#include "graph/bent_depth.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/offset_at.hpp"
#include "graph/landmarks.hpp"
#include "graph/optimisation_task.hpp"

namespace planemap::graph {
namespace {

constexpr double kPi = 3.14159265358979;

CameraInfo sensor() {
    CameraInfo camera;
    camera.depth = camera.color = {320, 240, 290, 290, 159.5, 119.5};
    return camera;
}

/// Offsets of inverse depth that rise to the left and to the corners.
DepthCorrection bend(double size) {
    DepthCorrection field;
    for (std::size_t i = 0; i < DepthCorrection::kNodes; ++i) {
        const std::size_t row = i / DepthCorrection::kColumns, column = i % DepthCorrection::kColumns;
        const double x = static_cast<double>(column) / 2 - 1, y = static_cast<double>(row) / 1.5 - 1;
        field.offsets[i] = size * (0.5 - x + x * x * y);
    }
    return field;
}

/// A room of 4 x 4 x 2.5 m, its walls facing inwards; world frame, z up.
std::vector<Plane> room() {
    return {{{1, 0, 0}, 2},  {{-1, 0, 0}, 2},  {{0, 1, 0}, 2},
            {{0, -1, 0}, 2}, {{0, 0, 1}, 1.2}, {{0, 0, -1}, 1.3}};
}

/// What a sensor reads of the room when true inverse depth = sensed + `field`: a region for each plane.
std::vector<PlanarRegion> seen(const Pose& world_from_camera, const CameraInfo& camera,
                               const DepthCorrection& field, std::mt19937& random) {
    const std::vector<Plane> planes = room();
    std::vector<Moments> moments(planes.size());
    std::vector<std::vector<Eigen::Vector3d>> points(planes.size());
    std::normal_distribution<double> noise;
    for (int v = 4; v < camera.depth.height; v += 8) {
        for (int u = 4; u < camera.depth.width; u += 8) {
            const Eigen::Vector3d ray = camera.depth.unproject(u, v, 1);
            double inverse = 0;
            std::size_t nearest = 0;
            for (std::size_t i = 0; i < planes.size(); ++i) {
                const Plane plane = world_from_camera.inverse() * planes[i];
                const double along = -plane.normal.dot(ray) / plane.d;
                if (along > inverse) inverse = along, nearest = i;
            }
            const double sensed = 1 / (inverse - test::offset_at(field, camera.depth, u, v));
            const double read = sensed + camera.noise.sigma(sensed) * noise(random) / 8;
            points[nearest].push_back(read * ray);
            moments[nearest].add(points[nearest].back());
        }
    }
    std::vector<PlanarRegion> regions;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        if (points[i].size() < 60) continue;
        PlanarRegion region;
        region.moments = moments[i];
        region.plane = fit_plane(region.moments).plane;
        region.box = bound(principal_axes(region.plane, region.moments), points[i]);
        regions.push_back(region);
    }
    return regions;
}

/// A walk around the room: near walls and far from them, with odometry that errs by a few millimetres.
OptimisationTask walk(const CameraInfo& camera, const DepthCorrection& field, int steps) {
    std::mt19937 random(5);
    std::normal_distribution<double> noise;
    OptimisationTask task;
    std::vector<Pose> truth;
    Landmarks landmarks(landmark_options({}));
    for (int i = 0; i < steps; ++i) {
        const double turn = 2 * kPi * 2 * i / steps, round = 2 * kPi * i / steps;
        Eigen::Matrix3d upright;  // optical axes in the world, looking along x
        upright << 0, 0, 1, -1, 0, 0, 0, -1, 0;
        Pose pose = Pose::Identity();
        pose.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) * upright *
                        Eigen::AngleAxisd(0.3 * std::sin(5 * round), Eigen::Vector3d::UnitX()).matrix();
        pose.translation() << 0.9 * std::cos(round), 0.9 * std::sin(round), 0.2 * std::sin(3 * round);
        truth.push_back(pose);
        task.poses.push_back(pose);
        landmarks.add(i, seen(pose, camera, field, random), pose, camera.noise);
        if (i == 0) continue;
        PoseEdge edge;
        edge.from = i - 1;
        edge.to = i;
        edge.from_from_to = truth[truth.size() - 2].inverse() * pose;
        edge.from_from_to.translation() +=
            0.003 * Eigen::Vector3d(noise(random), noise(random), noise(random));
        edge.sqrt_information = 200 * Matrix6d::Identity();
        task.edges.push_back(edge);
    }
    task.landmarks = landmarks.landmarks();
    task.sightings = landmarks.shared();
    task.options = {3.0, 30};
    return task;
}

/// Difference of what both correct at a range, RMS over the nodes, metres.
double rms_m(const DepthCorrection& a, const DepthCorrection& b, double range_m) {
    double sum = 0;
    for (std::size_t i = 0; i < DepthCorrection::kNodes; ++i)
        sum += std::pow(range_m * range_m * (a.offsets[i] - b.offsets[i]), 2);
    return std::sqrt(sum / DepthCorrection::kNodes);
}

/// The largest.
double worst_m(const DepthCorrection& a, const DepthCorrection& b, double range_m) {
    double worst = 0;
    for (std::size_t i = 0; i < DepthCorrection::kNodes; ++i)
        worst = std::max(worst, range_m * range_m * std::abs(a.offsets[i] - b.offsets[i]));
    return worst;
}

TEST(BentDepth, AFieldIsLearntFromWallsSeenFromNearAndFar) {
    const DepthCorrection field = bend(0.004);  // up to 10 cm at 3 m in the corners
    const BentDepth bent = bent_depth(walk(sensor(), field, 80), sensor(), {});
    ASSERT_TRUE(bent.is_known);
    // Not all of it: planes say nothing of how a region is bent in itself.
    EXPECT_LT(rms_m(bent.correction, field, 3), 0.85 * rms_m({}, field, 3));
    EXPECT_LT(bent.rms_after, 0.7 * bent.rms_before);
    for (const double sigma : bent.correction.sigmas) EXPECT_GT(sigma, 0);
}

TEST(BentDepth, NothingIsInventedOfASensorThatIsRight) {
    const BentDepth bent = bent_depth(walk(sensor(), {}, 80), sensor(), {});
    ASSERT_TRUE(bent.is_known);
    EXPECT_LT(worst_m(bent.correction, {}, 3), 0.001);
}

TEST(BentDepth, WhatWasCorrectedBeforeCountsInThePrior) {
    const DepthCorrection field = bend(0.004);
    DepthCorrection rest = field, so_far = field;
    for (std::size_t i = 0; i < DepthCorrection::kNodes; ++i) {
        so_far.offsets[i] *= 0.75;
        rest.offsets[i] *= 0.25;
    }
    const BentDepth bent = bent_depth(walk(sensor(), rest, 80), sensor(), so_far);
    const BentDepth at_once = bent_depth(walk(sensor(), field, 80), sensor(), {});
    EXPECT_LT(rms_m(composed(so_far, bent.correction), at_once.correction, 3), 0.01);
}

TEST(BentDepth, WhatSingleImagesSayCountsToo) {
    Flatness flatness;  // they saw the field itself
    const DepthCorrection field = bend(0.004);
    flatness.information.diagonal().setConstant(1e8);
    flatness.pull = 1e8 * Eigen::Map<const Flatness::Field>(field.offsets.data());
    const BentDepth bent = bent_depth(walk(sensor(), field, 80), sensor(), {}, flatness);
    EXPECT_LT(worst_m(bent.correction, field, 3), 0.003);
}

TEST(BentDepth, OneViewAloneSaysNothing) {
    const OptimisationTask task = walk(sensor(), bend(0.004), 1);
    const BentDepth bent = bent_depth(task, sensor(), {});
    EXPECT_FALSE(bent.is_known);
    EXPECT_EQ(bent.correction, DepthCorrection{});
}

TEST(BentDepth, TheTaskStaysAsItIs) {
    const OptimisationTask task = walk(sensor(), bend(0.004), 20);
    const std::vector<Pose> before = task.poses;
    const BentDepth a = bent_depth(task, sensor(), {}), b = bent_depth(task, sensor(), {});
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(before[i].matrix(), task.poses[i].matrix());
    EXPECT_EQ(a.correction, b.correction);
}

}  // namespace
}  // namespace planemap::graph
