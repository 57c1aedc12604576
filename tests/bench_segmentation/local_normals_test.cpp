// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/local_normals.hpp"

#include <gtest/gtest.h>

#include "bench_segmentation/two_walls.hpp"
#include "core/geometry/angle.hpp"

namespace planemap::bench {
namespace {

double angle_deg(const Eigen::Vector3f& a, const Eigen::Vector3d& b) {
    return degrees(angle_between(a.cast<double>(), b));
}

TEST(LocalNormals, AreThoseOfThePlaneWhateverItsTilt) {
    const CameraInfo camera = scene::camera(160, 120);
    for (const double about_x : {-0.8, 0.0, 0.6}) {
        for (const double about_y : {-0.7, 0.2}) {
            const Plane plane = scene::tilted(about_x, about_y, {0.1, -0.1, 1.5});
            const DepthImage depth = scene::render(camera, {scene::plane(plane)});
            const auto normals = local_normals(depth, camera);
            for (int v = 8; v < depth.height - 8; v += 7) {  // in the corners windows are too small
                for (int u = 0; u < depth.width; u += 7) {
                    if (!is_trusted(depth(u, v), camera)) continue;
                    ASSERT_FALSE(normals(u, v).isZero()) << u << ' ' << v;
                    EXPECT_LT(angle_deg(normals(u, v), plane.normal), 2) << u << ' ' << v;
                }
            }
        }
    }
}

TEST(LocalNormals, DoNotDependOnWhatLiesOutsideTheWindow) {
    const CameraInfo camera = scene::camera(160, 120);
    const Plane plane = scene::tilted(0.3, -0.4, {0, 0, 1.2});
    const DepthImage whole = scene::render(camera, {scene::plane(plane)});
    DepthImage cut = whole;
    for (int v = 0; v < cut.height; ++v) {
        for (int u = 0; u < cut.width; ++u) {
            if (u < 80 - 8 || u > 80 + 8 || v < 60 - 8 || v > 60 + 8) cut(u, v) = u % 2 == 0 ? 0 : 4000;
        }
    }
    EXPECT_LT((local_normals(cut, camera)(80, 60) - local_normals(whole, camera)(80, 60)).norm(), 1e-5f);
}

TEST(LocalNormals, ThereAreNoneAcrossAnEdgeAStepOrAHole) {
    const CameraInfo camera = scene::camera();
    const auto left_half = [](const Eigen::Vector3d& p) { return p.x() < 0; };
    const DepthImage step = scene::render(camera, {scene::plane(scene::tilted(0, 0, {0, 0, 1}), left_half),
                                                   scene::plane(scene::tilted(0, 0, {0, 0, 1.2}))});
    const auto at_step = local_normals(step, camera);
    EXPECT_TRUE(at_step(319, 240).isZero());
    EXPECT_TRUE(at_step(322, 240).isZero());
    EXPECT_FALSE(at_step(340, 240).isZero());

    const DepthImage edge = scene::render(camera, {scene::plane(scene::tilted(0, 1, {0, 0, 1})),
                                                   scene::plane(scene::tilted(0, -1, {0, 0, 1}))});
    EXPECT_TRUE(local_normals(edge, camera)(320, 240).isZero());

    DepthImage hole = scene::render(camera, {scene::plane(scene::tilted(0, 0, {0, 0, 1}))});
    hole(100, 100) = 0;
    for (int v = 200; v < 260; ++v) {
        for (int u = 200; u < 260; ++u) hole(u, v) = u % 3 == 0 ? hole(u, v) : std::uint16_t{65535};
    }
    const auto around_holes = local_normals(hole, camera);
    EXPECT_TRUE(around_holes(100, 100).isZero()) << "no reading of its own";
    EXPECT_FALSE(around_holes(101, 100).isZero());
    EXPECT_TRUE(around_holes(231, 230).isZero()) << "a third of its window";
    EXPECT_FALSE(around_holes(270, 230).isZero());
}

TEST(LocalNormals, NothingForNothing) {
    const CameraInfo camera = scene::camera(20, 10);
    for (const Eigen::Vector3f& normal : local_normals(DepthImage(20, 10), camera).pixels)
        EXPECT_TRUE(normal.isZero());
    EXPECT_TRUE(local_normals(DepthImage(), camera).empty());
}

TEST(IsTrusted, KeepsToTheSensorsRange) {
    CameraInfo camera;
    camera.depth_min_m = 0.5;
    camera.depth_max_m = 4;
    EXPECT_FALSE(is_trusted(0, camera));
    EXPECT_FALSE(is_trusted(499, camera));
    EXPECT_TRUE(is_trusted(500, camera));
    EXPECT_TRUE(is_trusted(4000, camera));
    EXPECT_FALSE(is_trusted(4001, camera));
    camera.depth_max_m = 100;
    EXPECT_FALSE(is_trusted(65535, camera));
}

}  // namespace
}  // namespace planemap::bench
