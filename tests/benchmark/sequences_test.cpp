// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/sequences.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "benchmark/rendering.hpp"
#include "core/trajectory.hpp"
#include "temporary_folder.hpp"

namespace planemap::benchmark {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<SequenceInfo> kKnown{{"redkitchen", "a kitchen", "", "", 100},
                                       {"sim:kt1", "a walk", "office?blur=4", "walks/kt1.txt", 0}};
const SequenceInfo kSmall{"sim:small", "", "office?width=64&height=48&jitter=0.009&frames=12", "", 0};

std::vector<std::string> names(const std::string& list, Unknown unknown = Unknown::kRefused) {
    std::vector<std::string> names;
    for (const SequenceInfo& sequence : parse_sequences(list, kKnown, unknown))
        names.push_back(sequence.name);
    return names;
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    return names;
}

TEST(ParseSequences, TakesKnownNamesAndSimulators) {
    EXPECT_EQ(parse_sequences("sim:kt1,redkitchen", kKnown).at(1).frames, 100);
    EXPECT_EQ(parse_sequences("sim:kt1", kKnown).at(0).poses, "walks/kt1.txt");
    EXPECT_EQ(parse_sequences("sim:office?seed=3", kKnown).at(0).simulator, "office?seed=3");
    EXPECT_THAT(error_of([] { names("redkitchen,moon"); }),
                AllOf(HasSubstr("\"moon\""), HasSubstr("sim:kt1")));
    EXPECT_THAT(names("redkitchen,moon", Unknown::kIsPath), ElementsAre("redkitchen", "moon"));
    EXPECT_THAT(error_of([] { names("sim:moon", Unknown::kIsPath); }), HasSubstr("moon"));
    EXPECT_THAT(error_of([] { names(""); }), HasSubstr("sequences: none given"));
}

TEST(ParseSequences, RangesAreSpelledOut) {
    EXPECT_THAT(names("sim:office?seed=9..11&frames=3,redkitchen"),
                ElementsAre("sim:office?seed=9&frames=3", "sim:office?seed=10&frames=3",
                            "sim:office?seed=11&frames=3", "redkitchen"));
    EXPECT_THAT(names("../shared/x..y", Unknown::kIsPath), ElementsAre("../shared/x..y"));
    EXPECT_THROW(names("sim:office?seed=5..1"), std::invalid_argument);
}

TEST(InputOf, IsInTheDataFolderOrElsewhere) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "kitchen");
    const auto input = [](const std::string& name, const std::filesystem::path& data) {
        return input_of({name, "", "", "", 0}, data);
    };
    EXPECT_EQ(input("kitchen", folder.path()), (folder.path() / "kitchen").string());
    EXPECT_EQ(input(folder.path().string(), "/nowhere"), folder.path().string());
    EXPECT_EQ(input_of(parse_sequences("sim:office?seed=3", {}).at(0), folder.path()), "sim:office?seed=3");
    folder.write("walks/kt1.txt", "");
    EXPECT_EQ(input_of(kKnown[1], folder.path()),
              "sim:office?blur=4&trajectory=" + (folder.path() / "walks/kt1.txt").string());
}

TEST(InputOf, WhatIsMissingIsNamed) {
    for (const SequenceInfo& sequence : kKnown) {
        EXPECT_THROW(input_of(sequence, "/no/such/data"), DataMissing);
        EXPECT_THAT(error_of([&] { input_of(sequence, "/no/such/data"); }),
                    AllOf(HasSubstr("/no/such/data/"), HasSubstr("PLANEMAP_DATA")));
    }
}

TEST(FileNameOf, HasNothingThatIsNoFileName) {
    EXPECT_EQ(file_name_of("sim:office"), "sim-office");
    EXPECT_EQ(file_name_of("office?seed=3&trajectory=/a/b.txt"), "office-seed-3-trajectory--a-b.txt");
}

TEST(RenderedLog, IsRenderedOnceAndKnowsTheTruthOfBothImages) {
    const TemporaryFolder folder;
    const std::filesystem::path cache = folder.path() / "cache";
    const auto rendered = [&](const SequenceInfo& sequence, std::int64_t frames) {
        return rendered_log(sequence, folder.path(), cache, frames, [](std::int64_t) {});
    };
    const std::filesystem::path first = rendered(kSmall, 0);
    std::filesystem::path truth = first;
    EXPECT_GT(read_trajectory(truth.replace_extension(".txt")).size(), 20u);
    const auto written = std::filesystem::last_write_time(first);
    EXPECT_EQ(rendered(kSmall, 0), first);
    EXPECT_EQ(std::filesystem::last_write_time(first), written);
    EXPECT_EQ(names_in(cache).size(), 2u);

    EXPECT_EQ(rendered(kSmall, 5), first) << "the whole one is there";
    SequenceInfo other = kSmall;
    other.simulator += "&seed=2";
    EXPECT_THAT(rendered(other, 5).string(), HasSubstr("-5.lcmlog"));
    EXPECT_EQ(names_in(cache).size(), 2u) << "logs of another simulation under this name go";
}

}  // namespace
}  // namespace planemap::benchmark
