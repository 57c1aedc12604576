// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "core/geometry/angle.hpp"
#include "segmentation/scene.hpp"

namespace planemap::segmentation {
namespace {

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
        EXPECT_LT(angle_between(wall.plane.normal, truth.normal), radians(0.1));
        EXPECT_NEAR(wall.plane.d, truth.d, 0.002 * truth.d);
        EXPECT_GT(wall.moments.count, 0.97 * static_cast<double>(depth.pixels.size()));
        EXPECT_EQ(wall.outline.rings.size(), 1u);
    }
}

TEST(CellsTest, BoxOnAFloorIsThreePlanes) {
    const CameraInfo camera = scene::camera();
    // Looking down at the floor by 40 degrees; the box stands on it.
    const Eigen::Matrix3d view = Eigen::AngleAxisd(radians(40), Eigen::Vector3d::UnitX()).toRotationMatrix();
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
        EXPECT_LT(angle_between(fit_plane(expected).plane.normal, region.plane.normal), radians(1));
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

/// Walls, a box in front with a sloping top, a pillar, holes and dust.
DepthImage crowded(const CameraInfo& camera, std::uint64_t seed) {
    const auto box = [](const Eigen::Vector3d& p) { return std::abs(p.x()) < 0.35 && p.y() > 0.1; };
    const auto shelf = [](const Eigen::Vector3d& p) { return p.x() > 0.2 && std::abs(p.y() + 0.3) < 0.15; };
    DepthImage depth = scene::render(
        camera,
        {scene::plane(scene::tilted(0.1, 0.8, {0, 0, 2.5})),
         scene::plane(scene::tilted(0.1, -0.7, {0, 0, 2.5})),
         scene::plane(scene::tilted(0.4, 0.1, {0, 0.4, 1.5}), box),
         scene::plane(scene::tilted(0, 0, {0, 0, 1.7}), shelf), scene::cylinder(-0.5, 1.6, 0.12)},
        true, seed);
    std::mt19937_64 random(seed);
    for (std::uint16_t& raw : depth.pixels) {
        if (random() % 40 == 0) raw = static_cast<std::uint16_t>(random() % 2 == 0 ? 0 : random());
    }
    for (int v = depth.height / 8; v < depth.height / 4; ++v)
        std::fill_n(depth.row(v) + depth.width / 3, depth.width / 6, std::uint16_t{65535});
    return depth;
}

void expect_same_bits(const Segmentation& a, const Segmentation& b) {
    ASSERT_EQ(a.labels.width, b.labels.width);
    ASSERT_EQ(a.labels.pixels, b.labels.pixels);
    ASSERT_EQ(a.regions.size(), b.regions.size());
    for (std::size_t i = 0; i < a.regions.size(); ++i) {
        const PlanarRegion &r = a.regions[i], &s = b.regions[i];
        EXPECT_EQ(r.plane.normal, s.plane.normal);
        EXPECT_EQ(r.plane.d, s.plane.d);
        EXPECT_EQ(r.moments.count, s.moments.count);
        EXPECT_EQ(r.moments.sum, s.moments.sum);
        EXPECT_EQ(r.moments.scatter, s.moments.scatter);
        EXPECT_EQ(r.rms, s.rms);
        EXPECT_EQ(r.box.frame_from_box.matrix(), s.box.frame_from_box.matrix());
        EXPECT_EQ(r.box.half_extents, s.box.half_extents);
        EXPECT_EQ(r.outline.rings, s.outline.rings);
    }
}

TEST(CellsTest, AllKernelsGiveTheVerySameRegions) {
    const CellKernels* avx2 = avx2_cell_kernels();
    for (const auto& [width, height] : std::vector<std::pair<int, int>>{
             {640, 480}, {641, 479}, {320, 240}, {1280, 720}, {333, 77}, {9, 9}, {8, 8}, {1, 1}}) {
        const CameraInfo camera = scene::camera(width, height);
        for (const std::uint64_t seed : {1u, 2u}) {
            const DepthImage depth = crowded(camera, seed);
            Segmentation portable, baseline, fast;
            make_cell_segmenter(CellOptions{}, portable_cell_kernels())->segment(depth, camera, portable);
            make_cell_segmenter(CellOptions{}, baseline_cell_kernels())->segment(depth, camera, baseline);
            expect_same_bits(portable, baseline);
            if (width >= 320) {
                EXPECT_GE(portable.regions.size(), width == 333 ? 1u : 3u) << width;
            }
            if (avx2 == nullptr) continue;
            make_cell_segmenter(CellOptions{}, *avx2)->segment(depth, camera, fast);
            expect_same_bits(portable, fast);
        }
    }
}

TEST(CellsTest, AnImageTakesNothingFromTheOneBefore) {
    // Sizes, and with them paddings, in turn.
    const auto segmenter = make_cell_segmenter(CellOptions{});
    Segmentation reused;
    for (const auto& [width, height] :
         std::vector<std::pair<int, int>>{{640, 480}, {9, 9}, {641, 479}, {1, 1}, {320, 240}, {641, 479}}) {
        const CameraInfo camera = scene::camera(width, height);
        const DepthImage depth = crowded(camera, 3);
        segmenter->segment(depth, camera, reused);
        expect_same_bits(reused, segment(depth, camera));
    }
}

TEST(CellsTest, NoiseOfTheSensorDecidesWhatIsOnePlane) {
    // A step of 3 cm at 2 m is 5 sigma of a Kinect, and less than 2 of a sensor five times as noisy.
    CameraInfo camera = scene::camera();
    const auto left = [](const Eigen::Vector3d& p) { return p.x() < 0; };
    const DepthImage depth = scene::render(
        camera,
        {scene::plane(scene::tilted(0, 0, {0, 0, 2.03})), scene::plane(scene::tilted(0, 0, {0, 0, 2}), left)},
        true);
    EXPECT_EQ(segment(depth, camera).regions.size(), 2u);
    camera.noise.base_m *= 5;
    camera.noise.quadratic_per_m *= 5;
    EXPECT_EQ(segment(depth, camera).regions.size(), 1u);
}

TEST(CellsTest, NoiseOfTheSensorDecidesWhichCellsAreFlat) {
    // Noise of 2 cm at 2 m: nothing to a Kinect, a wall to a sensor that is so.
    CameraInfo camera = scene::camera();
    const Plane wall = scene::tilted(0.1, 0.2, {0, 0, 2});
    DepthImage depth = scene::render(camera, {scene::plane(wall)});
    std::mt19937_64 random(5);
    std::normal_distribution<double> noise(0, 20);
    for (std::uint16_t& raw : depth.pixels)
        raw = static_cast<std::uint16_t>(raw + std::lround(noise(random)));
    EXPECT_LT(scene::labelled_share(segment(depth, camera)), 0.1);
    camera.noise.base_m *= 5;
    camera.noise.quadratic_per_m *= 5;
    const Segmentation out = segment(depth, camera);
    ASSERT_EQ(out.regions.size(), 1u);
    EXPECT_LT(angle_between(out.regions[0].plane.normal, wall.normal), radians(0.5));
    EXPECT_GT(scene::labelled_share(out), 0.9);
}

TEST(CellsTest, RangeOfTheSensorDecidesWhatCounts) {
    CameraInfo camera = scene::camera();
    const Plane near = scene::tilted(0, 0, {0, 0, 1}), far = scene::tilted(0, 0, {0, 0, 3});
    const auto left = [](const Eigen::Vector3d& p) { return p.x() < 0; };
    const DepthImage depth = scene::render(camera, {scene::plane(far), scene::plane(near, left)}, true);
    struct Case {
        double min_m, max_m;
        bool near, far;
    };
    for (const Case& c :
         {Case{0.3, 8, true, true}, {0.3, 2, true, false}, {2, 8, false, true}, {4, 8, false, false}}) {
        camera.depth_min_m = c.min_m;
        camera.depth_max_m = c.max_m;
        const Segmentation out = segment(depth, camera);
        EXPECT_EQ(out.regions.size(), std::size_t{c.near} + std::size_t{c.far});
        EXPECT_EQ(scene::find(out, near) != nullptr, c.near);
        EXPECT_EQ(scene::find(out, far) != nullptr, c.far);
        EXPECT_EQ(label_at(out, 0.2, 0.5) != 0, c.near);
        EXPECT_EQ(label_at(out, 0.8, 0.5) != 0, c.far);
    }
}

TEST(CellsTest, UnitsOfTheSensorChangeOnlyTheirRounding) {
    CameraInfo camera = scene::camera();
    const Plane wall = scene::tilted(0.1, 0.3, {0, 0, 2});
    for (const double units : {500.0, 1000.0, 5000.0, 10000.0}) {
        camera.depth_units_per_metre = units;
        const Segmentation out = segment(scene::render(camera, {scene::plane(wall)}, true), camera);
        ASSERT_EQ(out.regions.size(), 1u) << units;
        EXPECT_NE(scene::find(out, wall, 0.1, 0.005), nullptr) << units;
    }
}

TEST(CellsTest, RefusesBadOptions) {
    CellOptions options;
    options.thickness_m = 0;
    EXPECT_THROW(make_cell_segmenter(options), std::invalid_argument);
    options = {};
    options.min_region_fraction = std::nan("");
    EXPECT_THROW(make_cell_segmenter(options), std::invalid_argument);
    options = {};
    options.grow_sigmas = -1;
    EXPECT_THROW(make_cell_segmenter(options), std::invalid_argument);
    options = {};
    options.merge_angle_deg = 90;
    EXPECT_THROW(make_cell_segmenter(options), std::invalid_argument);
}

}  // namespace
}  // namespace planemap::segmentation
