// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/shape.hpp"

#include <gtest/gtest.h>

#include <random>

#include "segmentation/scene.hpp"

namespace planemap {
namespace {

/// A region whose pixels, all exactly on the plane, are those of label 1.
struct Labelled {
    Labelled(const Plane& plane, const std::function<bool(int, int)>& holds, int width = 640,
             int height = 480)
        : camera(scene::camera(width, height)), labels(width, height), regions(1) {
        camera.depth_units_per_metre = 10000;
        const DepthImage depth = scene::render(camera, {scene::plane(plane)});
        for (int v = 0; v < height; ++v) {
            for (int u = 0; u < width; ++u) {
                if (!holds(u, v)) continue;
                labels(u, v) = 1;
                const double z = camera.metres(depth(u, v));
                points.push_back(camera.depth.unproject(u, v, z));
                regions[0].moments.add(points.back());
                // A pixel's share of the plane: its solid angle's footprint.
                const Eigen::Vector3d ray = camera.depth.unproject(u, v, 1);
                true_area += z * z / (camera.depth.fx * camera.depth.fy) / std::abs(plane.normal.dot(ray));
            }
        }
        regions[0].plane = plane;
        ShapeTracer().trace_all(labels, camera, regions);
    }

    double share_inside_outline() const {
        const Pose box_from_camera = regions[0].box.frame_from_box.inverse();
        double inside = 0;
        for (const auto& p : points) inside += contains(regions[0].outline, (box_from_camera * p).head<2>());
        return inside / static_cast<double>(points.size());
    }
    double share_inside_box() const {
        const Pose box_from_camera = regions[0].box.frame_from_box.inverse();
        double inside = 0;
        for (const auto& p : points) {
            const Eigen::Vector2d q = (box_from_camera * p).head<2>().cwiseAbs();
            inside += (q.array() <= regions[0].box.half_extents.head<2>().array()).all();
        }
        return inside / static_cast<double>(points.size());
    }

    CameraInfo camera;
    Image<std::uint16_t> labels;
    std::vector<PlanarRegion> regions;
    std::vector<Eigen::Vector3d> points;
    double true_area = 0;
};

void expect_close_fit(const Labelled& l) {
    ASSERT_TRUE(is_valid(l.regions[0]));
    EXPECT_NEAR(area(l.regions[0].outline), l.true_area, 0.03 * l.true_area);
    EXPECT_GT(l.share_inside_outline(), 0.98);
    EXPECT_GT(l.share_inside_box(), 0.98);
}

const Plane kSlanted = scene::tilted(0.3, 0.5, {0, 0, 2});

TEST(ShapeTest, WholeImage) {
    expect_close_fit({kSlanted, [](int, int) { return true; }});
}

TEST(ShapeTest, Disc) {
    const Labelled disc(kSlanted, [](int u, int v) { return std::hypot(u - 300, v - 200) < 120; });
    expect_close_fit(disc);
    ASSERT_EQ(disc.regions[0].outline.rings.size(), 1u);
    EXPECT_GT(signed_area(disc.regions[0].outline.rings[0]), 0);  // counter-clockwise about the normal
    EXPECT_LT(disc.regions[0].outline.vertex_count(), 100u);
}

TEST(ShapeTest, RingHasAHole) {
    const Labelled ring(kSlanted, [](int u, int v) {
        const double r = std::hypot(u - 300, v - 200);
        return r > 60 && r < 150;
    });
    expect_close_fit(ring);
    EXPECT_EQ(ring.regions[0].outline.rings.size(), 2u);
}

TEST(ShapeTest, SeparateParts) {
    const Labelled parts(kSlanted, [](int u, int) { return u % 100 < 60; });
    expect_close_fit(parts);
    EXPECT_GE(parts.regions[0].outline.rings.size(), 6u);
}

TEST(ShapeTest, OddSizes) {
    for (const auto& [width, height] : std::vector<std::pair<int, int>>{{641, 479}, {1280, 720}, {333, 77}}) {
        expect_close_fit(
            {kSlanted, [=](int u, int v) { return u > width / 4 && v < height * 3 / 4; }, width, height});
    }
}

TEST(ShapeTest, LongAxisOfTheBoxIsTheRegions) {
    const Labelled bar(scene::tilted(0, 0, {0, 0, 2}),
                       [](int u, int v) { return std::abs(u - v - 60) < 20; });
    EXPECT_NEAR(std::abs(bar.regions[0].box.frame_from_box.linear().col(0).dot(
                    Eigen::Vector3d(1, 1, 0).normalized())),
                1, 0.01);
    EXPECT_GT(bar.regions[0].box.half_extents.x(), 5 * bar.regions[0].box.half_extents.y());
}

TEST(ShapeTest, ScatteredPixelsDoNotMakeAnInvalidRegion) {
    std::mt19937_64 random(3);
    std::bernoulli_distribution coin(0.3);
    const Labelled dust(
        kSlanted, [&](int, int) { return coin(random); }, 100, 80);
    EXPECT_TRUE(is_valid(dust.regions[0]));
    const Labelled few(kSlanted, [](int u, int v) { return u == 600 && v % 100 == 3; });
    EXPECT_TRUE(is_valid(few.regions[0]));
    EXPECT_TRUE(few.regions[0].outline.empty());
}

TEST(ShapeTest, CornersBeyondTheHorizonAreNoFartherThanReadings) {
    CameraInfo camera = scene::camera(64, 48);
    camera.depth_max_m = 1e308;
    std::vector<PlanarRegion> regions(1);
    regions[0].plane = {{0, -1, 0}, 1};  // a floor, which the upper half of the image does not see
    for (const double x : {-1, 0, 1}) {
        for (const double z : {2, 3}) regions[0].moments.add({x, 1, z});
    }
    ShapeTracer().trace_all(Image<std::uint16_t>(64, 48, 1), camera, regions);
    EXPECT_TRUE(is_valid(regions[0]));
    EXPECT_LT(regions[0].box.half_extents.maxCoeff(), 2 * 65.5);
}

TEST(DepthRangeTest, KeepsWithin16BitsAndOffInvalidValues) {
    CameraInfo camera = scene::camera(8, 8);
    camera.depth_min_m = 0;
    camera.depth_max_m = 1000;
    const DepthRange all(camera);
    EXPECT_FALSE(all.contains(0));
    EXPECT_TRUE(all.contains(1));
    EXPECT_TRUE(all.contains(65534));
    EXPECT_FALSE(all.contains(65535));
    camera.depth_min_m = 0.5;
    camera.depth_max_m = 4;
    const DepthRange some(camera);
    EXPECT_FALSE(some.contains(499));
    EXPECT_TRUE(some.contains(500));
    EXPECT_TRUE(some.contains(4000));
    EXPECT_FALSE(some.contains(4001));
}

}  // namespace
}  // namespace planemap
