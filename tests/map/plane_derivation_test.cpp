// SPDX-License-Identifier: BSD-3-Clause
#include "map/plane_derivation.hpp"

#include <gtest/gtest.h>

#include "map/estimates.hpp"

namespace planemap::map {
namespace {

using samples::drawn_estimate_of;
using samples::wall_at;
using scene::facing;
using scene::Rectangle;

const DerivationRules kRules = derivation_rules({});

TEST(DerivedPlane, HasTheEstimatesPlaneAndItsShapeInABoxAroundIt) {
    const Rectangle wall{
        facing({3, -2, 1}, {0.3, 1, 0.1}, {0, 0, 1}), 1.5, 1, {scene::rectangle_ring(-0.5, -0.5, 0.3, 0.4)}};
    const PlaneEstimate estimate = drawn_estimate_of(wall, 5);
    const auto plane = derived_plane(estimate, kRules);
    ASSERT_TRUE(plane.has_value());
    EXPECT_EQ(plane->id, 5);
    EXPECT_EQ(plane->keyframes, 1);
    EXPECT_LT(angle_between(plane->plane().normal, estimate.plane.normal), 1e-6);
    EXPECT_NEAR(plane->area, 6 - 0.8 * 0.9, 0.15);
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
    for (const Ring& ring : plane->outline.rings().rings) {
        for (const Eigen::Vector2d& v : ring) {
            low = low.cwiseMin(v);
            high = high.cwiseMax(v);
        }
    }
    EXPECT_LT((low + high).norm(), 0.003) << "the box is around the outline";
    EXPECT_LT((high - plane->half_extents.cast<double>()).norm(), 0.003);
}

TEST(DerivedPlane, NothingOfWhatIsSmallSeldomSeenOrWithoutShape) {
    const DerivationRules rules{samples::kOutline, 0.05, 0.25, 1};
    PlaneEstimate small = drawn_estimate_of(wall_at(0, 0, 3, 0.2), 0);
    EXPECT_FALSE(derived_plane(small, rules)) << "0.16 m2, seen once";
    small.count_keyframe(1, 1);
    EXPECT_TRUE(derived_plane(small, rules)) << "seen twice";
    EXPECT_FALSE(derived_plane(small, {samples::kOutline, 0.05, 0.25, 3}));
    PlaneEstimate scrap = drawn_estimate_of(wall_at(0, 0, 3, 0.1), 0);
    scrap.count_keyframe(1, 1);
    EXPECT_FALSE(derived_plane(scrap, rules)) << "0.04 m2";
    PlaneEstimate bare = samples::estimate_of(wall_at(0, 0, 3), 0);
    bare.count_keyframe(1, 1);
    EXPECT_FALSE(derived_plane(bare, rules));
}

TEST(KeepsOutline, AsLongAsHardlyACellChangedAndNothingMoved) {
    PlaneEstimate estimate = drawn_estimate_of(wall_at(0, 0, 3), 0);
    const auto plane = derived_plane(estimate, kRules);
    ASSERT_TRUE(plane.has_value());
    const Plane as_drawn = estimate.plane;
    EXPECT_TRUE(keeps_outline(estimate, *plane, as_drawn));
    estimate.changed_cells = PlaneEstimate::kAllCells;
    EXPECT_FALSE(keeps_outline(estimate, *plane, as_drawn));
    estimate.changed_cells = 3;
    EXPECT_TRUE(keeps_outline(estimate, *plane, as_drawn));
    estimate.plane.d += 0.0008;
    EXPECT_TRUE(keeps_outline(estimate, *plane, as_drawn));
    estimate.plane.d += 0.0004;
    EXPECT_FALSE(keeps_outline(estimate, *plane, as_drawn)) << "small moves add up";
    estimate.plane = as_drawn;
    estimate.plane.normal = (as_drawn.normal + Eigen::Vector3d(0.01, 0, 0)).normalized();
    EXPECT_FALSE(keeps_outline(estimate, *plane, as_drawn)) << "turned";
}

TEST(MoveToEstimate, TakesItsNumbersAndKeepsTheOutline) {
    PlaneEstimate estimate = drawn_estimate_of(wall_at(0, 0, 3), 0);
    auto plane = derived_plane(estimate, kRules);
    ASSERT_TRUE(plane.has_value());
    const MapOutline outline = plane->outline;
    estimate.plane.d += 0.0005;
    estimate.count_keyframe(1, 40000);
    move_to_estimate(*plane, estimate);
    EXPECT_NEAR(plane->plane().d, estimate.plane.d, 1e-5);
    EXPECT_EQ(plane->keyframes, 32767) << "as many as the message can tell";
    EXPECT_EQ(plane->outline, outline);
}

}  // namespace
}  // namespace planemap::map
