// SPDX-License-Identifier: BSD-3-Clause
#include "segment/region_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "segment/small_scene.hpp"
#include "segmentation/segmentation.hpp"

namespace planemap {
namespace {

using Json = nlohmann::ordered_json;

Eigen::Vector3d vector(const Json& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

class RegionJson : public testing::Test {
  protected:
    RegionJson() {
        segmentation::make_segmenter({})->segment(small_depth(), small_camera(), segmentation);
        json = Json::parse(regions_json(segmentation).dump());
    }

    segmentation::Segmentation segmentation;
    Json json;
};

TEST_F(RegionJson, SaysWhatTheLibraryFound) {
    ASSERT_EQ(json.size(), segmentation.regions.size());
    ASSERT_GE(json.size(), 2u);
    for (std::size_t i = 0; i < json.size(); ++i) {
        const PlanarRegion& region = segmentation.regions[i];
        const Json& r = json[i];
        EXPECT_EQ(r["label"], i + 1);
        EXPECT_EQ(vector(r["normal"]), region.plane.normal);
        EXPECT_EQ(r["d"], region.plane.d);
        EXPECT_EQ(r["rms_m"], region.rms);
        const auto& labels = segmentation.labels.pixels;
        EXPECT_EQ(r["pixels"], std::count(labels.begin(), labels.end(), i + 1));
        EXPECT_EQ(r["moments"]["count"], region.moments.count);
        EXPECT_EQ(vector(r["moments"]["sum"]), region.moments.sum);
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(vector(r["moments"]["scatter"][static_cast<std::size_t>(k)]),
                      region.moments.scatter.col(k));
        }
        EXPECT_EQ(vector(r["box"]["half_extents"]), region.box.half_extents);
    }
}

TEST_F(RegionJson, AxesAreRightHandedWithTheNormalLast) {
    for (const Json& r : json) {
        const Json& axes = r["box"]["axes"];
        const Eigen::Vector3d x = vector(axes[0]), y = vector(axes[1]), z = vector(axes[2]);
        EXPECT_LT((z - vector(r["normal"])).norm(), 1e-9);
        EXPECT_LT((x.cross(y) - z).norm(), 1e-9);
    }
}

TEST_F(RegionJson, OutlinesLieOnThePlaneAndTheWindowIsAHole) {
    int holes = 0;
    for (const Json& r : json) {
        EXPECT_FALSE(r["outline"].empty());
        for (const Json& ring : r["outline"]) {
            ASSERT_GE(ring["points"].size(), 3u);
            for (const Json& point : ring["points"])
                EXPECT_NEAR(vector(r["normal"]).dot(vector(point)) + r["d"].get<double>(), 0, 1e-9);
            if (!ring["hole"].get<bool>()) continue;
            ++holes;
            for (const Json& point : ring["points"]) {  // the window, give or take the outline's grid
                EXPECT_LT(std::abs(vector(point).x()), 0.3);
                EXPECT_GT(vector(point).y(), -0.55);
                EXPECT_LT(vector(point).y(), 0.05);
            }
        }
    }
    EXPECT_EQ(holes, 1);
}

TEST(RegionJsonOfNothing, IsAnEmptyList) {
    EXPECT_EQ(regions_json({}), Json::array());
}

}  // namespace
}  // namespace planemap
