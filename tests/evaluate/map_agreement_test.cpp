// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/map_agreement.hpp"

#include <gtest/gtest.h>

namespace planemap::test {
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
    const int partners[] = {8, 9, 7};
    for (std::size_t i = 0; i < 3; ++i) {
        const Agreement agreement = best_agreement(a.planes[i], b);
        EXPECT_EQ(agreement.id_b, partners[i]);
        EXPECT_GT(agreement.iou, 0.99);
        EXPECT_TRUE(agreement.is_within({}));
    }
}

TEST(MapAgreement, MeasuresWhatDiffers) {
    const MapPlane plane = rectangle(1, {0, 0, 0}, 2, 1);
    PlaneMap other;
    other.planes = {rectangle(1, {0, 0, 0.02}, 2, 1)};
    EXPECT_NEAR(best_agreement(plane, other).distance_m, 0.02, 1e-4);
    EXPECT_FALSE(best_agreement(plane, other).is_within({}));
    other.planes = {rectangle(1, {0, 0, 0}, 2, 1, 0.02)};
    EXPECT_NEAR(best_agreement(plane, other).angle_deg, 1.146, 0.01);
    EXPECT_FALSE(best_agreement(plane, other).is_within({}));
    other.planes = {rectangle(1, {0, 0.5, 0}, 2, 1)};  // 1.5 m of 2.5 m in common
    EXPECT_NEAR(best_agreement(plane, other).iou, 0.6, 0.01);
    EXPECT_FALSE(best_agreement(plane, other).is_within({}));
}

TEST(MapAgreement, ThePartnerIsTheOneWithMostInCommonAndOppositeSidesAreNotTheSame) {
    const MapPlane plane = rectangle(1, {0, 0, 0}, 2, 1);
    PlaneMap other;
    other.planes = {rectangle(4, {0, 0, 0}, 1, 1), rectangle(5, {0, 0, 0.005}, 2, 1)};
    EXPECT_EQ(best_agreement(plane, other).id_b, 5);
    other.planes = {rectangle(5, {0, 0, 0}, 2, 1, 3.14159265358979)};
    EXPECT_EQ(best_agreement(plane, other).id_b, -1);
    EXPECT_FALSE(best_agreement(plane, {}).is_within({}));
}

}  // namespace
}  // namespace planemap::test
