// SPDX-License-Identifier: BSD-3-Clause
#include "bench_run/ways.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/rows.hpp"
#include "temporary_folder.hpp"

namespace planemap::bench_run {
namespace {

using results::Json;

TEST(Ways, ARowOfEachAndOfThePeers) {
    const test::TemporaryFolder scratch;
    const benchmark::SequenceInfo office{"sim:office", "", "office?frames=40&rate=10&width=320&height=240",
                                         "", 0};
    // What goes over a network is not there everywhere.
    const std::vector<WayInfo> ways(known_ways().begin(), known_ways().begin() + 2);
    const std::vector<Json> rows = rows_of(office, ways, {PLANEMAP_BIN, {}, scratch.path(), 0});
    ASSERT_EQ(rows.size(), 4u);
    for (const Json& row : rows) {
        EXPECT_EQ(row["sequence"], "sim:office");
        for (const char* key : {"frames", "cpu_s", "cpu_ms", "r", "r_ms", "peak_rss_mb"})
            EXPECT_GT(row[key].get<double>(), 0) << row;
    }
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(rows[i]["way"], ways[i].name);
        EXPECT_EQ(rows[i]["frames"], 40);
        EXPECT_GT(rows[i]["frames_per_s"].get<double>(), 0);
        EXPECT_GT(rows[i]["report_cpu_s"].get<double>(), 0);
    }
    for (std::size_t i = 2; i < 4; ++i) results::expect_null(rows[i], {"frames_per_s", "report_cpu_s"});
    results::expect_aligned(table(), rows);
}

TEST(Ways, WhatIsMissingIsNamed) {
    const test::TemporaryFolder scratch;
    const Bench bench{scratch / "bin", scratch / "data", scratch.path(), 0};
    EXPECT_THROW(rows_of({"kitchen", "", "", "", 0}, known_ways(), bench), benchmark::DataMissing);
    const benchmark::SequenceInfo office{"sim:office", "", "office?frames=2&width=320&height=240", "", 0};
    EXPECT_THAT(error_of([&] { rows_of(office, {known_ways().front()}, bench); }),
                testing::HasSubstr("planemap-run: cannot be started"));
}

}  // namespace
}  // namespace planemap::bench_run
