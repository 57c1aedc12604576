// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cells.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "segmentation/scene.hpp"

namespace planemap {
namespace {

constexpr double kDegrees = std::numbers::pi / 180;

Segmentation segment(const DepthImage& depth, const CameraInfo& camera, const CellOptions& options = {}) {
    Segmentation out;
    make_cell_segmenter(options)->segment(depth, camera, out);
    return out;
}

/// The label at a point of the image given as shares of its width and height.
int label_at(const Segmentation& out, double x, double y) {
    return out.labels(static_cast<int>(x * out.labels.width), static_cast<int>(y * out.labels.height));
}

struct Wall {
    double about_x, about_y, distance;
};

class NoisyWall : public testing::TestWithParam<Wall> {};
INSTANTIATE_TEST_SUITE_P(Poses, NoisyWall,
                         testing::Values(Wall{0, 0, 1}, Wall{0, 0, 2}, Wall{0, 0, 3.5}, Wall{0.5, 0, 1.5},
                                         Wall{0, 0.7, 2}, Wall{-0.6, 0.4, 1.5}, Wall{0.05, 0.1, 3}));

TEST_P(NoisyWall, IsOneRegionWithTheRightPlane) {
    const CameraInfo camera = scene::camera();
    const Plane truth = scene::tilted(GetParam().about_x, GetParam().about_y, {0, 0, GetParam().distance});
    for (const std::uint64_t seed : {1u, 2u}) {
        const DepthImage depth = scene::render(camera, {scene::plane(truth)}, true, seed);
        const Segmentation out = segment(depth, camera);
        ASSERT_EQ(out.regions.size(), 1u);
        const PlanarRegion& wall = out.regions[0];
        EXPECT_LT(angle_between(wall.plane.normal, truth.normal), 0.1 * kDegrees);
        EXPECT_NEAR(wall.plane.d, truth.d, 0.002 * truth.d);
        EXPECT_GT(wall.moments.count, 0.97 * static_cast<double>(depth.pixels.size()));
        EXPECT_EQ(wall.outline.rings.size(), 1u);
    }
}

TEST(CellsTest, BoxOnAFloorIsThreePlanes) {
    const CameraInfo camera = scene::camera();
    // Looking down at the floor by 40 degrees; the box stands on it.
    const Eigen::Matrix3d view =
        Eigen::AngleAxisd(40 * kDegrees, Eigen::Vector3d::UnitX()).toRotationMatrix();
    const Eigen::Vector3d up = view * Eigen::Vector3d(0, -1, 0), towards = view * Eigen::Vector3d(0, 0, -1);
    const Eigen::Vector3d foot(0, 0.2, 2);  // middle of the front's lower edge
    const Plane floor{up, -up.dot(foot)}, top{up, -up.dot(foot + 0.4 * up)},
        front{towards, -towards.dot(foot)};
    const auto on_top = [&](const Eigen::Vector3d& p) {
        const double back = -towards.dot(p - foot);
        return std::abs(p.x()) < 0.4 && back > 0 && back < 0.5;
    };
    const auto on_front = [&](const Eigen::Vector3d& p) {
        const double height = up.dot(p - foot);
        return std::abs(p.x()) < 0.4 && height > 0 && height < 0.4;
    };
    const DepthImage depth = scene::render(
        camera, {scene::plane(floor), scene::plane(top, on_top), scene::plane(front, on_front)}, true);
    const Segmentation out = segment(depth, camera);
    ASSERT_EQ(out.regions.size(), 3u);
    for (const Plane& truth : {floor, top, front}) EXPECT_NE(scene::find(out, truth, 1, 0.01), nullptr);
    EXPECT_GT(scene::labelled_share(out), 0.93);
}

TEST(CellsTest, ParallelPlanesAStepApartStayTwo) {
    for (const double distance : {0.8, 1.5, 2.2}) {
        const CameraInfo camera = scene::camera();
        const Plane back = scene::tilted(0, 0, {0, 0, distance + 0.03}),
                    front = scene::tilted(0, 0, {0, 0, distance});
        const auto left = [](const Eigen::Vector3d& p) { return p.x() < 0; };
        const DepthImage depth = scene::render(camera, {scene::plane(back), scene::plane(front, left)}, true);
        const Segmentation out = segment(depth, camera);
        ASSERT_EQ(out.regions.size(), 2u) << distance;
        EXPECT_NE(label_at(out, 0.25, 0.5), label_at(out, 0.75, 0.5));
        EXPECT_NEAR(std::abs(out.regions[0].plane.d - out.regions[1].plane.d), 0.03, 0.005);
    }
}

TEST(CellsTest, OnePlaneBehindAThinPoleIsOneRegion) {
    const CameraInfo camera = scene::camera();
    const Plane wall = scene::tilted(0.1, 0.2, {0, 0, 2});
    const DepthImage depth = scene::render(camera, {scene::plane(wall), scene::cylinder(0, 1.2, 0.01)}, true);
    const Segmentation out = segment(depth, camera);
    ASSERT_EQ(out.regions.size(), 1u);
    EXPECT_EQ(label_at(out, 0.2, 0.5), 1);
    EXPECT_EQ(label_at(out, 0.8, 0.5), 1);
}

TEST(CellsTest, CurvedSurfacesAreNotPlanes) {
    const CameraInfo camera = scene::camera();
    for (const bool noise : {false, true}) {
        for (const double radius : {0.15, 0.3}) {
            const DepthImage pillar =
                scene::render(camera, {scene::cylinder(0, 1.2 + radius, radius)}, noise);
            EXPECT_LT(scene::labelled_share(segment(pillar, camera)), 0.1) << "cylinder " << radius;
            const DepthImage ball =
                scene::render(camera, {scene::sphere({0, 0, 1.2 + radius}, radius)}, noise);
            EXPECT_LT(scene::labelled_share(segment(ball, camera)), 0.1) << "sphere " << radius;
        }
    }
}

TEST(CellsTest, AWallBesideAPillarIsStillFound) {
    const CameraInfo camera = scene::camera();
    const Plane wall = scene::tilted(0, 0, {0, 0, 2.5});
    const DepthImage depth =
        scene::render(camera, {scene::plane(wall), scene::cylinder(0.2, 1.5, 0.25)}, true);
    const Segmentation out = segment(depth, camera);
    EXPECT_NE(scene::find(out, wall, 0.5, 0.01), nullptr);
}

TEST(CellsTest, MomentsAreThoseOfTheLabelledPixels) {
    const CameraInfo camera = scene::camera(641, 479);
    const DepthImage depth = scene::render(
        camera,
        {scene::plane(scene::tilted(0.1, 0.8, {0, 0, 2})), scene::plane(scene::tilted(0.1, -0.7, {0, 0, 2}))},
        true);
    const Segmentation out = segment(depth, camera);
    ASSERT_GE(out.regions.size(), 2u);
    for (std::size_t i = 0; i < out.regions.size(); ++i) {
        const PlanarRegion& region = out.regions[i];
        const Moments expected =
            scene::brute_force_moments(depth, camera, out.labels, static_cast<std::uint16_t>(i + 1));
        EXPECT_EQ(region.moments.count, expected.count);
        EXPECT_LT((region.moments.sum - expected.sum).norm(), 1e-6 * expected.sum.norm());
        EXPECT_LT((region.moments.scatter - expected.scatter).norm(), 1e-6 * expected.scatter.norm());
        EXPECT_LT(angle_between(fit_plane(expected).plane.normal, region.plane.normal), 1 * kDegrees);
        EXPECT_NEAR(region.rms, fit_plane(expected).rms, 0.1 * region.rms);
    }
}

TEST(CellsTest, HolesInASurfaceAreHolesInItsOutline) {
    const CameraInfo camera = scene::camera();
    DepthImage depth = scene::render(camera, {scene::plane(scene::tilted(0, 0.3, {0, 0, 2}))}, true);
    for (int v = 180; v < 300; ++v) std::fill_n(depth.row(v) + 240, 160, std::uint16_t{0});
    const Segmentation out = segment(depth, camera);
    ASSERT_EQ(out.regions.size(), 1u);
    EXPECT_EQ(out.regions[0].outline.rings.size(), 2u);
}

TEST(CellsTest, SmallestRegionIsAShareOfTheImage) {
    const Plane wall = scene::tilted(0, 0, {0, 0, 2});
    const auto patch = [](const Eigen::Vector3d& p) {
        return std::abs(p.x()) < 0.2 && std::abs(p.y()) < 0.2;
    };
    for (const int width : {320, 640, 1280}) {
        const CameraInfo camera = scene::camera(width, width * 3 / 4);
        const DepthImage depth = scene::render(camera, {scene::plane(wall, patch)});
        const double share = 0.17 * 0.17 * 4 / 3;  // about 0.173 of the width each way
        CellOptions options;
        options.min_region_fraction = 0.5 * share;
        EXPECT_EQ(segment(depth, camera, options).regions.size(), 1u) << width;
        options.min_region_fraction = 2 * share;
        EXPECT_EQ(segment(depth, camera, options).regions.size(), 0u) << width;
    }
}

TEST(CellsTest, PlaneIsWeightedByNoiseButMomentsAreNot) {
    // Half of the wall lies far away, where the noise is high: the fit must follow the near half.
    const CameraInfo camera = scene::camera();
    const Plane wall = scene::tilted(0, 1.1, {0, 0, 2.2});
    double weighted = 0, unweighted = 0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const DepthImage depth = scene::render(camera, {scene::plane(wall)}, true, seed);
        const Segmentation out = segment(depth, camera);
        ASSERT_GE(out.regions.size(), 1u);
        weighted += angle_between(out.regions[0].plane.normal, wall.normal);
        unweighted += angle_between(fit_plane(out.regions[0].moments).plane.normal, wall.normal);
    }
    EXPECT_LT(weighted, unweighted);
}

TEST(CellsTest, RefusesBadOptions) {
    CellOptions options;
    options.thickness_m = 0;
    EXPECT_THROW(make_cell_segmenter(options), std::invalid_argument);
    options = {};
    options.min_fill = std::nan("");
    EXPECT_THROW(make_cell_segmenter(options), std::invalid_argument);
    options = {};
    options.lateral_px = -1;
    EXPECT_THROW(make_cell_segmenter(options), std::invalid_argument);
    options = {};
    options.merge_angle_deg = 90;
    EXPECT_THROW(make_cell_segmenter(options), std::invalid_argument);
}

}  // namespace
}  // namespace planemap
