// SPDX-License-Identifier: BSD-3-Clause
#include "run/worth.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(RunWorth, ASoundRunReplacesAnyAndAnyReplacesOnlyWhatIsWorse) {
    const RunWorth sound{60, 60, false}, few{60, 10, false}, stopped{40, 40, true}, none{60, 0, false};
    for (const RunWorth& earlier : {sound, few, stopped, none})
        EXPECT_THAT(why_not_replace({60, 30, false}, earlier), IsEmpty()) << "half is enough";
    EXPECT_THAT(why_not_replace(sound, std::nullopt), IsEmpty());

    EXPECT_THAT(why_not_replace(few, sound), HasSubstr("only 10 of its 60 frames tracked"));
    EXPECT_THAT(why_not_replace(none, sound), HasSubstr("none of its 60 frames"));
    EXPECT_THAT(why_not_replace({0, 0, false}, sound), HasSubstr("none of its 0 frames"));
    EXPECT_THAT(why_not_replace(stopped, sound), HasSubstr("before the end of its input, 40 of 40 frames"));
    EXPECT_THAT(why_not_replace({1000, 900, true}, sound), Not(IsEmpty())) << "the earlier one is whole";
    for (const RunWorth& run : {few, stopped, none})
        EXPECT_THAT(why_not_replace(run, std::nullopt), Not(IsEmpty()))
            << "nothing is known of the earlier one";

    EXPECT_THAT(why_not_replace(stopped, few), IsEmpty());
    EXPECT_THAT(why_not_replace(stopped, stopped), IsEmpty());
    EXPECT_THAT(why_not_replace(few, stopped), Not(IsEmpty()));
    EXPECT_THAT(why_not_replace(none, none), IsEmpty());
}

TEST(RunWorth, IsReadFromAReportWhereThereIsOne) {
    const test::TemporaryFolder folder;
    EXPECT_FALSE(worth_in(folder.path()));
    const auto with = [&](const std::string& bytes) {
        write_file(folder / "report.json", bytes);
        return worth_in(folder.path());
    };
    for (const char* broken : {"", "{", "[1]", "{}", R"({"frames": "many", "tracked": 3})",
                               R"({"frames": 4, "tracked": 3, "interrupted": 1})"})
        EXPECT_FALSE(with(broken)) << broken;
    const auto earlier = with(R"({"frames": 4, "tracked": 3})");
    ASSERT_TRUE(earlier);
    EXPECT_EQ(earlier->tracked, 3);
    EXPECT_TRUE(earlier->is_sound());
    EXPECT_TRUE(with(R"({"frames": 4, "tracked": 3, "interrupted": true})")->interrupted);
}

}  // namespace
}  // namespace planemap
