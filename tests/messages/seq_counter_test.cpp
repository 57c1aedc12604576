// SPDX-License-Identifier: BSD-3-Clause
#include "messages/seq_counter.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace planemap::messages {
namespace {

SeqCounter counted(const std::vector<std::uint32_t>& seqs) {
    SeqCounter counter;
    for (const std::uint32_t seq : seqs) counter.add(seq);
    return counter;
}

TEST(SeqCounter, CountsWhatIsMissing) {
    EXPECT_EQ(counted({}).missed(), 0);
    EXPECT_EQ(counted({7, 8, 9}).missed(), 0) << "whatever the first is";
    EXPECT_EQ(counted({0, 1, 4, 5, 7}).missed(), 3);
    EXPECT_EQ(counted({0xfffffffe, 0xffffffff, 0, 2}).missed(), 1) << "over the wrap-around";
}

TEST(SeqCounter, LateArrivalsTakeTheirGapBackOnce) {
    EXPECT_EQ(counted({0, 1, 3, 2, 4}).missed(), 0);
    EXPECT_EQ(counted({0, 1, 4, 2, 5}).missed(), 1);
    EXPECT_EQ(counted({0, 1, 4, 2, 2, 4, 4, 5}).missed(), 1) << "twice is once";
    EXPECT_EQ(counted({5, 3, 4, 6}).missed(), 0) << "from before the start";
}

TEST(SeqCounter, AStrayNumberIsNoGapAndARestartNeither) {
    EXPECT_EQ(counted({35510, 0, 35511, 35512}).missed(), 0);
    EXPECT_EQ(counted({10, 35510, 11, 12}).missed(), 0);
    const SeqCounter again = counted({1000, 1001, 0, 1, 2, 4});
    EXPECT_EQ(again.missed(), 1);
    EXPECT_EQ(again.restarts(), 1);
}

TEST(SeqCounter, ALongOutageIsCountedOnceItIsSure) {
    EXPECT_EQ(counted({10, 11, 1000}).missed(), 0);
    const SeqCounter back = counted({10, 11, 1000, 1001});
    EXPECT_EQ(back.missed(), 988);
    EXPECT_EQ(back.restarts(), 0);
}

}  // namespace
}  // namespace planemap::messages
