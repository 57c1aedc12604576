// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/row.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluate/room.hpp"
#include "results/rows.hpp"

namespace planemap::bench_map {
namespace {

using namespace evaluation;
using testing::HasSubstr;
using testing::Not;

Row row_of(const PlaneMap& map) {
    Row row{"sim:room", "true", {}, judge(truth_of(room()), map, Pose::Identity()), {}};
    row.run.map = map;
    row.run.message_bytes = 1234;
    row.run.update_median_ms = 0.5;
    row.run.rebuild_ms = 20;
    row.run.coverage = Coverage{0.8, 0.9};
    return row;
}

constexpr const char* kKeys[] = {"sequence",
                                 "poses",
                                 "planes_true",
                                 "found",
                                 "split",
                                 "spurious",
                                 "distance_error_mean_m",
                                 "distance_error_mean_percent",
                                 "angle_error_mean_deg",
                                 "outline_iou",
                                 "leaves_explained",
                                 "area_supported",
                                 "message_bytes",
                                 "update_median_ms",
                                 "rebuild_ms"};

TEST(Row, JsonHasItsKeys) {
    const auto json = to_json(row_of(map_of(room())));
    for (const char* key : kKeys) {
        ASSERT_TRUE(json.contains(key)) << key;
        EXPECT_FALSE(json[key].is_null()) << key;
    }
    EXPECT_EQ(json["poses"], "true");
    EXPECT_EQ(json["planes_true"], 4);
    EXPECT_EQ(json["found"], 4);
    EXPECT_EQ(json["message_bytes"], 1234);
    EXPECT_EQ(json["leaves_explained"], 0.8);
    EXPECT_NEAR(json["outline_iou"], 1, 0.01);
}

TEST(Row, WhatIsNotKnownIsNull) {
    const Row row{"redkitchen", "estimated", {}, std::nullopt, {}};
    const auto json = to_json(row);
    results::expect_null(json, {"planes_true", "found", "split", "spurious", "distance_error_mean_m",
                                "distance_error_mean_percent", "angle_error_mean_deg", "outline_iou",
                                "leaves_explained", "area_supported", "surface_angle_worst_deg"});
    EXPECT_EQ(details(row, true), "");
    EXPECT_EQ(goals({json}), "");
}

TEST(Row, ColumnsStandUnderTheirHeading) {
    results::expect_aligned(table(), {to_json(row_of(map_of(room()))),
                                      to_json({"redkitchen", "estimated", {}, std::nullopt, {}})});
}

TEST(Row, DetailsNameWhatToLookAt) {
    std::vector<Face> faces = room();
    faces[1].centre.x() -= 0.2;
    const std::string text = details(row_of(map_of(faces)), false);
    EXPECT_THAT(text, HasSubstr("not found:\n    west wall"));
    EXPECT_THAT(text, HasSubstr("map plane 11, 7.20 m2, 0 % of it on a true plane"));
    EXPECT_THAT(text, Not(HasSubstr("split")));
    EXPECT_THAT(details(row_of(map_of(faces)), true), HasSubstr("all:\n    floor"));
}

TEST(Row, GoalsAreJudgedFromTheFigures) {
    const Json good = to_json(row_of(map_of(room())));
    EXPECT_THAT(goals({good}), Not(HasSubstr("NOT met")));
    Row bad = row_of({});
    bad.surfaces = {{1, 1, 100, 0.2, 0.02}};
    const std::string text = goals({good, to_json(bad)});
    EXPECT_THAT(text, HasSubstr(">= 1     NOT met: 1.000 0.000"));
    EXPECT_THAT(text, HasSubstr("<= 0.5   met: 0.20"));
    EXPECT_THAT(text, HasSubstr("<= 0.01  NOT met: 0.0200"));
}

}  // namespace
}  // namespace planemap::bench_map
