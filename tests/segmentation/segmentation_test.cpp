// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/segmentation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "segmentation/scene.hpp"

namespace planemap::segmentation {
namespace {

SegmentationOptions options_for(const std::string& method) {
    SegmentationOptions options;
    options.method = method;
    options.ransac.max_iterations = 200;
    return options;
}

/// What every method promises of every result.
void expect_consistent(const Segmentation& out, const DepthImage& depth, const CameraInfo& camera) {
    ASSERT_EQ(out.labels.width, depth.width);
    ASSERT_EQ(out.labels.height, depth.height);
    ASSERT_EQ(out.labels.pixels.size(), depth.pixels.size());
    for (std::size_t i = 0; i < out.regions.size(); ++i) {
        const PlanarRegion& region = out.regions[i];
        EXPECT_TRUE(is_valid(region)) << i;
        EXPECT_GT(region.plane.d, 0) << i;
        EXPECT_NEAR(region.plane.signed_distance(region.box.frame_from_box.translation()), 0, 1e-6) << i;
        EXPECT_LT((region.box.frame_from_box.linear().col(2) - region.plane.normal).norm(), 1e-6) << i;
        EXPECT_GE(out.regions[i > 0 ? i - 1 : 0].moments.count, region.moments.count) << i;
    }
    for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
        ASSERT_LE(out.labels.pixels[i], out.regions.size());
        if (out.labels.pixels[i] == 0) continue;
        ASSERT_TRUE(is_valid_depth(depth.pixels[i]));
        ASSERT_GE(camera.metres(depth.pixels[i]), camera.depth_min_m);
        ASSERT_LE(camera.metres(depth.pixels[i]), camera.depth_max_m);
    }
}

void expect_same(const Segmentation& a, const Segmentation& b) {
    ASSERT_EQ(a.regions.size(), b.regions.size());
    EXPECT_EQ(a.labels.pixels, b.labels.pixels);
    for (std::size_t i = 0; i < a.regions.size(); ++i) {
        EXPECT_EQ(a.regions[i].plane.normal, b.regions[i].plane.normal);
        EXPECT_EQ(a.regions[i].plane.d, b.regions[i].plane.d);
        EXPECT_EQ(a.regions[i].moments.scatter, b.regions[i].moments.scatter);
        ASSERT_EQ(a.regions[i].outline.rings.size(), b.regions[i].outline.rings.size());
        for (std::size_t r = 0; r < a.regions[i].outline.rings.size(); ++r)
            EXPECT_EQ(a.regions[i].outline.rings[r], b.regions[i].outline.rings[r]);
    }
}

class EveryMethod : public testing::TestWithParam<std::string> {
  protected:
    std::unique_ptr<Segmenter> segmenter_ = make_segmenter(options_for(GetParam()));
};

#ifdef PLANEMAP_PCL
const std::vector<std::string> kMethods{"cells", "ransac"};
#else
const std::vector<std::string> kMethods{"cells"};
#endif
INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod, testing::ValuesIn(kMethods),
                         [](const auto& info) { return info.param; });

TEST_P(EveryMethod, FindsTheWallsOfACorner) {
    const CameraInfo camera = scene::camera();
    const Plane left = scene::tilted(0.1, 0.8, {0, 0, 2.5}), right = scene::tilted(0.1, -0.7, {0, 0, 2.5});
    const DepthImage depth = scene::render(camera, {scene::plane(left), scene::plane(right)}, true);
    Segmentation out;
    segmenter_->segment(depth, camera, out);
    expect_consistent(out, depth, camera);
    EXPECT_NE(scene::find(out, left), nullptr);
    EXPECT_NE(scene::find(out, right), nullptr);
    EXPECT_GT(scene::labelled_share(out), 0.95);
}

TEST_P(EveryMethod, IsDeterministicAndKeepsNoState) {
    const CameraInfo camera = scene::camera(320, 240);
    const DepthImage corner = scene::render(
        camera,
        {scene::plane(scene::tilted(0, 0.8, {0, 0, 2})), scene::plane(scene::tilted(0, -0.7, {0, 0, 2}))},
        true);
    const DepthImage wall = scene::render(camera, {scene::plane(scene::tilted(0.3, 0, {0, 0, 1.5}))}, true);
    Segmentation first, other, again, fresh;
    segmenter_->segment(corner, camera, first);
    segmenter_->segment(wall, camera, other);
    segmenter_->segment(corner, camera, again);
    make_segmenter(options_for(GetParam()))->segment(corner, camera, fresh);
    expect_same(first, again);
    expect_same(first, fresh);
    EXPECT_FALSE(first.regions.empty());
}

