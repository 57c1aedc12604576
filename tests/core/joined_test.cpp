// SPDX-License-Identifier: BSD-3-Clause
#include "core/joined.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

TEST(Joined, NamesStandBetweenCommas) {
    EXPECT_EQ(joined({}), "");
    EXPECT_EQ(joined({"one"}), "one");
    EXPECT_EQ(joined({"one", "two", "three"}), "one, two, three");
}

}  // namespace
}  // namespace planemap
