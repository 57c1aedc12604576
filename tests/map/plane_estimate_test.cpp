// SPDX-License-Identifier: BSD-3-Clause
#include "map/plane_estimate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <span>
#include <utility>

#include "map/estimates.hpp"
#include "map/evidence_shape.hpp"

namespace planemap::map {
namespace {

/// Counter-clockwise. Precondition: three points at least that are not on one line.
Ring convex_hull(std::span<const Eigen::Vector2d> points) {
    std::vector<Eigen::Vector2d> sorted(points.begin(), points.end());
    const auto less = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
    };
    std::sort(sorted.begin(), sorted.end(), less);
    sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    const auto cross = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return a.x() * b.y() - a.y() * b.x();
    };
    Ring hull;  // Andrew's monotone chain: lower hull, then upper
    const auto extend = [&](const Eigen::Vector2d& p, std::size_t keep) {
        while (hull.size() > keep && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
            hull.pop_back();
        hull.push_back(p);
    };
    for (const auto& p : sorted) extend(p, 1);
    const std::size_t lower = hull.size();
    for (std::size_t i = sorted.size() - 1; i-- > 0;) extend(sorted[i], lower);
    hull.pop_back();
    return hull;
}

using samples::estimate_of;
using samples::wall_at;
using scene::facing;
using scene::Rectangle;

void add(PlaneEstimate& estimate, const Rectangle& rectangle, const Reliability& reliability) {
    const StoredKeyframe keyframe = stored(0, {scene::region_of(rectangle, Pose::Identity(), 0.05)});
    const PlacedRegion placed(Pose::Identity(), keyframe.regions[0]);
    FlatPolygon polygon;
    outline_in(estimate.world_from_extent.inverse(Eigen::Isometry) * placed.box.frame_from_box,
               keyframe.regions[0], keyframe, polygon);
    estimate.add(placed, polygon, reliability);
    estimate.refit();
}

TEST(Extent, HoldsItsPointsTightly) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> at(0, 1);
    Extent extent;
    EXPECT_TRUE(extent.empty());
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < 50; ++i) {
        points.emplace_back(2 * at(random), at(random));
        extent.add(points.back());
    }
    const auto corners = extent.corners();
    const Ring ring(corners.begin(), corners.end());
    EXPECT_GE(signed_area(ring), signed_area(convex_hull(points)));
    EXPECT_LT(signed_area(ring), 1.1 * signed_area(convex_hull(points)));
    for (const auto& p : points) EXPECT_LT(distance({{ring}}, p), 1e-9);
}

TEST(PlaneEstimate, TheBoxHoldsAllRegions) {
    PlaneEstimate estimate = estimate_of(wall_at(0, 0, 3), 1);
    add(estimate, wall_at(2, 0.2, 3), {});
    EXPECT_NEAR(estimate.box.half_extents.x(), 1.5, 0.06);
    EXPECT_NEAR(estimate.low.x(), -0.5, 0.12);
    EXPECT_NEAR(estimate.high.x(), 2.5, 0.12);
    EXPECT_NEAR(estimate.low.z(), 3, 1e-3);
}

TEST(PlaneEstimate, WhatLiesOffHardlyPullsThePlaneAlong) {
    // A second plate of the same size 4 cm behind: a plain fit would go half way.
    const Reliability good{1, 0.01};
    PlaneEstimate estimate = estimate_of(wall_at(0, 0, 3), 1, good);
    add(estimate, wall_at(0.3, 0, 3.04), good);
    EXPECT_LT(std::abs(estimate.plane.signed_distance({0, 0, 3})), 0.003);
    EXPECT_EQ(estimate.moments.count, 800) << "the moments stay exact";
    // Where views may be off by as much, both count alike.
    const Reliability poor{1, 1};
    PlaneEstimate even = estimate_of(wall_at(0, 0, 3), 1, poor);
    add(even, wall_at(0.3, 0, 3.04), poor);
    EXPECT_NEAR(std::abs(even.plane.signed_distance({0.15, 0, 3})), 0.02, 0.001);
}

TEST(PlaneEstimate, OfAMapPlaneIsThatPlane) {
    const Rectangle wall{
        facing({3, -2, 1}, {0.3, 1, 0.1}, {0, 0, 1}), 1.5, 1, {scene::rectangle_ring(-0.5, -0.5, 0.3, 0.4)}};
    const MapPlane plane(5, scene::region_of(wall, Pose::Identity(), 0.05, 0.003), 12);
    const PlaneEstimate estimate(plane, 0.025);
    EXPECT_EQ(estimate.id, 5);
    EXPECT_EQ(estimate.keyframes, 12);
    EXPECT_LT(angle_between(estimate.plane.normal, plane.plane().normal), 1e-6);
    EXPECT_NEAR(estimate.plane.d, plane.plane().d, 1e-5);
    EXPECT_NEAR(area(outline_of(estimate.grid, samples::kOutline)), static_cast<double>(plane.area), 0.05);
    EXPECT_NEAR(estimate.moments.count, static_cast<double>(plane.inliers), 1e-3);
}

TEST(PlaneEstimate, CountsAKeyframeOnce) {
    PlaneEstimate estimate = estimate_of(wall_at(0, 0, 3), 1);
    estimate.count_keyframe(0, 1);
    estimate.count_keyframe(0, 1);
    EXPECT_EQ(estimate.keyframes, 1);
    estimate.count_keyframe(4, 3);
    EXPECT_EQ(estimate.keyframes, 4) << "its own view, and two that were handed on to it";
}

TEST(PlaneEstimate, AbsorbingLosesNothing) {
    PlaneEstimate a = samples::drawn_estimate_of(wall_at(0, 0, 3), 1);
    const PlaneEstimate b = samples::drawn_estimate_of(wall_at(0.8, 0, 3), 2);
    Moments all = a.moments;
    all += b.moments;
    a.absorb(b);
    EXPECT_EQ(a.moments.count, all.count);
    EXPECT_LT((a.moments.mean() - all.mean()).norm(), 1e-12);
    EXPECT_EQ(a.keyframes, 2);
    EXPECT_NEAR(area(outline_of(a.grid, samples::kOutline)), 1.8, 0.1);
    EXPECT_TRUE(a.changed);
}

}  // namespace
}  // namespace planemap::map
