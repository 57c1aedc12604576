// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/ransac.hpp"

#include <gtest/gtest.h>

#include "segmentation/scene.hpp"

namespace planemap::segmentation {
namespace {

/// Four walls around the optical axis, so that there is one more than the paper's three.
DepthImage room(const CameraInfo& camera) {
    return scene::render(camera,
                         {scene::plane({{0, 0, -1}, 3}), scene::plane({{1, 0, 0}, 1}),
                          scene::plane({{-1, 0, 0}, 1}), scene::plane({{0, -1, 0}, 0.8})},
                         true);
}

Segmentation segment(const DepthImage& depth, const CameraInfo& camera, const RansacOptions& options,
                     std::uint64_t seed = 1) {
    Segmentation out;
    make_ransac_segmenter(options, seed)->segment(depth, camera, out);
    return out;
}

TEST(RansacTest, KeepsTheLargestPlanes) {
    const CameraInfo camera = scene::camera();
    const DepthImage depth = room(camera);
    RansacOptions options;
    for (const int planes : {1, 2, 3}) {
        options.max_planes = planes;
        EXPECT_EQ(segment(depth, camera, options).regions.size(), static_cast<std::size_t>(planes));
    }
}

TEST(RansacTest, CountsSubsampledPoints) {
    const CameraInfo camera = scene::camera();
    const DepthImage depth = scene::render(camera, {scene::plane({{0, 0, -1}, 1.5})});
    RansacOptions options;
    for (const int step : {1, 2, 4}) {
        options.subsampling = step;
        const Segmentation out = segment(depth, camera, options);
        ASSERT_EQ(out.regions.size(), 1u);
        EXPECT_EQ(out.regions[0].moments.count, 640.0 / step * 480 / step);
        EXPECT_EQ(scene::labelled_share(out), 1);
        EXPECT_NEAR(out.regions[0].plane.d, 1.5, 1e-3);
    }
    options.subsampling = 4;
    options.min_inliers = 640 * 480 / 16;
    EXPECT_EQ(segment(depth, camera, options).regions.size(), 1u);
    options.min_inliers += 1;
    EXPECT_TRUE(segment(depth, camera, options).regions.empty());
}

TEST(RansacTest, InliersLieWithinTheThickness) {
    const CameraInfo camera = scene::camera();
    const DepthImage depth = room(camera);
    RansacOptions options;
    options.subsampling = 2;
    const Segmentation out = segment(depth, camera, options);
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            if (out.labels(u, v) == 0) continue;
            const Plane& plane = out.regions[out.labels(u, v) - 1u].plane;
            const Eigen::Vector3d p = camera.depth.unproject(u, v, camera.metres(depth(u, v)));
            // The thickness counts from RANSAC's plane; the region's is fitted to its inliers after that.
            ASSERT_LE(std::abs(plane.signed_distance(p)), 1.5 * options.thickness_m);
        }
    }
}

TEST(RansacTest, SeedDecides) {
    const CameraInfo camera = scene::camera(320, 240);
    const DepthImage depth = room(camera);
    const RansacOptions options;
    const Segmentation a = segment(depth, camera, options, 3), b = segment(depth, camera, options, 3);
    ASSERT_EQ(a.regions.size(), b.regions.size());
    for (std::size_t i = 0; i < a.regions.size(); ++i) EXPECT_EQ(a.regions[i].plane.d, b.regions[i].plane.d);
    EXPECT_EQ(a.labels.pixels, b.labels.pixels);
}

TEST(RansacTest, RefusesBadOptions) {
    const auto with = [](auto change) {
        RansacOptions options;
        change(options);
        return options;
    };
    EXPECT_THROW(make_ransac_segmenter(with([](auto& o) { o.thickness_m = 0; }), 1), std::invalid_argument);
    EXPECT_THROW(make_ransac_segmenter(with([](auto& o) { o.min_inliers = 2; }), 1), std::invalid_argument);
    EXPECT_THROW(make_ransac_segmenter(with([](auto& o) { o.max_planes = 0; }), 1), std::invalid_argument);
    EXPECT_THROW(make_ransac_segmenter(with([](auto& o) { o.subsampling = 17; }), 1), std::invalid_argument);
    EXPECT_THROW(make_ransac_segmenter(with([](auto& o) { o.max_iterations = 0; }), 1),
                 std::invalid_argument);
    EXPECT_THROW(make_ransac_segmenter(with([](auto& o) { o.probability = 1; }), 1), std::invalid_argument);
}

}  // namespace
}  // namespace planemap::segmentation
