// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/metrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench_segmentation/local_normals.hpp"
#include "bench_segmentation/two_walls.hpp"

namespace planemap::bench {
namespace {

class FrameScoreTest : public testing::Test {
  protected:
    FrameScore score(const segmentation::Segmentation& segmentation) const {
        return score_frame(walls.depth, walls.camera, normals, segmentation);
    }

    const TwoWalls walls;
    const Image<Eigen::Vector3f> normals = local_normals(walls.depth, walls.camera);
};

TEST_F(FrameScoreTest, PerfectLabelsExplainEverything) {
    const FrameScore s = score(walls.perfect);
    EXPECT_EQ(s.readings, 640 * 480);
    EXPECT_EQ(s.explained(), 1);
    EXPECT_GT(s.coherent(), 0.99) << "at the edge local normals are a mixture";
    EXPECT_EQ(s.off30(), 0);
    EXPECT_EQ(s.planes_a_frame(), 2);
    EXPECT_LT(s.rms(), 0.0005);
    EXPECT_GT(s.planar, 0.9 * s.readings);
    EXPECT_LT(s.planar, s.readings) << "the edge is not locally planar";
}

TEST_F(FrameScoreTest, NoLabelsExplainNothing) {
    segmentation::Segmentation none;
    none.labels = Image<std::uint16_t>(640, 480);
    const FrameScore s = score(none);
    EXPECT_EQ(s.explained(), 0);
    EXPECT_EQ(s.coherent(), 0);
    EXPECT_EQ(s.off30(), 0);
    EXPECT_EQ(s.rms(), 0);
}

TEST_F(FrameScoreTest, AWrongPlaneExplainsNothing) {
    segmentation::Segmentation far_off = walls.perfect;
    for (PlanarRegion& region : far_off.regions) region.plane.d += 0.5;
    const FrameScore s = score(far_off);
    EXPECT_EQ(s.explained(), 0);
    EXPECT_EQ(s.coherent(), 0);
    EXPECT_EQ(s.off30(), 0) << "its direction is right";
    EXPECT_NEAR(s.rms(), 0.5, 0.001);
}

TEST_F(FrameScoreTest, TurnedPlanesAreIncoherentFrom20AndOffFrom30Degrees) {
    struct Case {
        double angle_deg, off30;
        bool coherent;
    };
    for (const Case& c : {Case{18, 0, true}, Case{23, 0, false}, Case{28, 0, false}, Case{40, 1, false}}) {
        segmentation::Segmentation segmentation = walls.perfect;
        for (PlanarRegion& region : segmentation.regions) region.plane = turned(region.plane, c.angle_deg);
        const FrameScore s = score(segmentation);
        EXPECT_NEAR(s.off30(), c.off30, 0.02) << c.angle_deg;
        EXPECT_EQ(s.coherent() > 0.02, c.coherent) << c.angle_deg;
        EXPECT_LT(s.explained(), 0.5) << c.angle_deg;
    }
}

TEST_F(FrameScoreTest, APlaneAndItsReverseAreNotTheSame) {
    segmentation::Segmentation reversed = walls.perfect;
    for (PlanarRegion& region : reversed.regions) region.plane = region.plane.flipped();
    EXPECT_EQ(score(reversed).explained(), 1);
    EXPECT_GT(score(reversed).off30(), 0.99);
}

TEST_F(FrameScoreTest, HalfTheLabelsAreHalfOfIt) {
    segmentation::Segmentation half = walls.perfect;
    std::fill(half.labels.pixels.begin(), half.labels.pixels.begin() + 640 * 240, std::uint16_t{0});
    EXPECT_NEAR(score(half).explained(), 0.5, 1e-12);
    EXPECT_NEAR(score(half).coherent(), 0.5, 0.01);
}

TEST_F(FrameScoreTest, FramesAddUp) {
    FrameScore sum = score(walls.perfect);
    segmentation::Segmentation none;
    none.labels = Image<std::uint16_t>(640, 480);
    sum += score(none);
    EXPECT_EQ(sum.frames, 2);
    EXPECT_EQ(sum.planes_a_frame(), 1);
    EXPECT_NEAR(sum.explained(), 0.5, 1e-12);
}

TEST_F(FrameScoreTest, LabelsOnInvalidReadingsDoNotCount) {
    TwoWalls holes;
    std::fill(holes.depth.pixels.begin(), holes.depth.pixels.begin() + 640 * 240, std::uint16_t{0});
    const FrameScore s =
        score_frame(holes.depth, holes.camera, local_normals(holes.depth, holes.camera), holes.perfect);
    EXPECT_EQ(s.readings, 640 * 240);
    EXPECT_EQ(s.labelled, 640 * 240);
    EXPECT_EQ(s.explained(), 1);
}

TEST_F(FrameScoreTest, BadLabelImagesAreRefused) {
    segmentation::Segmentation wrong_size = walls.perfect, unknown_label = walls.perfect;
    wrong_size.labels = Image<std::uint16_t>(10, 10);
    unknown_label.labels(5, 5) = 3;
    EXPECT_THROW(score(wrong_size), std::invalid_argument);
    EXPECT_THROW(score(unknown_label), std::invalid_argument);
}

TEST(Tolerance, IsTheIssues) {
    EXPECT_EQ(tolerance(0.4), 0.015);
    EXPECT_NEAR(tolerance(3.4), 3 * (0.0012 + 0.0019 * 9), 1e-12);
}

TEST(Percentiles, AreNearestRanks) {
    EXPECT_EQ(median({3, 1, 2}), 2);
    EXPECT_EQ(median({4, 1, 3, 2}), 2);
    EXPECT_EQ(percentile_95({5}), 5);
    std::vector<double> hundred;
    for (int i = 1; i <= 100; ++i) hundred.push_back(i);
    EXPECT_EQ(percentile_95(hundred), 95);
    EXPECT_TRUE(std::isnan(median({})));
}

}  // namespace
}  // namespace planemap::bench
