// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/sequences.hpp"

#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace planemap::bench_map {
namespace {

using Names = std::vector<std::string>;

TEST(Sequences, RangesAreSpelledOut) {
    EXPECT_EQ(parse_sequences("sim:office?seed=9..11&frames=3,redkitchen"),
              (Names{"sim:office?seed=9&frames=3", "sim:office?seed=10&frames=3",
                     "sim:office?seed=11&frames=3", "redkitchen"}));
    EXPECT_EQ(parse_sequences("../shared/x..y"), Names{"../shared/x..y"});
    EXPECT_THROW(parse_sequences(""), std::invalid_argument);
    EXPECT_THROW(parse_sequences("sim:office?seed=5..1"), std::invalid_argument);
    EXPECT_EQ(parse_sequences(kDefaultSequences).size(), 6u);
}

TEST(Sequences, AreFoundInTheDataFolderOrElsewhere) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "kitchen");
    std::string missing;
    EXPECT_EQ(input_of("kitchen", folder.path(), missing), (folder.path() / "kitchen").string());
    EXPECT_EQ(input_of(folder.path().string(), "/nowhere", missing), folder.path().string());
    EXPECT_EQ(missing, "");
    EXPECT_FALSE(input_of("moon", folder.path(), missing));
    EXPECT_NE(missing.find("moon"), std::string::npos);
    EXPECT_EQ(input_of("sim:office?seed=3", folder.path(), missing), "sim:office?seed=3");
    EXPECT_THROW(input_of("sim:moon", folder.path(), missing), std::invalid_argument);
}

TEST(TruePlanes, AreKnownOfSimulatedWorldsOnly) {
    EXPECT_FALSE(true_planes("redkitchen", 0));
    const std::string office = "sim:office?width=160&height=120&frames=60";
    const auto some = true_planes(office, 1), more = true_planes(office, 0);
    ASSERT_TRUE(some && more);
    EXPECT_GT(some->size(), 3u);
    EXPECT_GT(more->size(), some->size());
    for (const TruePlane& plane : *more) EXPECT_GT(plane.visible.count(), 0u) << plane.name;
}

}  // namespace
}  // namespace planemap::bench_map
