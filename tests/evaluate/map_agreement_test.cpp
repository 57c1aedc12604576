// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/map_agreement.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

/// A rectangle at `centre`, its normal turned from z by `tilt` about x.
MapPlane rectangle(int id, const Eigen::Vector3d& centre, double half_x, double half_y, double tilt = 0) {
    PlanarRegion region;
    region.box.frame_from_box.linear() = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()).toRotationMatrix();
    region.box.frame_from_box.translation() = centre;
    region.box.half_extents = {half_x, half_y, 0};
    region.plane.normal = region.box.frame_from_box.linear().col(2);
    region.plane.d = -region.plane.normal.dot(centre);
    region.outline.rings = {{{-half_x, -half_y}, {half_x, -half_y}, {half_x, half_y}, {-half_x, half_y}}};
    region.moments.count = 100;
    return MapPlane(id, region, 1);
}

TEST(MapAgreement, AMapAgreesWithItselfWhateverItsIds) {
    PlaneMap a, b;
    a.planes = {rectangle(1, {0, 0, 0}, 2, 1), rectangle(2, {0, 0, 1}, 1, 1),
                rectangle(3, {5, 0, 0}, 1, 0.5)};
    b.planes = {rectangle(7, {5, 0, 0}, 1, 0.5), rectangle(8, {0, 0, 0}, 2, 1),
                rectangle(9, {0, 0, 1}, 1, 1)};
    const auto pairs = pair_planes(a, b);
    ASSERT_EQ(pairs.size(), 3u);
    const int partners[] = {8, 9, 7};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(pairs[i].id_b, partners[i]);
        EXPECT_GT(pairs[i].iou, 0.99);
        EXPECT_TRUE(pairs[i].agrees({}));
    }
}

TEST(MapAgreement, MeasuresWhatDiffers) {
    PlaneMap a, b;
    a.planes = {rectangle(1, {0, 0, 0}, 2, 1)};
    b.planes = {rectangle(1, {0, 0, 0.02}, 2, 1)};
    EXPECT_NEAR(pair_planes(a, b)[0].distance_m, 0.02, 1e-4);
    EXPECT_FALSE(pair_planes(a, b)[0].agrees({}));
    b.planes = {rectangle(1, {0, 0, 0}, 2, 1, 0.02)};
    EXPECT_NEAR(pair_planes(a, b)[0].angle_deg, 1.146, 0.01);
    EXPECT_FALSE(pair_planes(a, b)[0].agrees({}));
    b.planes = {rectangle(1, {0, 0.5, 0}, 2, 1)};  // 1.5 m of 2.5 m in common
    EXPECT_NEAR(pair_planes(a, b)[0].iou, 0.6, 0.01);
    EXPECT_FALSE(pair_planes(a, b)[0].agrees({}));
}

TEST(MapAgreement, APartnerIsTakenOnceAndOppositeSidesAreNotTheSame) {
    PlaneMap a, b;
    a.planes = {rectangle(1, {0, 0, 0}, 2, 1), rectangle(2, {0, 0, 0.005}, 1, 1)};
    b.planes = {rectangle(5, {0, 0, 0}, 2, 1)};
    const auto pairs = pair_planes(a, b);
    EXPECT_EQ(pairs[0].id_b, 5);
    EXPECT_EQ(pairs[1].id_b, -1);
    EXPECT_FALSE(pairs[1].agrees({}));
    b.planes = {rectangle(5, {0, 0, 0}, 2, 1, 3.14159265358979)};
    EXPECT_EQ(pair_planes(a, b)[0].id_b, -1);
    EXPECT_EQ(pair_planes(a, {})[0].id_b, -1);
}

}  // namespace
}  // namespace planemap
