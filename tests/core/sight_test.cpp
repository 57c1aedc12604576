// SPDX-License-Identifier: BSD-3-Clause
#include "core/sight.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/wall_and_plate.hpp"

namespace planemap {
namespace {

using scene::facing;
using scene::Rectangle;
using scene::two_regions;

TEST(Sight, TellsWhatIsSeenWhere) {
    const std::vector<PlanarRegion> regions = two_regions();
    const Sight sight(regions);
    EXPECT_EQ(sight.region_at({-0.6, 0, 3}), 0);
    EXPECT_EQ(sight.region_at({-0.3, 0, 1.5}), 0) << "before it, on the same ray";
    EXPECT_EQ(sight.region_at({0.5, 0.1, 2}), 1) << "the nearer one";
    EXPECT_EQ(sight.region_at({-0.1, 0, 3}), Sight::kNone) << "through the hole";
    EXPECT_EQ(sight.region_at({3, 0, 3}), Sight::kNone);
    EXPECT_EQ(sight.region_at({0, 0, -3}), Sight::kNone);
    EXPECT_EQ(sight.region_at({std::numeric_limits<double>::quiet_NaN(), 0, 1}), Sight::kNone);
    EXPECT_EQ(Sight().region_at({0, 0, 1}), Sight::kNone);
}

TEST(Sight, IgnoresWhatReachesBehindTheCamera) {
    const Rectangle floor{facing({0, 1, 0}, {0, -1, 0}, {1, 0, 0}), 3, 3, {}};
    const Sight sight({scene::region_of(floor, Pose::Identity(), 0.1)});
    EXPECT_EQ(sight.region_at({0, 1, 2}), Sight::kNone);
}

TEST(Sight, OfNothingSeesNothing) {
    const Sight sight{std::vector<PlanarRegion>{}};
    EXPECT_EQ(sight.region_at({0, 0, 1}), Sight::kNone);
    EXPECT_EQ(sight.reach(), 0);
    PlanarRegion bare = two_regions()[0];
    bare.outline = {};
    EXPECT_EQ(Sight({bare}).region_at({0, 0, 3}), Sight::kNone);
}

TEST(Sight, HoldsItsRegionsInReachAndDirections) {
    const std::vector<PlanarRegion> regions = two_regions();
    const Sight sight(regions);
    for (const PlanarRegion& region : regions) {
        for (const Ring& ring : region.outline.rings) {
            for (const Eigen::Vector2d& v : ring) {
                const Eigen::Vector3d p = region.box.frame_from_box * Eigen::Vector3d(v.x(), v.y(), 0);
                const Eigen::Array2d direction = p.head<2>() / p.z();
                EXPECT_LE(p.norm(), sight.reach());
                EXPECT_TRUE((direction >= sight.low().array() - 1e-9).all());
                EXPECT_TRUE((direction <= sight.high().array() + 1e-9).all());
            }
        }
    }
}

}  // namespace
}  // namespace planemap
