// SPDX-License-Identifier: BSD-3-Clause
#include "map/plane_set.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::facing;
using scene::Rectangle;

constexpr double kDeg = std::numbers::pi / 180;
const MergeRules kRules{10 * kDeg, 0.05, 0.5};

PlaneEstimate surface_of(const Rectangle& rectangle, int id, const Reliability& reliability = {}) {
    const StoredKeyframe keyframe = stored(0, {scene::region_of(rectangle, Pose::Identity(), 0.05)});
    FlatPolygon polygon;
    outline_in(Pose::Identity(), keyframe.regions[0], keyframe, polygon);
    PlaneEstimate surface(PlacedRegion(Pose::Identity(), keyframe.regions[0]), polygon, reliability);
    surface.id = id;
    surface.grid = EvidenceGrid(surface.box.frame_from_box, 0.025);
    return surface;
}

void add(PlaneEstimate& surface, const Rectangle& rectangle, const Reliability& reliability) {
    const StoredKeyframe keyframe = stored(0, {scene::region_of(rectangle, Pose::Identity(), 0.05)});
    const PlacedRegion placed(Pose::Identity(), keyframe.regions[0]);
    FlatPolygon polygon;
    outline_in(surface.world_from_extent.inverse(Eigen::Isometry) * placed.box.frame_from_box,
               keyframe.regions[0], keyframe, polygon);
    surface.add(placed, polygon, reliability);
    surface.refit();
}

Rectangle wall_at(double x, double y, double z, double half = 0.5) {
    return {facing({x, y, z}, {0, 0, -1}, {1, 0, 0}), half, half, {}};
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
    PlaneEstimate surface = surface_of(wall_at(0, 0, 3), 1);
    add(surface, wall_at(2, 0.2, 3), {});
    EXPECT_NEAR(surface.box.half_extents.x(), 1.5, 0.06);
    EXPECT_NEAR(surface.low.x(), -0.5, 0.12);
    EXPECT_NEAR(surface.high.x(), 2.5, 0.12);
    EXPECT_NEAR(surface.low.z(), 3, 1e-3);
}

TEST(PlaneEstimate, WhatLiesOffHardlyPullsThePlaneAlong) {
    // A second plate of the same size 4 cm behind: a plain fit would go half way.
    const Reliability good{1, 0.01};
    PlaneEstimate surface = surface_of(wall_at(0, 0, 3), 1, good);
    add(surface, wall_at(0.3, 0, 3.04), good);
    EXPECT_LT(std::abs(surface.plane.signed_distance({0, 0, 3})), 0.003);
    EXPECT_EQ(surface.moments.count, 800) << "the moments stay exact";
    // Where views may be off by as much, both count alike.
    const Reliability poor{1, 1};
    PlaneEstimate even = surface_of(wall_at(0, 0, 3), 1, poor);
    add(even, wall_at(0.3, 0, 3.04), poor);
    EXPECT_NEAR(std::abs(even.plane.signed_distance({0.15, 0, 3})), 0.02, 0.001);
}

TEST(PlaneEstimate, OfAMapPlaneIsThatPlane) {
    const Rectangle wall{
        facing({3, -2, 1}, {0.3, 1, 0.1}, {0, 0, 1}), 1.5, 1, {scene::rectangle_ring(-0.5, -0.5, 0.3, 0.4)}};
    const MapPlane plane(5, scene::region_of(wall, Pose::Identity(), 0.05, 0.003), 12);
    const PlaneEstimate surface(plane, 0.025);
    EXPECT_EQ(surface.id, 5);
    EXPECT_EQ(surface.keyframes, 12);
    EXPECT_LT(angle_between(surface.plane.normal, plane.plane().normal), 1e-6);
    EXPECT_NEAR(surface.plane.d, plane.plane().d, 1e-5);
    EXPECT_NEAR(area(surface.grid.outline({})), static_cast<double>(plane.area), 0.05);
    EXPECT_NEAR(surface.moments.count, static_cast<double>(plane.inliers), 1e-3);
}

TEST(PlaneSet, AfterMergingNoPairSatisfiesTheRules) {
    std::mt19937_64 random(8);
    std::uniform_real_distribution<double> at(-3, 3), tilt(-0.2, 0.2), size(0.1, 0.6);
    PlaneSet set(kRules, 200);
    std::vector<std::size_t> all;
    double points = 0;
    for (int i = 0; i < 60; ++i) {
        const Rectangle r{facing({at(random), at(random), 3 + 0.03 * at(random)},
                                 {tilt(random), tilt(random), -1}, {1, 0, 0}),
                          size(random),
                          size(random),
                          {}};
        all.push_back(set.push_back(surface_of(r, i)));
        points += set.estimates().back().moments.count;
    }
    const std::vector<std::size_t> now = set.merge(all);
    const auto& surfaces = set.estimates();
    EXPECT_LT(surfaces.size(), 60u);
    EXPECT_GT(surfaces.size(), 1u);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        points -= surfaces[i].moments.count;
        for (std::size_t j = 0; j < i; ++j) {
            EXPECT_FALSE(
                same_plane(surfaces[i].plane, surfaces[i].box, surfaces[j].plane, surfaces[j].box, kRules));
        }
    }
    EXPECT_NEAR(points, 0, 1e-6) << "nothing is lost";
    std::vector<int> oldest(surfaces.size(), 1000);
    for (std::size_t i = 0; i < now.size(); ++i)
        oldest[now[i]] = std::min(oldest[now[i]], static_cast<int>(i));
    for (std::size_t i = 0; i < surfaces.size(); ++i) EXPECT_EQ(surfaces[i].id, oldest[i]);
}

TEST(PlaneSet, DoesNotGrowBeyondTheLargestExtent) {
    PlaneSet set(kRules, 5);
    set.push_back(surface_of(wall_at(0, 0, 3), 0));
    for (int i = 1; i < 10; ++i) set.push_back(surface_of(wall_at(i, 0, 3), i));
    set.merge({0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    EXPECT_GT(set.estimates().size(), 1u);
    for (const PlaneEstimate& surface : set.estimates()) EXPECT_LT(surface.box.half_extents.x(), 2.6);
}

}  // namespace
}  // namespace planemap::map
