// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/spread.hpp"

#include <gtest/gtest.h>

namespace planemap::evaluation {
namespace {

std::vector<int> spread(int length, std::size_t most) {
    Spread<int> spread(most);
    for (int i = 0; i < length; ++i)
        if (spread.wants_next()) spread.add(i);
    return spread.kept();
}

TEST(Spread, KeepsAllOfFew) {
    EXPECT_TRUE(spread(0, 4).empty());
    EXPECT_EQ(spread(4, 4), (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(spread(3, 2), (std::vector<int>{0, 2}));
}

TEST(Spread, OfManyItKeepsEveryNth) {
    for (const std::size_t most : {2, 3, 7, 100, 199}) {
        for (const int length : {5, 100, 200, 201, 1000, 4097}) {
            const std::vector<int> kept = spread(length, most);
            ASSERT_LE(kept.size(), most);
            ASSERT_GE(2 * kept.size(), std::min<std::size_t>(most, static_cast<std::size_t>(length)));
            EXPECT_EQ(kept.front(), 0);
            for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_EQ(kept[i], static_cast<int>(i) * kept[1]);
            ASSERT_GT(kept.size(), 1u);
            EXPECT_LT(length - 1 - kept.back(), kept[1]);
        }
    }
}

}  // namespace
}  // namespace planemap::evaluation
