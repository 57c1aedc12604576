// SPDX-License-Identifier: BSD-3-Clause
#include "map/plane_ids.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

namespace planemap::map {
namespace {

using ::testing::Pair;
using ::testing::UnorderedElementsAre;

TEST(PlaneIds, AreNewEachTime) {
    PlaneIds ids;
    EXPECT_EQ(ids.next(), 0);
    EXPECT_EQ(ids.next(), 1);
    ids.reserve(7);
    EXPECT_EQ(ids.upcoming(), 8);
    ids.reserve(3);
    EXPECT_EQ(ids.next(), 8) << "an id that is taken below does not matter";
}

/// Ids handed out for planes made anew.
std::vector<int> provisional(PlaneIds& ids, int count) {
    std::vector<int> now;
    for (int i = 0; i < count; ++i) now.push_back(ids.next());
    return now;
}

TEST(PlaneIds, TheStrongestClaimWinsAndEachIdGoesOnce) {
    PlaneIds ids;
    ids.reserve(9);
    const int first = ids.upcoming();
    const std::vector<int> now = provisional(ids, 3);  // 10, 11, 12
    // 11 has most of what was in 4; 10 has the rest of it and some of 5; 12 has none.
    const PlaneIds::Votes votes{{{4, 10}, 40}, {{4, 11}, 60}, {{5, 10}, 30}};
    EXPECT_THAT(ids.carry_over(now, {}, votes, first),
                UnorderedElementsAre(Pair(11, 4), Pair(10, 5), Pair(12, 10)));
    EXPECT_EQ(ids.upcoming(), 11) << "provisional ids that nobody bears are given back";
}

TEST(PlaneIds, KeptOnesKeepTheirsWhateverTheVotes) {
    PlaneIds ids;
    ids.reserve(5);
    const int first = ids.upcoming();
    std::vector<int> now{2};
    now.push_back(ids.next());
    const PlaneIds::Votes votes{{{2, 6}, 1000}, {{5, 2}, 1000}};
    EXPECT_THAT(ids.carry_over(now, {2, 3}, votes, first), UnorderedElementsAre(Pair(2, 2), Pair(6, 6)));
}

TEST(PlaneIds, NoIdIsGivenTwiceAndNoneThatIsGoneComesAgain) {
    std::mt19937_64 random(2);
    PlaneIds ids;
    std::set<int> before, ever;
    for (int round = 0; round < 50; ++round) {
        const int first = ids.upcoming();
        const std::vector<int> now = provisional(ids, 1 + static_cast<int>(random() % 8));
        PlaneIds::Votes votes;
        for (const int a : before)
            for (const int b : now)
                if (random() % 3 == 0) votes[{a, b}] = static_cast<double>(random() % 100);
        const std::map<int, int> id_of = ids.carry_over(now, {}, votes, first);
        std::set<int> given;
        for (const int id : now) {
            EXPECT_TRUE(given.insert(id_of.at(id)).second) << "twice";
            EXPECT_TRUE(before.contains(id_of.at(id)) || !ever.contains(id_of.at(id)))
                << "an id of a plane that is gone";
        }
        before = given;
        ever.insert(given.begin(), given.end());
    }
}

TEST(PlaneIds, OfNoPlanes) {
    PlaneIds ids;
    EXPECT_TRUE(ids.carry_over({}, {1, 2}, {}, 0).empty());
    EXPECT_EQ(ids.upcoming(), 0);
}

}  // namespace
}  // namespace planemap::map
