// SPDX-License-Identifier: BSD-3-Clause
#include "core/processor_time.hpp"

#include <gtest/gtest.h>

namespace planemap {
namespace {

TEST(ProcessorTime, IsOfUserAndSystem) {
    rusage usage = {};
    EXPECT_EQ(processor_seconds(usage), 0);
    usage.ru_utime = {2, 250000};
    usage.ru_stime = {1, 500000};
    EXPECT_DOUBLE_EQ(processor_seconds(usage), 3.75);
}

}  // namespace
}  // namespace planemap
