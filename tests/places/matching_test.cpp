// SPDX-License-Identifier: BSD-3-Clause
#include "places/matching.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "places/synthetic.hpp"

namespace planemap::places {
namespace {

using namespace planemap::test;

TEST(Matching, HammingCountsBits) {
    Random random(1);
    for (int i = 0; i < 50; ++i) {
        const Descriptor a = random_descriptor(random), b = random_descriptor(random);
        int bits = 0;
        for (std::size_t k = 0; k < a.size(); ++k) bits += std::popcount(static_cast<unsigned>(a[k] ^ b[k]));
        EXPECT_EQ(hamming_distance(a, b), bits);
        EXPECT_EQ(hamming_distance(b, a), bits);
        EXPECT_EQ(hamming_distance(a, a), 0);
    }
}

TEST(Matching, FindsAShuffledNoisyCopy) {
    Random random(2);
    std::vector<Descriptor> a, b;
    for (int i = 0; i < 200; ++i) a.push_back(random_descriptor(random));
    for (int i = 0; i < 200; ++i) b.push_back(with_flips(a[static_cast<std::size_t>(199 - i)], 25, random));
    const auto matches = match(a, b, {});
    EXPECT_EQ(matches.size(), 200u);
    for (const Match& match : matches) EXPECT_EQ(match.second, 199 - match.first);
}

TEST(Matching, RandomDescriptorsDoNotMatch) {
    Random random(3);
    std::vector<Descriptor> a, b;
    for (int i = 0; i < 300; ++i) {
        a.push_back(random_descriptor(random));
        b.push_back(random_descriptor(random));
    }
    EXPECT_TRUE(match(a, b, {}).empty());
}

TEST(Matching, AmbiguousDescriptorsDoNotMatch) {
    Random random(4);
    const Descriptor one = random_descriptor(random);
    const std::vector<Descriptor> many(50, one), single(1, one);
    EXPECT_TRUE(match(many, many, {}).empty());
    EXPECT_TRUE(match(single, many, {}).empty());
    EXPECT_TRUE(match(many, single, {}).empty());
    EXPECT_EQ(match(single, single, {}).size(), 1u);
    EXPECT_TRUE(match(std::vector<Descriptor>{}, many, {}).empty());
    EXPECT_TRUE(match(many, std::vector<Descriptor>{}, {}).empty());
}

TEST(MatchAll, KeepsAllThatAreLike) {
    test::Random random(5);
    const Descriptor one = random_descriptor(random), other = random_descriptor(random);
    const std::vector<Descriptor> a{with_flips(one, 3, random), other, with_flips(one, 9, random), one};
    const std::vector<Descriptor> b{one, random_descriptor(random), other};
    std::vector<std::pair<int, int>> pairs;
    for (const Match& match : match_all(a, b, 20, 8)) pairs.emplace_back(match.first, match.second);
    EXPECT_EQ(pairs, (std::vector<std::pair<int, int>>{{3, 0}, {0, 0}, {2, 0}, {1, 2}}));
    EXPECT_EQ(match_all(a, b, 20, 2).size(), 3u);
    EXPECT_TRUE(match_all(a, {}, 20, 8).empty());
    EXPECT_TRUE(match_all({}, b, 20, 8).empty());
}

}  // namespace
}  // namespace planemap::places
