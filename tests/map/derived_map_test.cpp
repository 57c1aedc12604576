// SPDX-License-Identifier: BSD-3-Clause
#include "map/derived_map.hpp"

#include <gtest/gtest.h>

#include "map/estimates.hpp"

namespace planemap::map {
namespace {

using samples::drawn_estimate_of;
using samples::wall_at;

const std::map<int, Pose> kPoses{{0, Pose::Identity()}};

DerivedMap derived_map() {
    return {derivation_rules({}), adjacency_rules({}), inference_rules({})};
}

TEST(DerivedMap, HasThePlanesOfTheEstimatesByAscendingId) {
    DerivedMap derived = derived_map();
    std::vector<PlaneEstimate> estimates{drawn_estimate_of(wall_at(0, 0, 3), 8),
                                         drawn_estimate_of(wall_at(0, 0, 5), 2),
                                         drawn_estimate_of(wall_at(4, 0, 5, 0.05), 4)};
    derived.refresh(estimates, kPoses);
    ASSERT_EQ(derived.map().planes.size(), 2u) << "one is too small";
    EXPECT_EQ(derived.map().planes[0].id, 2);
    EXPECT_EQ(derived.map().planes[1].id, 8);
    for (const PlaneEstimate& estimate : estimates) EXPECT_FALSE(estimate.changed);
    estimates.erase(estimates.begin());
    derived.refresh(estimates, kPoses);
    ASSERT_EQ(derived.map().planes.size(), 1u);
    EXPECT_EQ(derived.map().planes[0].id, 2);
}

TEST(DerivedMap, WhatHardlyChangedKeepsItsOutlineAndMovesAlong) {
    DerivedMap derived = derived_map();
    std::vector<PlaneEstimate> estimates{drawn_estimate_of(wall_at(0, 0, 3), 0)};
    derived.refresh(estimates, kPoses);
    const MapPlane before = derived.map().planes[0];
    derived.refresh(estimates, kPoses);
    EXPECT_EQ(derived.map().planes[0].center, before.center) << "nothing changed";
    // 0.6 mm at a time: each second step is more than a millimetre from where the plane was drawn.
    for (int step = 1; step <= 4; ++step) {
        estimates[0].plane.d += 0.0006;
        estimates[0].changed = true;
        estimates[0].changed_cells = 1;
        derived.refresh(estimates, kPoses);
        EXPECT_NEAR(derived.map().planes[0].plane().d, estimates[0].plane.d, 1e-5);
        EXPECT_EQ(derived.map().planes[0].outline, before.outline);
        EXPECT_EQ(estimates[0].changed_cells, step % 2) << "drawn anew with the second step";
    }
}

TEST(DerivedMap, TimeDoesNotGoBack) {
    DerivedMap derived = derived_map();
    PlaneMap earlier;
    earlier.utime = 5;
    derived.start_from(earlier);
    derived.seen_at(9);
    derived.seen_at(7);
    EXPECT_EQ(derived.map().utime, 9);
    derived.set_revision(3);
    EXPECT_EQ(derived.map().revision, 3);
}

TEST(DerivedMap, TakesTheLabelsOfAnEarlierMapById) {
    DerivedMap derived = derived_map();
    std::vector<PlaneEstimate> estimates{drawn_estimate_of(wall_at(0, 0, 3), 1),
                                         drawn_estimate_of(wall_at(0, 0, 5), 2)};
    derived.refresh(estimates, {});
    PlaneMap earlier = derived.map();
    earlier.planes[1].label = PlaneLabel::kWall;
    earlier.planes.erase(earlier.planes.begin());
    const PlaneLabel before = derived.map().planes[0].label;
    derived.take_labels(earlier);
    EXPECT_EQ(derived.map().planes[0].label, before);
    EXPECT_EQ(derived.map().planes[1].label, PlaneLabel::kWall);
}

TEST(DerivedMap, KeepsTheUpOfTheMapToStartFromUntilItIsFound) {
    DerivedMap derived = derived_map();
    PlaneMap earlier;
    earlier.up = {0, 0, -1};
    derived.start_from(earlier);
    std::vector<PlaneEstimate> estimates{drawn_estimate_of(wall_at(0, 0, 3), 0)};
    const Pose aside(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitX()));
    derived.refresh(estimates, {{0, aside}});
    EXPECT_EQ(derived.map().up, earlier.up);
    EXPECT_EQ(derived.why_up(), "by the map to start from");
}

TEST(DerivedMap, WhatIsToldGoesBeforeWhatIsFoundAndAContradictionIsSaid) {
    DerivedMap derived = derived_map();
    std::vector<PlaneEstimate> estimates{drawn_estimate_of(wall_at(0, 0, 3), 0)};
    std::map<int, Pose> poses;  // of a camera that looks around
    for (int i = -5; i <= 5; ++i) poses[i + 5] = Pose(Eigen::AngleAxisd(0.2 * i, Eigen::Vector3d::UnitY()));
    derived.refresh(estimates, poses);
    EXPECT_LT((derived.map().up - Eigen::Vector3f(0, -1, 0)).norm(), 0.1f);
    EXPECT_EQ(derived.map().planes[0].label, PlaneLabel::kVertical);
    ToldUp told;
    for (const auto& [id, pose] : poses) {
        told.hear({1000000 * id, -9.8 * (pose.linear().transpose() * Eigen::Vector3d::UnitZ())});
        told.came(id, 1000000 * id);
    }
    derived.refresh(estimates, poses, told);
    EXPECT_LT((derived.map().up - Eigen::Vector3f(0, 0, -1)).norm(), 1e-5f);
    EXPECT_EQ(derived.map().planes[0].label, PlaneLabel::kFloor);
    EXPECT_EQ(derived.why_up(),
              "by the accelerometer; planes and motion say another direction, 90 deg off: is that how it is "
              "mounted?");
}

TEST(DerivedMap, OutlinesEndWherePlanesMeet) {
    DerivedMap derived = derived_map();
    // The wall's foot is 2 cm above the floor's plane, the floor goes 3 cm past the wall.
    const scene::Rectangle wall{scene::facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0}), 1, 0.98, {}};
    const scene::Rectangle floor{scene::facing({0, 1, 2}, {0, -1, 0}, {1, 0, 0}), 1, 1.03, {}};
    std::vector<PlaneEstimate> estimates{drawn_estimate_of(wall, 0), drawn_estimate_of(floor, 1)};
    derived.refresh(estimates, kPoses);
    const PlaneMap& map = derived.map();
    ASSERT_EQ(map.lines.size(), 1u);
    for (const MapPlane& plane : map.planes) {
        const Outline outline = plane.outline.rings();
        ASSERT_EQ(outline.vertex_count(), 4u);
        int on_line = 0;
        for (const Eigen::Vector2d& v : outline.rings[0]) {
            const Eigen::Vector3d p = plane.world_from_plane() * Eigen::Vector3d(v.x(), v.y(), 0);
            on_line += std::abs(p.y() - 1) < 0.002 && std::abs(p.z() - 3) < 0.002;
        }
        EXPECT_EQ(on_line, 2) << plane.id;
    }
    EXPECT_NEAR(map.planes[0].area, 2 * 1.98, 0.06);
    EXPECT_NEAR(map.planes[1].area, 2 * 2.03, 0.06);
}

TEST(DerivedMap, AnOutlineFollowsItsNeighboursAndIsFreeWithoutThem) {
    DerivedMap derived = derived_map();
    const scene::Rectangle wall{scene::facing({0, 0, 3}, {0, 0, -1}, {1, 0, 0}), 1, 0.98, {}};
    const scene::Rectangle floor{scene::facing({0, 1, 2}, {0, -1, 0}, {1, 0, 0}), 1, 1.03, {}};
    std::vector<PlaneEstimate> estimates{drawn_estimate_of(wall, 0), drawn_estimate_of(floor, 1)};
    derived.refresh(estimates, kPoses);
    const float met = derived.map().planes[1].area;
    estimates.erase(estimates.begin());
    derived.refresh(estimates, kPoses);
    ASSERT_EQ(derived.map().planes.size(), 1u);
    EXPECT_GT(derived.map().planes[0].area, met + 0.03F) << "as far as it was seen again";
}

TEST(DerivedMap, OfNothing) {
    DerivedMap derived = derived_map();
    std::vector<PlaneEstimate> none;
    derived.refresh(none, {});
    EXPECT_TRUE(derived.map().planes.empty());
    EXPECT_FALSE(derived.left_out_points());
}

}  // namespace
}  // namespace planemap::map
