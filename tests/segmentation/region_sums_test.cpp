// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/region_sums.hpp"

#include <gtest/gtest.h>

#include "segmentation/labelling.hpp"

namespace planemap::segmentation {
namespace {

TEST(RegionSummerTest, SumsAreThoseOfTheLabelledPixels) {
    DepthImage depth = wall();
    for (int u = 30; u < 50; ++u) depth(u, 40) = 0;  // cells in part
    const Labelling result(depth, [](int, int) { return true; });
    ASSERT_EQ(result.sums.size(), 1u);
    Moments expected;
    for (int v = 0; v < depth.height; ++v)
        for (int u = 0; u < depth.width; ++u)
            if (result.labels(u, v) == 1)
                expected.add(result.camera.depth.unproject(u, v, result.camera.metres(depth(u, v))));
    const Moments moments = result.sums[0].points.moments();
    EXPECT_EQ(moments.count, expected.count);
    EXPECT_LT((moments.sum - expected.sum).norm(), 1e-5 * expected.sum.norm());
    EXPECT_LT((moments.scatter - expected.scatter).norm(), 1e-5 * expected.scatter.norm());
    const Plane plane = result.sums[0].weighted.fit().plane.plane();
    EXPECT_LT(angle_between(plane.normal, kWall.normal), 1e-3);
    EXPECT_NEAR(plane.d, kWall.d, 1e-3);
}

}  // namespace
}  // namespace planemap::segmentation
