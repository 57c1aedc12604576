// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/table1.hpp"

#include <gtest/gtest.h>

namespace planemap::bench {
namespace {

TEST(WallScene, TheWallIsLargestAndAsFarAwayAsSaid) {
    const CameraInfo camera = kinect_camera();
    for (const double distance : {1.5, 2.5, 3.5}) {
        const BenchFrame frame = wall_scene(distance, 2, camera);
        ASSERT_TRUE(frame.truth);
        double most = 0;
        Plane wall;
        for (const TruePiece& piece : frame.truth->pieces) {
            if (piece.pixels > most) wall = piece.plane;
            most = std::max(most, piece.pixels);
        }
        EXPECT_NEAR(wall.d, distance, 1e-6);
        EXPECT_GT(most, 640 * 480 / 2);
        EXPECT_GT(frame.truth->pieces.size(), 1u) << "the box is in view";
    }
}

TEST(Table1, CellsMeasureTheWall) {
    const CameraInfo camera = kinect_camera();
    const std::vector<BenchFrame> frames{wall_scene(1.5, 1, camera), wall_scene(1.5, 2, camera)};
    for (const int step : {1, 4}) {
        const Table1Row row = measure_table1({"cells", step}, 1.5, frames, camera);
        EXPECT_GT(row.seconds, 0);
        EXPECT_NEAR(row.estimated_distance_m, 1.5, 0.01);
        EXPECT_GT(row.inliers, 150000 / (step * step)) << "counted in subsampled pixels";
        EXPECT_LT(row.inliers, 307200 / (step * step));
        EXPECT_LT(row.false_planes, 1);
    }
}

}  // namespace
}  // namespace planemap::bench
