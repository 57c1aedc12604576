// SPDX-License-Identifier: BSD-3-Clause
#include "core/geometry/outline_frame.hpp"

#include <gtest/gtest.h>

#include "core/scene.hpp"

namespace planemap {
namespace {

using scene::rectangle_ring;

Pose pose(const Eigen::Vector3d& translation, double angle, const Eigen::Vector3d& axis) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
    pose.translation() = translation;
    return pose;
}

TEST(Projected, WithinAPlaneAnOutlineKeepsItsArea) {
    const Outline outline{{rectangle_ring(0, 0, 2, 1), rectangle_ring(0.5, 0.25, 1, 0.75)}};
    const Pose b_from_a = pose({3, -2, 7}, 0.8, Eigen::Vector3d::UnitZ());
    const Outline turned = projected(b_from_a, outline);
    ASSERT_EQ(turned.rings.size(), 2u);
    EXPECT_NEAR(area(turned), area(outline), 1e-12);
    const Outline back = projected(b_from_a.inverse(Eigen::Isometry), turned);
    for (std::size_t r = 0; r < 2; ++r)
        for (std::size_t i = 0; i < 4; ++i) EXPECT_LT((back.rings[r][i] - outline.rings[r][i]).norm(), 1e-12);
}

TEST(Projected, ATiltedOutlineIsForeshortenedByItsCosine) {
    const Outline outline{{rectangle_ring(-1, -1, 1, 1)}};
    const Outline tilted = projected(pose({0, 0, 5}, 0.6, Eigen::Vector3d::UnitX()), outline);
    EXPECT_NEAR(area(tilted), 4 * std::cos(0.6), 1e-12);
    EXPECT_NEAR(bounds(tilted).sizes().x(), 2, 1e-12);
    EXPECT_TRUE(projected(Pose::Identity(), {}).empty());
}

TEST(Bounds, HoldAllVerticesAndNoMore) {
    const Outline outline{{rectangle_ring(1, 2, 3, 5), rectangle_ring(-4, 2.5, 0, 3)}};
    FlatPolygon polygon;
    polygon.assign(outline);
    for (const Eigen::AlignedBox2d& box : {bounds(outline), bounds(polygon)}) {
        EXPECT_EQ(box.min(), Eigen::Vector2d(-4, 2));
        EXPECT_EQ(box.max(), Eigen::Vector2d(3, 5));
    }
    EXPECT_TRUE(bounds(Outline()).isEmpty());
    EXPECT_TRUE(bounds(FlatPolygon()).isEmpty());
    EXPECT_TRUE(bounds(Outline{{Ring()}}).isEmpty());
}

}  // namespace
}  // namespace planemap
