// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/growth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planemap::bench_map {
namespace {

Json point(std::int64_t frames, std::size_t bytes, double frame_ms) {
    return {{"frames", frames},  {"keyframes", 1}, {"planes", 1},         {"message_bytes", bytes},
            {"memory_bytes", 1}, {"map_ms", 1},    {"frame_ms", frame_ms}};
}

TEST(Growth, ComparesRoundsAndThousands) {
    Growth growth;
    growth.points = {point(1000, 10, 5), point(2000, 20, 10), point(3000, 25, 12), point(4000, 26, 15)};
    growth.rounds = {point(1900, 2000, 0), point(3800, 2100, 0)};
    EXPECT_NEAR(growth.second_round().value(), 0.05, 1e-9);
    EXPECT_NEAR(growth.cost_ratio().value(), 1.5, 1e-9);
    EXPECT_THAT(growth_table(growth), testing::HasSubstr("the second round adds 5.0 %"));
    EXPECT_EQ(to_json("sim:x", growth)["points"].size(), 4u);
}

TEST(Growth, SaysNothingOfWhatWasNotSeen) {
    Growth growth;
    EXPECT_FALSE(growth.second_round());
    EXPECT_FALSE(growth.cost_ratio());
    growth.rounds = {point(1900, 2000, 0)};
    growth.points = {point(1000, 10, 5), point(1900, 20, 10)};
    EXPECT_FALSE(growth.second_round());
    EXPECT_FALSE(growth.cost_ratio());
    EXPECT_TRUE(to_json("sim:x", growth)["cost_ratio"].is_null());
}

TEST(Growth, NotesTheEnd) {
    const Growth growth =
        measure_growth("sim:office?width=160&height=120&frames=12", 10, {}, [](std::int64_t) {});
    ASSERT_EQ(growth.points.size(), 1u);
    EXPECT_EQ(growth.points[0]["frames"], 10);
    EXPECT_GT(growth.points[0]["keyframes"], 0);
    EXPECT_GT(growth.points[0]["message_bytes"], 0);
    EXPECT_GT(growth.points[0]["frame_ms"], 0);
    EXPECT_TRUE(growth.rounds.empty());
}

}  // namespace
}  // namespace planemap::bench_map
