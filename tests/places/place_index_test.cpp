// SPDX-License-Identifier: BSD-3-Clause
#include "places/place_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "places/synthetic.hpp"

namespace planemap::places {
namespace {

using namespace planemap::test;

std::vector<Descriptor> descriptors(Random& random, int count) {
    std::vector<Descriptor> all;
    for (int i = 0; i < count; ++i) all.push_back(random_descriptor(random));
    return all;
}

TEST(PlaceIndex, FindsThePlaceSeenAgainAmongMany) {
    Random random(1);
    PlaceIndex index;
    std::vector<std::vector<Descriptor>> places;
    for (int i = 0; i < 200; ++i) {
        places.push_back(descriptors(random, 150));
        index.add(places.back());
    }
    EXPECT_EQ(index.size(), 200);
    for (const std::size_t place : {std::size_t{0}, std::size_t{77}, std::size_t{199}}) {
        std::vector<Descriptor> again = descriptors(random, 75);  // half of it is new
        for (std::size_t i = 0; i < 75; ++i) again.push_back(with_flips(places[place][i], 20, random));
        const auto scores = index.scores(again);
        ASSERT_EQ(scores.size(), 200u);
        const auto best = std::max_element(scores.begin(), scores.end());
        EXPECT_EQ(static_cast<std::size_t>(best - scores.begin()), place);
        std::vector<double> sorted = scores;
        std::sort(sorted.begin(), sorted.end());
        EXPECT_GT(sorted[199], 3 * sorted[198]);
    }
}

TEST(PlaceIndex, ScoresAreShares) {
    Random random(2);
    PlaceIndex index;
    const auto place = descriptors(random, 100);
    index.add(place);
    index.add(descriptors(random, 100));
    EXPECT_NEAR(index.scores(place)[0], 1.0, 1e-9);
    EXPECT_LT(index.scores(place)[1], 0.05);
}

TEST(PlaceIndex, WhatIsEverywhereTellsNothing) {
    Random random(3);
    PlaceIndex index;
    const auto everywhere = descriptors(random, 50);
    for (int i = 0; i < 100; ++i) index.add(everywhere);
    for (const double score : index.scores(everywhere)) EXPECT_EQ(score, 0.0);
}

TEST(PlaceIndex, WhatIsSeenForeverTakesNoMoreMemory) {
    Random random(5);
    PlaceIndex index;
    const auto room = descriptors(random, 50), poster = descriptors(random, 20);
    index.add(poster);
    for (int i = 0; i < 300; ++i) index.add(room);
    const std::size_t bytes = index.memory_bytes();
    for (int i = 0; i < 2000; ++i) index.add(room);
    EXPECT_EQ(index.memory_bytes(), bytes);
    EXPECT_GT(index.scores(poster)[0], 0.9) << "what is rare is still found";
}

TEST(PlaceIndex, WhatIsRemovedIsForgottenAndItsNumberGivenAgain) {
    Random random(6);
    PlaceIndex index;
    const auto hall = descriptors(random, 50), room = descriptors(random, 50), yard = descriptors(random, 50);
    EXPECT_EQ(index.add(hall), 0);
    EXPECT_EQ(index.add(room), 1);
    const std::size_t bytes = index.memory_bytes();
    index.remove(0, hall);
    EXPECT_EQ(index.size(), 1);
    EXPECT_EQ(index.scores(hall)[0], 0.0);
    EXPECT_GT(index.scores(room)[1], 0.9);
    EXPECT_EQ(index.add(yard), 0);
    EXPECT_GT(index.scores(yard)[0], 0.9);
    for (int i = 0; i < 1000; ++i) {
        index.remove(0, yard);
        index.add(yard);
    }
    EXPECT_LE(index.memory_bytes(), bytes + 100) << "what comes and goes takes no more memory";
}

TEST(PlaceIndex, EmptyIndexAndEmptyViews) {
    Random random(4);
    PlaceIndex index;
    EXPECT_TRUE(index.scores(descriptors(random, 10)).empty());
    index.add({});
    EXPECT_EQ(index.scores(descriptors(random, 10)), std::vector<double>{0.0});
    EXPECT_EQ(index.scores({}), std::vector<double>{0.0});
}

}  // namespace
}  // namespace planemap::places
