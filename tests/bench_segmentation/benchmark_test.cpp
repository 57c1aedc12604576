// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/benchmark.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/choices.hpp"
#include "temporary_folder.hpp"

namespace planemap::bench {
namespace {

using testing::AllOf;
using testing::HasSubstr;

SequenceInfo sequence_named(const char* name) {
    return benchmark::named("sequences", name, known_sequences());
}

TEST(Benchmark, FillsARowForEachMethodAndDrawsWhatItFound) {
    const TemporaryFolder folder;
    BenchmarkOptions options;
    options.frames = 4;
    options.slow_frames = 2;
    options.overlays = folder.path();
    options.overlay_every = 2;
    options.quiet = true;
    const std::vector<Row> rows =
        Benchmark(options).run(sequence_named("wall"), parse_methods("cells/2,ransac/2"));
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].method.name, "truth");
    EXPECT_TRUE(rows[0].ms.empty());
    EXPECT_EQ(rows[1].method, (MethodName{"cells", 2}));
    EXPECT_EQ(rows[1].ms.size(), 4u);
    EXPECT_EQ(rows[2].ms.size(), 2u) << "slow";
    for (const Row& row : rows) {
        EXPECT_EQ(row.sequence, "wall");
        EXPECT_EQ(row.match.recall(), 1);
        EXPECT_GT(row.score.explained(), 0.99);
    }
    for (const char* name : {"0000-cells-2.png", "0000-truth.png", "0002-cells-2.png", "0000-ransac-2.png"})
        EXPECT_TRUE(std::filesystem::exists(folder.path() / "wall" / name)) << name;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "wall" / "0001-cells-2.png"));
}

TEST(Benchmark, MissingDataIsSaid) {
    BenchmarkOptions options;
    options.data = "/no/such/folder";
    EXPECT_THROW(Benchmark(options).run(sequence_named("redkitchen"), parse_methods("cells")),
                 benchmark::DataMissing);
    EXPECT_THAT(error_of([&] { open_sequence(sequence_named("redkitchen"), 3, options.data); }),
                AllOf(HasSubstr("/no/such/folder/redkitchen"), HasSubstr("PLANEMAP_DATA")));
}

TEST(Benchmark, BadOptionsAreNamed) {
    BenchmarkOptions options;
    options.frames = -1;
    options.slow_frames = 0;
    options.overlay_every = 0;
    EXPECT_THAT(error_of([&] { Benchmark benchmark(options); }),
                AllOf(HasSubstr("frames"), HasSubstr("slow-frames"), HasSubstr("overlay-every")));
}

}  // namespace
}  // namespace planemap::bench