TEST_P(EveryMethod, LabelsAndPlanesAreTheSameWithoutOutlines) {
    const CameraInfo camera = scene::camera(320, 240);
    const DepthImage corner = scene::render(
        camera,
        {scene::plane(scene::tilted(0, 0.8, {0, 0, 2})), scene::plane(scene::tilted(0, -0.7, {0, 0, 2}))},
        true);
    Segmentation full, bare;
    segmenter_->segment(corner, camera, full);
    segmenter_->segment(corner, camera, bare);  // whose outlines and boxes must go
    segmenter_->label(corner, camera, bare);
    EXPECT_EQ(bare.labels.pixels, full.labels.pixels);
    ASSERT_EQ(bare.regions.size(), full.regions.size());
    ASSERT_FALSE(full.regions.empty());
    for (std::size_t i = 0; i < full.regions.size(); ++i) {
        EXPECT_EQ(bare.regions[i].plane.normal, full.regions[i].plane.normal);
        EXPECT_EQ(bare.regions[i].plane.d, full.regions[i].plane.d);
        EXPECT_EQ(bare.regions[i].moments.scatter, full.regions[i].moments.scatter);
        EXPECT_EQ(bare.regions[i].rms, full.regions[i].rms);
        EXPECT_TRUE(bare.regions[i].outline.rings.empty());
        EXPECT_TRUE(bare.regions[i].box.half_extents.isZero());
        EXPECT_FALSE(full.regions[i].outline.rings.empty());
    }
    EXPECT_THROW(segmenter_->label(DepthImage(), camera, bare), std::invalid_argument);
}

TEST_P(EveryMethod, NothingValidIsNoRegion) {
    const CameraInfo camera = scene::camera(320, 240);
    for (const std::uint16_t raw :
         std::vector<std::uint16_t>{0, 65535, 100, 20000}) {  // the last two are out of the trusted range
        Segmentation out;
        out.regions.resize(2);
        segmenter_->segment(DepthImage(320, 240, raw), camera, out);
        EXPECT_TRUE(out.regions.empty());
        EXPECT_THAT(out.labels.pixels, testing::Each(0));
    }
}

TEST_P(EveryMethod, RangeOutsideOf16BitsIsRefused) {
    CameraInfo camera = scene::camera(64, 48);
    camera.depth_min_m = 70;
    camera.depth_max_m = 80;
    Segmentation out;
    EXPECT_THROW(segmenter_->segment(DepthImage(64, 48, 2000), camera, out), std::invalid_argument);
}

TEST_P(EveryMethod, RefusesAnImageOfAnotherSizeAndABadCamera) {
    CameraInfo camera = scene::camera(320, 240);
    Segmentation out;
    EXPECT_THROW(segmenter_->segment(DepthImage(), camera, out), std::invalid_argument);
    EXPECT_THROW(segmenter_->segment(DepthImage(240, 320), camera, out), std::invalid_argument);
    DepthImage short_of_pixels(320, 240);
    short_of_pixels.pixels.pop_back();
    EXPECT_THROW(segmenter_->segment(short_of_pixels, camera, out), std::invalid_argument);
    for (const double focal : {0.0, -1.0, std::nan("")}) {
        camera.depth.fx = focal;
        EXPECT_THROW(segmenter_->segment(DepthImage(320, 240), camera, out), std::invalid_argument);
    }
}

TEST_P(EveryMethod, SurvivesRandomImagesOfRandomSizes) {
    std::mt19937_64 random(7);
    Segmentation out;
    for (int trial = 0; trial < 40; ++trial) {
        const auto pick = [&](int low, int high) {
            return std::uniform_int_distribution<int>(low, high)(random);
        };
        CameraInfo camera = scene::camera(pick(1, 300), pick(1, 200));
        for (PinholeCamera* side : {&camera.depth, &camera.color})
            side->fx = side->fy = std::max(side->width, side->height);
        camera.depth_units_per_metre = trial % 2 == 0 ? 1000 : 5000;
        DepthImage depth(camera.depth.width, camera.depth.height);
        const int kind = trial % 4, base = pick(300, 9000);
        for (std::uint16_t& raw : depth.pixels) {
            // Anything; small noise about a value; blocks of few values; valid and invalid in turn.
            const int value = kind == 0   ? pick(0, 65535)
                              : kind == 1 ? base + pick(-20, 20)
                              : kind == 2 ? 1000 * pick(0, 3)
                                          : pick(0, 1) * base;
            raw = static_cast<std::uint16_t>(value);
        }
        segmenter_->segment(depth, camera, out);
        expect_consistent(out, depth, camera);
    }
}

