// SPDX-License-Identifier: BSD-3-Clause
#include "run/coverage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace planemap {
namespace {

constexpr double kLeaf = 0.05;

/// A plane at the given height with a square outline of 2 m and, if wanted, a hole of 1 m in its middle.
MapPlane square(double z, bool with_hole = false) {
    PlanarRegion region;
    region.plane = {Eigen::Vector3d::UnitZ(), -z};
    region.box.frame_from_box.translation().z() = z;
    region.box.half_extents = {1, 1, 0.01};
    region.outline.rings.push_back({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
    if (with_hole) region.outline.rings.push_back({{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}});
    return {0, region, 1};
}

PlaneMap map_of(std::vector<MapPlane> planes) {
    PlaneMap map;
    map.planes = std::move(planes);
    return map;
}

/// Leaf centres of a layer over [-half, half]^2.
std::vector<Eigen::Vector3d> layer(double z, double half) {
    std::vector<Eigen::Vector3d> leaves;
    for (double y = -half + kLeaf / 2; y < half; y += kLeaf)
        for (double x = -half + kLeaf / 2; x < half; x += kLeaf) leaves.emplace_back(x, y, z);
    return leaves;
}

TEST(Coverage, IsFullWherePlaneAndLeavesAgree) {
    const Coverage c = coverage_of(map_of({square(0.02)}), layer(0, 1), kLeaf);
    EXPECT_EQ(c.leaves_explained, 1);
    EXPECT_EQ(c.area_supported, 1);
}

TEST(Coverage, ReachesOneLeafSize) {
    const PlaneMap near = map_of({square(0.049)}), far = map_of({square(0.051)});
    EXPECT_EQ(coverage_of(near, layer(0, 1), kLeaf).leaves_explained, 1);
    EXPECT_EQ(coverage_of(far, layer(0, 1), kLeaf).leaves_explained, 0);
    EXPECT_EQ(coverage_of(far, layer(0, 1), kLeaf).area_supported, 0);
}

TEST(Coverage, AtHalfALeafReachesHalfAsFar) {
    for (const auto& [z, explained] : {std::pair(0.024, 1.0), std::pair(0.026, 0.0), std::pair(0.051, 0.0)})
        EXPECT_EQ(coverage_of(map_of({square(z)}), layer(0, 1), kLeaf).leaves_explained_half, explained) << z;
    // The nearest of two planes counts.
    EXPECT_EQ(coverage_of(map_of({square(0.01), square(0.04)}), layer(0, 1), kLeaf).leaves_explained_half, 1);
    EXPECT_EQ(coverage_of(map_of({square(0.04), square(0.01)}), layer(0, 1), kLeaf).leaves_explained_half, 1);
}

TEST(Coverage, CountsTheOutlineAndNotTheBox) {
    const PlaneMap map = map_of({square(0, true)});
    const Coverage inside = coverage_of(map, layer(0, 0.4), kLeaf);
    EXPECT_EQ(inside.leaves_explained, 0) << "leaves in the hole";
    EXPECT_EQ(inside.area_supported, 0);
    const Coverage all = coverage_of(map, layer(0, 1), kLeaf);
    EXPECT_NEAR(all.leaves_explained, 0.75, 0.06);
    EXPECT_EQ(all.area_supported, 1);
}

TEST(Coverage, UnsupportedAreaShows) {
    const Coverage c = coverage_of(map_of({square(0), square(3)}), layer(0, 1), kLeaf);
    EXPECT_EQ(c.leaves_explained, 1);
    EXPECT_NEAR(c.area_supported, 0.5, 1e-9);
}

/// By the definition: each leaf against each plane, each sample of each plane against each leaf.
Coverage by_definition(const PlaneMap& map, const std::vector<Eigen::Vector3d>& leaves) {
    Coverage coverage;
    double explained = 0, half = 0, samples = 0, supported = 0;
    for (const Eigen::Vector3d& leaf : leaves) {
        const auto within = [&](double reach) {
            return std::any_of(map.planes.begin(), map.planes.end(), [&](const MapPlane& plane) {
                return distance(plane.region(), leaf) <= reach;
            });
        };
        explained += within(kLeaf);
        half += within(kLeaf / 2);
    }
    for (const MapPlane& plane : map.planes) {
        const PlanarRegion region = plane.region();
        const double step = kLeaf / 2;
        const int columns = static_cast<int>(std::ceil(2 * region.box.half_extents.x() / step)) + 4;
        const int rows = static_cast<int>(std::ceil(2 * region.box.half_extents.y() / step)) + 4;
        for (int i = 0; i < rows * columns; ++i) {
            const Eigen::Vector2d p =
                step * Eigen::Vector2d(i % columns - 0.5 * (columns - 1), i / columns - 0.5 * (rows - 1));
            if (!contains(region.outline, p)) continue;
            ++samples;
            const Eigen::Vector3d world = region.box.frame_from_box * Eigen::Vector3d(p.x(), p.y(), 0);
            supported += std::any_of(leaves.begin(), leaves.end(), [&](const Eigen::Vector3d& leaf) {
                return (world - leaf).norm() <= kLeaf;
            });
        }
    }
    coverage.leaves_explained = leaves.empty() ? 0 : explained / static_cast<double>(leaves.size());
    coverage.leaves_explained_half = leaves.empty() ? 0 : half / static_cast<double>(leaves.size());
    coverage.area_supported = samples > 0 ? supported / samples : 0;
    return coverage;
}

/// A ring of n vertices about a point, between the two radii.
Ring star(std::mt19937_64& random, const Eigen::Vector2d& center, double inner, double outer, int n) {
    std::uniform_real_distribution<double> radius(inner, outer);
    Ring ring;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        ring.push_back(center + radius(random) * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    return ring;
}

TEST(Coverage, IsTheDefinitionsToTheLastSample) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> at(-1.5, 1.5);
    for (int round = 0; round < 6; ++round) {
        PlaneMap map;
        for (int id = 0; id < 4; ++id) {
            PlanarRegion region;
            const Pose pose = make_pose({at(random), at(random), at(random)},
                                        Eigen::Quaterniond(at(random), at(random), at(random), 1));
            region.box = {pose, {1.2, 0.9, 0.01}};
            region.plane = {pose.linear().col(2), -pose.linear().col(2).dot(pose.translation())};
            // Many crossings in a row, and few; a hole; a part aside; a corner out of the box.
            region.outline.rings = {star(random, {0, 0}, 0.5, 0.85, round % 2 ? 300 : 9),
                                    star(random, {0, 0.1}, 0.1, 0.4, 7),
                                    star(random, {1.1, 0.7}, 0.05, 0.2, 5)};
            map.planes.emplace_back(id, region, 1);
        }
        std::vector<Eigen::Vector3d> leaves;
        for (int i = 0; i < 2500; ++i) {
            // Half of them on a plane, half anywhere; all on the grid of the leaves.
            Eigen::Vector3d p(at(random), at(random), at(random));
            if (i % 2 == 0) {
                p.z() = 0;
                p = map.planes[static_cast<std::size_t>(i / 2) % 4].world_from_plane() * (0.6 * p);
            }
            leaves.push_back(kLeaf * (p / kLeaf).array().round().matrix());
        }
        const Coverage ours = coverage_of(map, leaves, kLeaf), expected = by_definition(map, leaves);
        EXPECT_EQ(ours.leaves_explained, expected.leaves_explained);
        EXPECT_EQ(ours.leaves_explained_half, expected.leaves_explained_half);
        EXPECT_EQ(ours.area_supported, expected.area_supported);
        EXPECT_GT(expected.leaves_explained, 0.2);
        EXPECT_GT(expected.area_supported, 0.05);
    }
}

/// A plane of 200 x 200 m whose edges zigzag, with leaves under 10 x 10 m of it. When each sample asked for
/// its leaves, this took a minute for such a plane without a zigzag.
TEST(Coverage, EndsForAHugePlane) {
    PlanarRegion region;
    region.plane = {Eigen::Vector3d::UnitZ(), 0};
    region.box.half_extents = {100, 100, 0.01};
    Ring& ring = region.outline.rings.emplace_back();
    for (int i = 0; i < 2000; ++i) ring.emplace_back(-100 + 0.1 * i, i % 2 == 0 ? -100 : -99);
    for (int i = 0; i < 2000; ++i) ring.emplace_back(100 - 0.1 * i, i % 2 == 0 ? 100 : 99);
    const PlaneMap map = map_of({MapPlane(0, region, 1)});
    const Coverage c = coverage_of(map, layer(0, 5), kLeaf);
    EXPECT_EQ(c.leaves_explained, 1);
    EXPECT_NEAR(c.area_supported, 100.0 / 39800, 2e-4);
    EXPECT_EQ(coverage_of(map, {}, kLeaf).area_supported, 0);
}

TEST(Coverage, OfNothing) {
    EXPECT_EQ(coverage_of({}, {}, kLeaf).leaves_explained, 0);
    EXPECT_EQ(coverage_of({}, layer(0, 1), kLeaf).leaves_explained, 0);
    EXPECT_EQ(coverage_of(map_of({square(0)}), {}, kLeaf).area_supported, 0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Coverage c = coverage_of(map_of({square(0)}), {{nan, 0, 0}}, kLeaf);
    EXPECT_EQ(c.leaves_explained, 0);
    EXPECT_EQ(c.area_supported, 0);
}

}  // namespace
}  // namespace planemap
