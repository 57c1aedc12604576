// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/row.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench_segmentation/local_normals.hpp"
#include "bench_segmentation/two_walls.hpp"
#include "results/rows.hpp"

namespace planemap::bench {
namespace {

Row row_of(bool with_truth, bool with_pose) {
    const TwoWalls walls;
    BenchFrame frame{walls.depth, std::nullopt, std::nullopt};
    if (with_truth) frame.truth = walls.truth;
    if (with_pose) frame.world_from_depth = Pose::Identity();
    Row row;
    row.sequence = "walls";
    row.method = {"perfect", 1};
    const auto normals = local_normals(walls.depth, walls.camera);
    for (const double ms : {1.0, 2.0, 3.0}) row.add(ms, frame, walls.camera, normals, walls.perfect);
    return row;
}

TEST(Row, JsonHasTheAgreedKeysAndFigures) {
    const Json json = to_json(row_of(true, true));
    EXPECT_EQ(json["sequence"], "walls");
    EXPECT_EQ(json["method"], "perfect");
    EXPECT_EQ(json["subsampling"], 1);
    EXPECT_EQ(json["median_ms"], 2.0);
    EXPECT_EQ(json["p95_ms"], 3.0);
    EXPECT_EQ(json["planes"], 2.0);
    EXPECT_EQ(json["explained"], 1.0);
    EXPECT_GT(json["coherent"], 0.99);
    EXPECT_EQ(json["off30"], 0.0);
    EXPECT_LT(json["rms_m"], 0.0005);
    EXPECT_EQ(json["recall"], 1.0);
    EXPECT_EQ(json["precision"], 1.0);
    EXPECT_LT(json["angle_median_deg"], 1e-4);
    EXPECT_LT(json["distance_median_m"], 1e-6);
    EXPECT_EQ(json["spread_planes"], 2.0);
}

TEST(Row, WithoutTruthOrPosesTheFiguresAreNull) {
    const Json json = to_json(row_of(false, false));
    results::expect_null(json, {"recall", "precision", "angle_median_deg", "distance_median_m", "correct",
                                "spread_angle_deg", "spread_distance_m"});
    EXPECT_EQ(json["explained"], 1.0);
    EXPECT_TRUE(to_json(Row{}).at("median_ms").is_null());
}

TEST(Row, LinesOfTheTableAreAligned) {
    results::expect_aligned(table(), {to_json(row_of(true, true)), to_json(row_of(false, true)),
                                      to_json(row_of(false, false)), to_json(Row{})});
}

}  // namespace
}  // namespace planemap::bench