TEST_P(EveryMethod, SurvivesHostileCameras) {
    std::mt19937_64 random(11);
    const auto power = [&](int low, int high) {
        return std::pow(10.0, std::uniform_int_distribution<int>(low, high)(random));
    };
    const auto one_in = [&](unsigned n) { return random() % n == 0; };
    Segmentation out;
    std::size_t regions = 0;
    int refused = 0;
    for (int trial = 0; trial < 400; ++trial) {
        // A tilted wall, in raw units, whatever these mean.
        const int width = one_in(8) ? 8192 : 72, height = width > 72 ? 9 : 56;
        CameraInfo camera = scene::camera(width, height);
        DepthImage depth(width, height);
        const int slope = std::uniform_int_distribution<int>(-3, 3)(random);
        for (int v = 0; v < height; ++v) {
            for (int u = 0; u < width; ++u)
                depth(u, v) = static_cast<std::uint16_t>(3000 + slope * (u % 500) + (one_in(9) ? 1 : 0));
        }
        // Extreme ones, which are refused; and those at the ends of what is allowed, which are not.
        const bool extreme = one_in(3);
        const int range = 300;
        const auto end_of = [&](double low, double high) { return one_in(2) ? low : high; };
        if (!one_in(3)) camera.depth_units_per_metre = extreme ? power(-range, range) : end_of(100, 1e5);
        if (one_in(2))
            camera.depth.fx = camera.depth.fy = (extreme ? power(-range, range) : end_of(0.2, 10)) * width;
        if (one_in(2)) camera.depth.fy = camera.depth.fx * end_of(0.5, 2);
        if (one_in(4)) camera.depth.cx = extreme ? power(-range, range) : end_of(-0.5, 1.5) * width;
        camera.color = camera.depth;  // resolutions far apart are refused
        camera.depth_min_m = one_in(2) ? 0 : 1 / camera.depth_units_per_metre;
        camera.depth_max_m = std::min(1e308, 60000 / camera.depth_units_per_metre);
        if (one_in(2)) camera.noise = {CameraLimits::kLeastSigma_m, 0, 0};
        if (one_in(4)) camera.noise.base_m = extreme ? power(-range, range) : 0.1 * camera.depth_max_m;
        if (one_in(4)) camera.noise.quadratic_per_m = extreme ? power(-range, range) : 1e-6;
        if (one_in(4)) camera.noise.offset_m = extreme ? power(-range, range) : camera.depth_max_m;
        try {
            segmenter_->segment(depth, camera, out);
        } catch (const std::invalid_argument&) {
            ++refused;
            continue;
        }
        regions += out.regions.size();
        ASSERT_EQ(out.labels.pixels.size(), depth.pixels.size());
        for (const PlanarRegion& region : out.regions) {
            EXPECT_TRUE(is_valid(region)) << trial;
            EXPECT_GT(region.plane.d, 0) << trial;
        }
        for (const std::uint16_t label : out.labels.pixels) ASSERT_LE(label, out.regions.size());
    }
    EXPECT_GT(regions, 20u);
    EXPECT_GT(refused, 20);
    EXPECT_LT(refused, 300);
}

TEST_P(EveryMethod, WorksWithTheLeastNoise) {
    CameraInfo camera = scene::camera();
    camera.noise = {CameraLimits::kLeastSigma_m, 0, 0};
    const Plane wall = scene::tilted(0.3, 0.2, {0, 0, 1.5});
    const DepthImage depth = scene::render(camera, {scene::plane(wall)});
    Segmentation out;
    segmenter_->segment(depth, camera, out);
    expect_consistent(out, depth, camera);
    ASSERT_FALSE(out.regions.empty());
    EXPECT_NE(scene::find(out, wall, 0.2, 0.01), nullptr);
}

TEST_P(EveryMethod, WorksAtManySizes) {
    for (const auto& [width, height] :
         std::vector<std::pair<int, int>>{{320, 240}, {1280, 720}, {641, 479}, {7, 5}, {1, 1}}) {
        const CameraInfo camera = scene::camera(width, height);
        const Plane wall = scene::tilted(0.4, 0.2, {0, 0, 1.8});
        const DepthImage depth = scene::render(camera, {scene::plane(wall)}, true);
        Segmentation out;
        segmenter_->segment(depth, camera, out);
        expect_consistent(out, depth, camera);
        if (width < 100) continue;
        ASSERT_FALSE(out.regions.empty()) << width;
        EXPECT_NE(scene::find(out, wall, 0.5, 0.01), nullptr) << width;
    }
}

TEST(SegmentationOptionsTest, DefaultsAreValid) {
    EXPECT_NO_THROW(SegmentationOptions().validate());
}

TEST(SegmentationOptionsTest, NamesEveryBadField) {
    SegmentationOptions options;
    options.method = "magic";
    options.cells.grow_m = -1;
    options.cells.bend_deg = std::nan("");
    options.ransac.subsampling = 0;
    try {
        make_segmenter(options);
        FAIL() << "no exception";
    } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("method is magic"),
                                                 testing::HasSubstr("cells.grow_m is -1"),
                                                 testing::HasSubstr("cells.bend_deg"),
                                                 testing::HasSubstr("ransac.subsampling is 0")));
    }
}

}  // namespace
}  // namespace planemap::segmentation
