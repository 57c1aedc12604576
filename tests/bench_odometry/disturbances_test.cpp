// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/disturbances.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace planemap::bench_odometry {
namespace {

constexpr Undisturbed kSource{200, 60, 30};

Script script_of(const std::string& name, const Undisturbed& source = kSource) {
    const auto& all = known_disturbances();
    return std::find_if(all.begin(), all.end(), [&](const Disturbance& one) { return one.name == name; })
        ->script(source);
}

bool is_as_it_was(const Shown& shown, std::size_t i) {
    return shown.at == i && shown.color == i && shown.depth == i && !shown.keeps_color_stamp &&
           shown.later_us == 0 && !shown.covered && shown.light == 1 && shown.smear == 0;
}

TEST(Disturbances, LeaveWhatIsBeforeTheFirstAlone) {
    std::set<std::string> names;
    for (const Disturbance& one : known_disturbances()) {
        EXPECT_TRUE(names.insert(one.name).second) << one.name;
        const Script script = one.script(kSource);
        ASSERT_GT(script.size(), kSource.first) << one.name;
        for (std::size_t i = 0; i < kSource.first; ++i)
            EXPECT_TRUE(is_as_it_was(script[i], i)) << one.name << " " << i;
        for (const Shown& shown : script)
            EXPECT_LT(std::max({shown.at, shown.color, shown.depth}), kSource.frames) << one.name;
    }
    for (std::size_t i = 0; i < kSource.frames; ++i) EXPECT_TRUE(is_as_it_was(script_of("none")[i], i));
}

TEST(Disturbances, EndWithTheSource) {
    constexpr Undisturbed kShort{6, 2, 30};
    for (const Disturbance& one : known_disturbances())
        for (const Shown& shown : one.script(kShort))
            EXPECT_LT(std::max({shown.at, shown.color, shown.depth}), kShort.frames) << one.name;
}

TEST(Disturbances, ShowOneImageAgain) {
    const Script color = script_of("color-10"), old = script_of("color-old-10");
    for (std::size_t i = 60; i < 70; ++i) {
        EXPECT_EQ(color[i].color, 59u);
        EXPECT_EQ(color[i].depth, i);
        EXPECT_FALSE(color[i].keeps_color_stamp);
        EXPECT_EQ(old[i].color, 59u);
        EXPECT_TRUE(old[i].keeps_color_stamp);
    }
    EXPECT_TRUE(is_as_it_was(color[70], 70));
    const Script both = script_of("both-30"), depth = script_of("depth-30"), turns = script_of("flicker");
    EXPECT_EQ(both[89].color, 59u);
    EXPECT_EQ(both[89].depth, 59u);
    EXPECT_EQ(depth[89].color, 89u);
    EXPECT_EQ(depth[89].depth, 59u);
    EXPECT_EQ(turns[60].color, 58u);
    EXPECT_EQ(turns[61].color, 59u);
    EXPECT_EQ(turns[62].color, 58u);
}

TEST(Disturbances, LastAsLongAsTheySay) {
    const auto covered = [](const Script& script) {
        return std::count_if(script.begin(), script.end(), [](const Shown& shown) { return shown.covered; });
    };
    EXPECT_EQ(covered(script_of("covered-1s")), 30);
    EXPECT_EQ(covered(script_of("covered-3s")), 90);
    EXPECT_EQ(covered(script_of("covered-3s", {200, 60, 10})), 30);
}

TEST(Disturbances, LightFallsStaysAndComesBack) {
    const Script dark = script_of("dark");
    for (std::size_t i = 60; i < 74; ++i) EXPECT_LT(dark[i + 1].light, dark[i].light);
    for (std::size_t i = 74; i < 105; ++i) EXPECT_NEAR(dark[i].light, 0.03, 1e-12) << i;
    for (std::size_t i = 105; i < 119; ++i) EXPECT_GT(dark[i + 1].light, dark[i].light);
    EXPECT_EQ(dark[120].light, 1);
}

TEST(Disturbances, StampsBeginAgain) {
    const Script restart = script_of("restart"), replay = script_of("replay");
    EXPECT_EQ(restart[60].at, 60u);
    EXPECT_EQ(restart[60].later_us, -2000000);
    EXPECT_EQ(restart.back().later_us, -2000000);
    ASSERT_EQ(replay.size(), 120u);
    for (std::size_t i = 60; i < 120; ++i) EXPECT_TRUE(is_as_it_was(replay[i], i - 60));
}

TEST(Returns, ComeAfterPausesFromAllOverTheRest) {
    constexpr std::int64_t kPause_us = 180000000;
    const Script script = returns(100, 80, 5, 12, kPause_us, 30);
    ASSERT_EQ(script.size(), 160u);
    for (std::size_t i = 0; i < 100; ++i) EXPECT_TRUE(is_as_it_was(script[i], i));
    EXPECT_EQ(script[100].at, 100u);
    EXPECT_EQ(script.back().at, 179u);
    const auto stamp = [&](std::size_t i) {
        return static_cast<double>(script[i].at) / 30 + static_cast<double>(script[i].later_us) / 1e6;
    };
    for (std::size_t i = 100; i < script.size(); ++i) {
        const bool is_first = (i - 100) % 12 == 0;
        EXPECT_NEAR(stamp(i) - stamp(i - 1), (is_first ? 180 : 0) + 1.0 / 30, 1e-5) << i;
    }
}

}  // namespace
}  // namespace planemap::bench_odometry
