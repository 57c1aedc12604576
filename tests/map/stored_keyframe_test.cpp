// SPDX-License-Identifier: BSD-3-Clause
#include "map/stored_keyframe.hpp"

#include <gtest/gtest.h>

#include "core/wall_and_plate.hpp"

namespace planemap::map {
namespace {

using scene::two_regions;

TEST(StoredKeyframe, KeepsRegionsToAMicrometreAndOutlinesToAMillimetre) {
    const std::vector<PlanarRegion> regions = two_regions();
    const StoredKeyframe keyframe = stored(7, regions);
    ASSERT_EQ(keyframe.regions.size(), 2u);
    const Pose world_from_camera = scene::camera_at({12, -7, 3}, 0.8);
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const PlanarRegion expected = world_from_camera * regions[i];
        const PlacedRegion placed(world_from_camera, keyframe.regions[i]);
        EXPECT_LT(angle_between(placed.plane.normal, expected.plane.normal), 1e-6);
        EXPECT_NEAR(placed.plane.d, expected.plane.d, 1e-5);
        EXPECT_EQ(placed.moments.count, expected.moments.count);
        EXPECT_LT((placed.moments.mean() - expected.moments.mean()).norm(), 1e-6);
        EXPECT_LT((placed.moments.covariance() - expected.moments.covariance()).norm(), 1e-6);
        FlatPolygon polygon;
        outline_in(Pose::Identity(), keyframe.regions[i], keyframe, polygon);
        ASSERT_EQ(polygon.ring_ends.size(), regions[i].outline.rings.size());
        std::size_t k = 0;
        for (const Ring& ring : regions[i].outline.rings) {
            for (const Eigen::Vector2d& v : ring) {
                const Eigen::Vector3d there =
                    placed.box.frame_from_box *
                    Eigen::Vector3d(polygon.vertices[k].x(), polygon.vertices[k].y(), 0);
                const Eigen::Vector3d expected_at =
                    expected.box.frame_from_box * Eigen::Vector3d(v.x(), v.y(), 0);
                const Eigen::Vector3d apart = there - expected_at;
                EXPECT_LT((apart - apart.dot(placed.plane.normal) * placed.plane.normal).norm(), 0.001);
                ++k;
            }
        }
    }
}

TEST(StoredKeyframe, ARegionTakesAtMost112BytesAnd4AVertex) {
    EXPECT_LE(sizeof(StoredRegion), 112u);
    const StoredKeyframe keyframe = stored(7, two_regions());
    EXPECT_EQ(keyframe.vertices.size(), 2 * 12 + 3u) << "three rings of four vertices";
}

}  // namespace
}  // namespace planemap::map
