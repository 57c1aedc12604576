// SPDX-License-Identifier: BSD-3-Clause
#include "run/growth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace planemap {
namespace {

using Json = nlohmann::ordered_json;
using Moment = Growth::Moment;

/// After so many frames of 0.1 s; each takes 2 ms of segmentation, 3 ms of the map, 5 ms of the OctoMap.
Moment after(std::int64_t frames) {
    Moment moment;
    moment.utime = 7000000 + 100000 * frames;
    moment.frames = frames;
    moment.planes = static_cast<std::size_t>(frames);
    moment.map_bytes = 100 * moment.planes;
    moment.octomap_nodes = 1000 * moment.planes;
    moment.octomap_bytes = 2000 * moment.planes;
    moment.octomap_occupied_bytes = 500 * moment.planes;
    moment.segmentation_ms = 2 * static_cast<double>(frames);
    moment.map_ms = 3 * static_cast<double>(frames);
    moment.octomap_ms = 5 * static_cast<double>(frames);
    return moment;
}

TEST(Growth, TimesAFrameAreOfTheFramesSinceTheSampleBefore) {
    const Json growth = growth_figures({after(4), after(5), after(25)}, true);
    EXPECT_EQ(growth["time_s"], Json({0, 0.1, 2.1}));
    EXPECT_EQ(growth["planes"], Json({4, 5, 25}));
    EXPECT_EQ(growth["map_bytes"], Json({400, 500, 2500}));
    EXPECT_EQ(growth["octomap_nodes"], Json({4000, 5000, 25000}));
    EXPECT_EQ(growth["octomap_occupied_bytes"], Json({2000, 2500, 12500}));
    for (const auto& [key, ms] :
         {std::pair("planes_ms_per_frame", 5), std::pair("segmentation_ms_per_frame", 2),
          std::pair("octomap_ms_per_frame", 5)}) {
        ASSERT_EQ(growth[key].size(), 3u) << key;
        for (const Json& value : growth[key]) EXPECT_NEAR(value.get<double>(), ms, 1e-9) << key;
    }
}

TEST(Growth, WithoutAnOctomapItsListsAreNull) {
    const Json growth = growth_figures({after(1)}, false);
    for (const char* key :
         {"octomap_nodes", "octomap_bytes", "octomap_occupied_bytes", "octomap_ms_per_frame"})
        EXPECT_TRUE(growth[key].is_null()) << key;
    EXPECT_EQ(growth["planes"].size(), 1u);
    EXPECT_THAT(growth_markdown({{"growth", growth}}), testing::Not(testing::HasSubstr("OctoMap")));
}

TEST(Growth, OfNoFrameThereIsNothing) {
    const Json growth = growth_figures({}, true);
    EXPECT_TRUE(growth["time_s"].empty());
    EXPECT_EQ(growth_markdown({{"growth", growth}}), "");
    EXPECT_EQ(growth_markdown({{"growth", nullptr}}), "");
    EXPECT_EQ(growth_markdown(Json::object()), "");
}

TEST(Growth, TheReportHasAFewOfTheSamplesAndTheLast) {
    std::vector<Moment> moments;
    for (int i = 1; i <= 100; ++i) moments.push_back(after(i));
    const std::string text = growth_markdown({{"growth", growth_figures(moments, true)}});
    EXPECT_THAT(text, testing::HasSubstr("| 1.9 | 20 | 2.0 | 20000 | 40.0 |\n| 3.9 |"));
    EXPECT_THAT(text, testing::HasSubstr("| 9.9 | 100 | 10.0 | 100000 | 200.0 |\n\n"));
    const std::string two = growth_markdown({{"growth", growth_figures({after(1), after(2)}, true)}});
    EXPECT_THAT(two,
                testing::HasSubstr("| 0.0 | 1 | 0.1 | 1000 | 2.0 |\n| 0.1 | 2 | 0.2 | 2000 | 4.0 |\n\n"));
}

}  // namespace
}  // namespace planemap
