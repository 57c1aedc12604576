// SPDX-License-Identifier: BSD-3-Clause
#include "map/stored_keyframe.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/scene.hpp"

namespace planemap::map {
namespace {

using scene::facing;
using scene::Rectangle;

/// A wall of 2 x 1 m three metres ahead, with a hole, a little turned, and a small plate a metre before it.
std::vector<PlanarRegion> two_regions() {
    const Rectangle wall{
        facing({0, 0, 3}, {0.2, 0.1, -1}, {1, 0, 0}), 1, 0.5, {scene::rectangle_ring(-0.3, -0.2, 0.1, 0.2)}};
    const Rectangle plate{facing({0.5, 0.1, 2}, {0, 0, -1}, {1, 0, 0}), 0.25, 0.2, {}};
    return {scene::region_of(wall, Pose::Identity(), 0.02, 0.004),
            scene::region_of(plate, Pose::Identity(), 0.02, 0.004)};
}

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

TEST(StoredKeyframe, ARegionTakesAtMost96BytesAnd4AVertex) {
    EXPECT_LE(sizeof(StoredRegion), 96u);
    const StoredKeyframe keyframe = stored(7, two_regions());
    EXPECT_EQ(keyframe.vertices.size(), 2 * 12 + 3u) << "three rings of four vertices";
}

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

}  // namespace
}  // namespace planemap::map
