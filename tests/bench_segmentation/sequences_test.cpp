// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/sequences.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench_segmentation/local_normals.hpp"
#include "bench_segmentation/metrics.hpp"
#include "data_folder.hpp"
#include "temporary_folder.hpp"

namespace planemap::bench {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Sequence open(const std::string& name, int frames) {
    std::string missing;
    auto sequence = open_sequence(parse_sequences(name).front(), frames, test::data_folder(""), missing);
    EXPECT_EQ(missing, "");
    return sequence.value();
}

/// The truth as a segmentation: what scores it must be perfect up to the sensor's noise.
segmentation::Segmentation as_segmentation(const Truth& truth) {
    segmentation::Segmentation segmentation;
    segmentation.labels = truth.pieces_of_pixels;
    for (const TruePiece& piece : truth.pieces) segmentation.regions.emplace_back().plane = piece.plane;
    return segmentation;
}

TEST(EvenlySpread, CoversAll) {
    EXPECT_THAT(evenly_spread(10, 5), ElementsAre(0, 2, 4, 6, 8));
    EXPECT_THAT(evenly_spread(3, 5), ElementsAre(0, 1, 2));
    EXPECT_THAT(evenly_spread(7, 3), ElementsAre(0, 2, 4));
    EXPECT_THAT(evenly_spread(0, 3), IsEmpty());
}

TEST(ParseSequences, UnknownNamesAreNamed) {
    EXPECT_EQ(parse_sequences("noise,redkitchen").size(), 2u);
    EXPECT_THAT(test::error_of([] { parse_sequences("noise,attic"); }),
                AllOf(HasSubstr("attic"), HasSubstr("redkitchen")));
    EXPECT_NE(test::error_of([] { parse_sequences(""); }), "");
}

TEST(OpenSequence, MissingDataIsSaid) {
    std::string missing;
    EXPECT_FALSE(open_sequence(parse_sequences("redkitchen").front(), 3, "/no/such/folder", missing));
    EXPECT_THAT(missing, AllOf(HasSubstr("/no/such/folder/redkitchen"), HasSubstr("PLANEMAP_DATA")));
}

TEST(OpenSequence, TruthOfTheRenderedRoomLiesOnItsPlanes) {
    const Sequence office = open("sim:office", 3);
    EXPECT_THAT(office.indices, ElementsAre(0, 300, 600));
    for (const std::size_t index : office.indices) {
        const BenchFrame frame = office.load(index);
        ASSERT_TRUE(frame.truth && frame.world_from_depth);
        const FrameScore score =
            score_frame(frame.depth, office.camera, local_normals(frame.depth, office.camera),
                        as_segmentation(*frame.truth));
        EXPECT_GT(score.explained(), 0.97) << index;
        EXPECT_LT(score.off30(), 0.02) << index;
    }
}

TEST(OpenSequence, TheWallIsOnePlaneAndTheNoiseNone) {
    const Sequence wall = open("wall", 4), noise = open("noise", 2);
    for (const std::size_t index : wall.indices) {
        const BenchFrame frame = wall.load(index);
        const FrameScore score =
            score_frame(frame.depth, wall.camera, local_normals(frame.depth, wall.camera),
                        as_segmentation(frame.truth.value()));
        EXPECT_EQ(frame.truth->pieces.size(), 1u);
        EXPECT_EQ(score.readings, 640 * 480);
        EXPECT_EQ(score.explained(), 1);
    }
    const BenchFrame frame = noise.load(0);
    EXPECT_NE(frame.depth.pixels, noise.load(1).depth.pixels);
    EXPECT_EQ(frame.depth.pixels, noise.load(0).depth.pixels);
    EXPECT_TRUE(frame.truth.value().pieces.empty());
    for (const Eigen::Vector3f& normal : local_normals(frame.depth, noise.camera).pixels)
        ASSERT_TRUE(normal.isZero());
}

TEST(OpenSequence, LabelledImagesHaveTrueLabels) {
    PLANEMAP_NEEDS_DATA("plane_labels");
    const Sequence labelled = open("plane_labels", 3);
    EXPECT_EQ(labelled.indices.size(), 3u);
    const BenchFrame frame = labelled.load(0);
    ASSERT_TRUE(frame.truth);
    const FrameScore score =
        score_frame(frame.depth, labelled.camera, local_normals(frame.depth, labelled.camera),
                    as_segmentation(*frame.truth));
    EXPECT_GT(score.explained_pixels / score.labelled, 0.97);
}

TEST(OpenSequence, RecordingsHavePosesOfTheDepthCamera) {
    PLANEMAP_NEEDS_DATA("redkitchen");
    const Sequence kitchen = open("redkitchen", 5);
    EXPECT_THAT(kitchen.indices, ElementsAre(0, 200, 400, 600, 800));
    const BenchFrame frame = kitchen.load(400);
    ASSERT_TRUE(frame.world_from_depth);
    EXPECT_FALSE(frame.truth);
    EXPECT_EQ(frame.depth.width, 640);
}

}  // namespace
}  // namespace planemap::bench
