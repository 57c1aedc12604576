// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/sequences.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench_segmentation/benchmark.hpp"
#include "bench_segmentation/local_normals.hpp"
#include "bench_segmentation/metrics.hpp"
#include "data_folder.hpp"

namespace planemap::bench {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Sequence open(const std::string& name, int frames) {
    return open_sequence(benchmark::parse_sequences(name, known_sequences()).front(), frames,
                         test::data_folder(""));
}

/// Scores the truth as a segmentation: it must be perfect up to the sensor's noise.
FrameScore score_of_truth(const BenchFrame& frame, const CameraInfo& camera) {
    return score_frame(frame.depth, camera, local_normals(frame.depth, camera),
                       as_segmentation(frame.truth.value()));
}

TEST(EvenlySpread, CoversAll) {
    EXPECT_THAT(evenly_spread(10, 5), ElementsAre(0, 2, 4, 6, 8));
    EXPECT_THAT(evenly_spread(3, 5), ElementsAre(0, 1, 2));
    EXPECT_THAT(evenly_spread(7, 3), ElementsAre(0, 2, 4));
    EXPECT_THAT(evenly_spread(0, 3), IsEmpty());
}

TEST(OpenSequence, TruthOfTheRenderedRoomLiesOnItsPlanes) {
    const Sequence office = open("sim:office", 3);
    EXPECT_THAT(office.indices, ElementsAre(0, 300, 600));
    for (const std::size_t index : office.indices) {
        const BenchFrame frame = office.load(index);
        ASSERT_TRUE(frame.truth && frame.world_from_depth);
        const FrameScore score = score_of_truth(frame, office.camera);
        EXPECT_GT(score.explained(), 0.97) << index;
        EXPECT_LT(score.off30(), 0.02) << index;
    }
}

TEST(OpenSequence, AnySimulatorHasItsTruth) {
    const Sequence small = open("sim:office?width=160&height=120&frames=40", 4);
    EXPECT_THAT(small.indices, ElementsAre(0, 10, 20, 30));
    const BenchFrame frame = small.load(10);
    EXPECT_EQ(frame.depth.width, 160);
    EXPECT_TRUE(frame.truth && frame.world_from_depth);
}

TEST(OpenSequence, TheWallIsOnePlaneAndTheNoiseNone) {
    const Sequence wall = open("wall", 4), noise = open("noise", 2);
    for (const std::size_t index : wall.indices) {
        const BenchFrame frame = wall.load(index);
        const FrameScore score = score_of_truth(frame, wall.camera);
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
    const FrameScore score = score_of_truth(frame, labelled.camera);
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
