// SPDX-License-Identifier: BSD-3-Clause
#include "messages/remarks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace planemap::messages {
namespace {

TEST(Remarks, ALaterOneOfItsKindTakesThePlaceOfTheEarlier) {
    Remarks remarks;
    remarks.set("part", "a first part");
    remarks.set("journal", "a full disk");
    remarks.set("part", "a second part");
    EXPECT_THAT(remarks.texts(), testing::ElementsAre("a full disk", "a second part"));
    remarks.set("journal", "");
    EXPECT_THAT(remarks.texts(), testing::ElementsAre("a second part"));
}

TEST(Remarks, TheFirstOfAKindIsWarnedOfAndThenEachTenTimesRarer) {
    Remarks remarks;
    for (int i = 1; i <= 1000; ++i)
        EXPECT_EQ(remarks.set("part", "part " + std::to_string(i)),
                  i == 1 || i == 10 || i == 100 || i == 1000)
            << i;
    EXPECT_TRUE(remarks.set("journal", "a full disk")) << "another kind";
    EXPECT_FALSE(remarks.set("other", "")) << "nothing to warn of";
}

}  // namespace
}  // namespace planemap::messages
