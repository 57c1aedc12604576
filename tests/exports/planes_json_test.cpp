// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "exports/corner.hpp"
#include "exports/exports.hpp"

namespace planemap::exports {
namespace {

using scene::corner;

TEST(PlanesJson, SaysWhatTheMapSays) {
    const PlaneMap map = corner();
    const auto json = nlohmann::json::parse(planes_json(map, Sightings{{3, {0, 3}}}));
    EXPECT_EQ(json["utime"], 42);
    EXPECT_EQ(json["up"], nlohmann::json::parse("[0.0, 0.0, 1.0]"));
    ASSERT_EQ(json["planes"].size(), 3u);
    const auto& wall = json["planes"][1];
    EXPECT_EQ(wall["id"], 3);
    EXPECT_EQ(json["planes"][0]["label"], "floor");
    EXPECT_EQ(wall["label"], "wall");
    EXPECT_NEAR(wall["normal"][0], -1, 1e-9);
    EXPECT_NEAR(wall["d"], 1, 1e-6);
    EXPECT_EQ(wall["inliers"], map.planes[1].inliers);
    EXPECT_NEAR(wall["area"], 4 - 0.35, 1e-6);
    EXPECT_EQ(wall["box_corners"].size(), 8u);
    EXPECT_EQ(wall["keyframe_count"], 2);
    EXPECT_EQ(wall["keyframes"], nlohmann::json::parse("[0, 3]"));
    ASSERT_EQ(wall["outline"].size(), 2u);
    for (const auto& ring : wall["outline"])
        for (const auto& p : ring) EXPECT_NEAR(p[0], 1, 1e-6) << "outlines are in the world";
    EXPECT_EQ(json["lines"][0]["planes"], nlohmann::json::parse("[1, 3]"));
    EXPECT_EQ(json["points"][0]["position"], nlohmann::json::parse("[1.0, 1.0, 0.0]"));
    EXPECT_EQ(planes_json(map), planes_json(corner()));
    EXPECT_TRUE(json["planes"][0]["keyframes"].is_array()) << "seen by none";
    EXPECT_TRUE(nlohmann::json::parse(planes_json(map))["planes"][0]["keyframes"].is_null()) << "not known";
}

TEST(PlanesJson, InferredRingsAreBesideWhatIsSeen) {
    PlaneMap map = corner();
    map.inferred.push_back({3, MapOutline(Outline{{{{0, 0}, {0.5, 0}, {0.5, 0.25}}}})});
    const auto with = nlohmann::json::parse(planes_json(map)),
               without = nlohmann::json::parse(planes_json(corner()));
    auto wall = with["planes"][1];
    ASSERT_EQ(wall["inferred_rings"].size(), 1u);
    ASSERT_EQ(wall["inferred_rings"][0].size(), 3u);
    for (const auto& p : wall["inferred_rings"][0]) EXPECT_NEAR(p[0], 1, 1e-6) << "in the world";
    EXPECT_NEAR(wall["inferred_area"], 0.0625, 1e-6);
    EXPECT_EQ(without["planes"][1]["inferred_area"], 0);
    wall.erase("inferred_rings");
    wall["inferred_area"] = 0.0;
    EXPECT_EQ(wall, without["planes"][1]) << "nothing else changes";
    EXPECT_EQ(with["planes"][0], without["planes"][0]);
    for (const std::string& svg : {overhead_svg(map, {}), perspective_svg(map, {})})
        EXPECT_NE(svg.find("stroke-dasharray"), std::string::npos);
    EXPECT_EQ(overhead_svg(corner(), {}).find("stroke-dasharray"), std::string::npos);
    EXPECT_EQ(planes_ply(map, {}), planes_ply(corner(), {}));
}

TEST(PlanesJson, OfAnEmptyMapAndOfNan) {
    const auto empty = nlohmann::json::parse(planes_json({}));
    EXPECT_TRUE(empty["up"].is_null());
    EXPECT_TRUE(empty["planes"].empty() && empty["lines"].empty() && empty["points"].empty());
    PlaneMap map = corner();
    map.planes[0].rms = std::numeric_limits<float>::quiet_NaN();
    map.planes[0].area = std::numeric_limits<float>::infinity();
    const auto json = nlohmann::json::parse(planes_json(map, Sightings{{3, {0, 3}}}));
    EXPECT_TRUE(json["planes"][0]["rms"].is_null());
    EXPECT_TRUE(json["planes"][0]["area"].is_null());
}

}  // namespace
}  // namespace planemap::exports
