// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/sequences.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/simulated_source.hpp"
#include "temporary_folder.hpp"

namespace planemap::bench_odometry {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const SequenceInfo kSmall{"sim:small", "", "office?width=64&height=48&jitter=0.009&frames=12", ""};

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    return names;
}

TEST(KnownSequences, AllSimulatedOnesCanBeRead) {
    for (const SequenceInfo& info : known_sequences()) {
        const std::string name = "sim:" + (info.simulator.empty() ? "office" : info.simulator);
        EXPECT_NO_THROW(simulator::parse_simulator_name(name)) << info.name;
    }
    EXPECT_THAT(test::error_of([] { parse_sequences("redkitchen,moon"); }),
                AllOf(HasSubstr("\"moon\""), HasSubstr("sim:twins")));
    EXPECT_EQ(parse_sequences("sim:kt1,redkitchen").at(1).name, "redkitchen");
}

TEST(OpenSequence, RendersOnceAndKnowsTheTruthOfBothImages) {
    const test::TemporaryFolder folder;
    const SequenceOptions options{folder.path(), folder.path() / "cache", 0};
    std::string missing;
    const auto open = [&](const SequenceInfo& info, const SequenceOptions& how) {
        return open_sequence(
            info, how, [](std::int64_t) {}, missing);
    };
    const auto first = open(kSmall, options);
    ASSERT_TRUE(first && first->truth);
    EXPECT_EQ(missing, "");
    EXPECT_GT(first->truth->size(), 20u);
    const auto written = std::filesystem::last_write_time(first->input);
    EXPECT_EQ(open(kSmall, options)->input, first->input);
    EXPECT_EQ(std::filesystem::last_write_time(first->input), written);
    EXPECT_EQ(names_in(options.cache).size(), 2u);

    SequenceOptions few = options;
    few.frames = 5;
    EXPECT_EQ(open(kSmall, few)->input, first->input) << "the whole one is there";
    SequenceInfo other = kSmall;
    other.simulator += "&seed=2";
    const auto part = open(other, few);
    EXPECT_THAT(part->input, HasSubstr("-5.lcmlog"));
    EXPECT_EQ(names_in(options.cache).size(), 2u) << "logs of another simulation under this name go";
}

TEST(OpenSequence, WhatIsMissingIsNamed) {
    std::string missing;
    const SequenceOptions options{"/no/such/data", "/tmp", 0};
    for (const char* name : {"redkitchen", "sim:kt2"}) {
        EXPECT_FALSE(open_sequence(
            parse_sequences(name).at(0), options, [](std::int64_t) {}, missing));
        EXPECT_THAT(missing, HasSubstr("/no/such/data/"));
    }
}

}  // namespace
}  // namespace planemap::bench_odometry
