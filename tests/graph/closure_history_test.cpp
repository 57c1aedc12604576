// SPDX-License-Identifier: BSD-3-Clause
#include "graph/closure_history.hpp"

#include <gtest/gtest.h>

namespace planemap::graph {
namespace {

LoopClosure closure(int to_id) {
    LoopClosure closure;
    closure.to_id = to_id;
    return closure;
}

TEST(ClosureHistoryTest, NumbersThemInTheOrderTheyCome) {
    ClosureHistory history;
    EXPECT_EQ(history.count(), 0);
    EXPECT_TRUE(history.newest().empty());
    for (int i = 0; i < 3; ++i) EXPECT_EQ(history.add(closure(i)), i);
    EXPECT_EQ(history.count(), 3);
    history.set_weight(1, 0.25);
    EXPECT_EQ(history.newest()[1].weight, 0.25);
    EXPECT_EQ(history.newest()[2].weight, 1);
}

TEST(ClosureHistoryTest, OfManyTheNewestAreRememberedByTheirNumbers) {
    ClosureHistory history;
    for (int i = 0; i < 2000; ++i) {
        EXPECT_EQ(history.add(closure(i)), i);
        EXPECT_EQ(history.count(), i + 1);
        EXPECT_LE(history.newest().size(), 512u);
        EXPECT_GE(history.newest().size(), i < 512 ? 1u : 256u);
    }
    EXPECT_EQ(history.newest().back().to_id, 1999);
    history.set_weight(1999, 0.5);
    EXPECT_EQ(history.newest().back().weight, 0.5);
}

TEST(ClosureHistoryTest, AWeightOfOneThatIsNotRememberedIsIgnored) {
    ClosureHistory history;
    for (int i = 0; i < 513; ++i) history.add(closure(i));
    for (const int number : {-1, 0, 255, 513}) history.set_weight(number, 0.5);
    for (const LoopClosure& kept : history.newest()) EXPECT_EQ(kept.weight, 1);
    history.set_weight(256, 0.5);
    EXPECT_EQ(history.newest().front().weight, 0.5);
}

}  // namespace
}  // namespace planemap::graph
