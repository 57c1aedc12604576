// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/truth.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bench_segmentation/two_walls.hpp"

namespace planemap::bench {
namespace {

MatchScore match(const TwoWalls& walls, const segmentation::Segmentation& segmentation) {
    return match(walls.truth, segmentation, walls.depth, walls.camera, kLeastPixels);
}

/// Gives pixels of a rectangle another label.
template <typename Change>
void change(Image<std::uint16_t>& labels, int u0, int v0, int u1, int v1, const Change& new_label) {
    for (int v = v0; v < v1; ++v) {
        for (int u = u0; u < u1; ++u) labels(u, v) = new_label(labels(u, v));
    }
}

TEST(MakeTruth, CutsSurfacesIntoConnectedPieces) {
    const CameraInfo camera = scene::camera(8, 4);
    DepthImage depth(8, 4, 1000);
    Image<std::uint16_t> surfaces(8, 4, 1);
    for (int v = 0; v < 4; ++v) surfaces(3, v) = 2;  // cuts surface 1 in two
    for (int u = 4; u < 8; ++u) surfaces(u, 2) = 0;  // and its right part once more
    depth(0, 0) = 0;                                 // no reading
    const Truth truth = make_truth(surfaces, {kWall1, kWall2}, depth, camera);
    ASSERT_EQ(truth.pieces.size(), 4u);
    std::vector<std::pair<int, double>> pieces;
    for (const TruePiece& piece : truth.pieces) pieces.emplace_back(piece.surface, piece.pixels);
    std::sort(pieces.begin(), pieces.end());
    EXPECT_EQ(pieces, (std::vector<std::pair<int, double>>{{0, 4}, {0, 8}, {0, 11}, {1, 4}}));
    EXPECT_EQ(truth.pieces_of_pixels(0, 0), 0);
    EXPECT_EQ(truth.pieces_of_pixels(5, 2), 0);
    EXPECT_EQ(truth.pieces_of_pixels(0, 1), truth.pieces_of_pixels(2, 3));
}

TEST(MakeTruth, PiecesThatTouchAtACornerOnlyAreTwo) {
    Image<std::uint16_t> surfaces(4, 4);
    for (int k = 0; k < 2; ++k) surfaces(k, 0) = surfaces(k, 1) = surfaces(2 + k, 2) = surfaces(2 + k, 3) = 1;
    EXPECT_EQ(make_truth(surfaces, {kWall1}, DepthImage(4, 4, 1000), scene::camera(4, 4)).pieces.size(), 2u);
}

TEST(Match, PerfectLabelsScoreOne) {
    const TwoWalls walls;
    const MatchScore score = match(walls, walls.perfect);
    EXPECT_EQ(score.recall(), 1);
    EXPECT_EQ(score.precision(), 1);
    EXPECT_EQ(score.correct, 2);
    EXPECT_EQ(score.over_segmented + score.under_segmented + score.missed + score.noise, 0);
    ASSERT_EQ(score.angle_deg.size(), 2u);
    for (const double angle : score.angle_deg) EXPECT_NEAR(angle, 0, 1e-5);
    for (const double distance : score.distance_m) EXPECT_NEAR(distance, 0, 1e-9);
}

TEST(Match, NamesOfLabelsDoNotMatter) {
    const TwoWalls walls;
    segmentation::Segmentation swapped = walls.perfect;
    std::swap(swapped.regions[0], swapped.regions[1]);
    change(swapped.labels, 0, 0, 640, 480, [](int label) { return static_cast<std::uint16_t>(3 - label); });
    const MatchScore score = match(walls, swapped);
    EXPECT_EQ(score.correct, 2);
    for (const double angle : score.angle_deg) EXPECT_NEAR(angle, 0, 1e-5);
}

TEST(Match, NothingFoundIsAllMissed) {
    const TwoWalls walls;
    segmentation::Segmentation none;
    none.labels = Image<std::uint16_t>(640, 480);
    const MatchScore score = match(walls, none);
    EXPECT_EQ(score.recall(), 0);
    EXPECT_EQ(score.found, 0);
    EXPECT_EQ(score.missed, 2);
    EXPECT_EQ(score.noise, 0);
}

TEST(Match, ASplitRegionIsOverSegmented) {
    const TwoWalls walls;
    segmentation::Segmentation split = walls.perfect;
    split.regions.push_back(split.regions[0]);
    change(split.labels, 0, 0, 640, 240,
           [](int label) { return static_cast<std::uint16_t>(label == 1 ? 3 : label); });
    const MatchScore score = match(walls, split);
    EXPECT_EQ(score.recalled, 1);
    EXPECT_EQ(score.found, 3);
    EXPECT_EQ(score.precise, 1);
    EXPECT_EQ(score.correct, 1);
    EXPECT_EQ(score.over_segmented, 1);
    EXPECT_EQ(score.missed + score.noise + score.under_segmented, 0);
}

TEST(Match, TwoSurfacesInOneRegionAreUnderSegmented) {
    const TwoWalls walls;
    segmentation::Segmentation merged = walls.perfect;
    change(merged.labels, 0, 0, 640, 480, [](int) { return std::uint16_t{1}; });
    const MatchScore score = match(walls, merged);
    EXPECT_EQ(score.recalled, 0);
    EXPECT_EQ(score.under_segmented, 2);
    EXPECT_EQ(score.correct + score.over_segmented + score.missed + score.noise, 0);
}

TEST(Match, ARegionWhereNothingIsTrueIsNoise) {
    TwoWalls walls;
    walls.truth = make_truth(Image<std::uint16_t>(640, 480), {}, walls.depth, walls.camera);
    const MatchScore score = match(walls, walls.perfect);
    EXPECT_EQ(score.true_pieces, 0);
    EXPECT_EQ(score.found, 2);
    EXPECT_EQ(score.precise, 0);
    EXPECT_EQ(score.noise, 2);
}

TEST(Match, SmallOnesNeitherMissNorFail) {
    const TwoWalls walls;
    segmentation::Segmentation with_speck = walls.perfect;
    with_speck.regions.push_back(with_speck.regions[0]);
    change(with_speck.labels, 0, 0, 30, 30, [](int) { return std::uint16_t{3}; });
    EXPECT_EQ(match(walls, with_speck).found, 2);
    EXPECT_EQ(match(walls, with_speck).precision(), 1);

    Image<std::uint16_t> with_true_speck = walls.perfect.labels;
    change(with_true_speck, 0, 0, 30, 30, [](int) { return std::uint16_t{3}; });
    const Truth truth = make_truth(with_true_speck, {kWall1, kWall2, kWall1}, walls.depth, walls.camera);
    const MatchScore score = match(truth, walls.perfect, walls.depth, walls.camera, kLeastPixels);
    EXPECT_EQ(score.true_pieces, 2);
    EXPECT_EQ(score.recall(), 1);
    EXPECT_EQ(score.missed, 0);
}

TEST(Match, ASurfaceInTwoPiecesMayBeOneRegionOrTwo) {
    TwoWalls walls;
    Image<std::uint16_t> surfaces(640, 480, 1);  // one surface, cut by a bar
    change(surfaces, 300, 0, 340, 480, [](int) { return std::uint16_t{0}; });
    walls.truth = make_truth(surfaces, {kWall1}, walls.depth, walls.camera);
    ASSERT_EQ(walls.truth.pieces.size(), 2u);

    segmentation::Segmentation one;
    one.regions.emplace_back().plane = kWall1;
    one.labels = surfaces;
    EXPECT_EQ(match(walls, one).recalled, 2);
    EXPECT_EQ(match(walls, one).precise, 1);
    EXPECT_EQ(match(walls, one).correct, 2);

    segmentation::Segmentation two = one;
    two.regions.emplace_back().plane = kWall1;
    change(two.labels, 340, 0, 640, 480, [](int) { return std::uint16_t{2}; });
    EXPECT_EQ(match(walls, two).recalled, 2);
    EXPECT_EQ(match(walls, two).precise, 2);
    EXPECT_EQ(match(walls, two).correct, 2);
    EXPECT_EQ(match(walls, two).over_segmented, 0);
}

TEST(Match, ErrorsOfParametersAreMeasuredAtTheRegion) {
    const TwoWalls walls;
    segmentation::Segmentation shifted = walls.perfect;
    for (PlanarRegion& region : shifted.regions) region.plane.d += 0.004;
    for (const double distance : match(walls, shifted).distance_m) EXPECT_NEAR(distance, 0.004, 1e-9);
    segmentation::Segmentation turned_by_1 = walls.perfect;
    for (PlanarRegion& region : turned_by_1.regions) region.plane = turned(region.plane, 1);
    for (const double angle : match(walls, turned_by_1).angle_deg) EXPECT_NEAR(angle, 1, 1e-5);
}

TEST(Match, FramesAddUp) {
    const TwoWalls walls;
    MatchScore sum = match(walls, walls.perfect);
    segmentation::Segmentation none;
    none.labels = Image<std::uint16_t>(640, 480);
    sum += match(walls, none);
    EXPECT_EQ(sum.recall(), 0.5);
    EXPECT_EQ(sum.precision(), 1);
    EXPECT_EQ(sum.missed, 2);
    EXPECT_EQ(sum.correct, 2);
    EXPECT_EQ(sum.angle_deg.size(), 2u);
}

}  // namespace
}  // namespace planemap::bench
