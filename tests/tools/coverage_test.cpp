// SPDX-License-Identifier: BSD-3-Clause
#include "run/coverage.hpp"

#include <gtest/gtest.h>

#include <limits>

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
