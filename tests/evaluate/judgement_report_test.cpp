// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/judgement_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluate/room.hpp"

namespace planemap::evaluation {
namespace {

using testing::HasSubstr;

TEST(Figures, OfAJudgement) {
    const Json json = figures_of(judge(truth_of(room()), map_of(room()), Pose::Identity()));
    EXPECT_EQ(json["planes_true"], 4);
    EXPECT_EQ(json["found"], 4);
    EXPECT_EQ(json["split"], 0);
    EXPECT_EQ(json["spurious"], 0);
    EXPECT_NEAR(json["outline_iou"], 1, 0.01);
    EXPECT_NEAR(json["distance_error_worst_m"], 0, 1e-9);
}

TEST(Figures, NothingIsKnownWithoutAJudgement) {
    const Json json = figures_of(std::nullopt);
    EXPECT_FALSE(json.empty());
    for (const auto& [key, value] : json.items()) EXPECT_TRUE(value.is_null()) << key;
}

TEST(Details, NameTheWallThatStandsElsewhere) {
    std::vector<Face> faces = room();
    faces[1].centre.x() -= 0.2;
    const Judgement judgement = judge(truth_of(room()), map_of(faces), Pose::Identity());
    EXPECT_THAT(judgement_details(judgement, false), HasSubstr("not found:\n    west wall"));
    EXPECT_EQ(figures_of(judgement)["found"], 3);
}

TEST(Errors, MeanMedianAndWorst) {
    const std::vector<PairMeasure> pairs{{0, 1, 2, 2.1}, {0, 2, 1, 0.8}, {1, 2, 4, 4}, {1, 3, 1, 1}};
    const Statistics metres = errors_of(pairs), percent = relative_errors_of(pairs);
    EXPECT_NEAR(metres.mean, 0.075, 1e-9);
    EXPECT_NEAR(metres.median, 0.05, 1e-9);
    EXPECT_NEAR(metres.max, 0.2, 1e-9);
    EXPECT_NEAR(percent.mean, 6.25, 1e-9);
    EXPECT_NEAR(percent.max, 20, 1e-9);
    EXPECT_EQ(errors_of({}).count, 0u);
}

}  // namespace
}  // namespace planemap::evaluation
