// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/rounds.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace planemap::benchmark {
namespace {

TEST(FramesARound, NeedsAWalkThatGoesRound) {
    EXPECT_THROW(frames_a_round("sim:office?visits=5"), std::invalid_argument);
    EXPECT_THROW(frames_a_round("redkitchen"), std::invalid_argument);
    const auto slow = frames_a_round("sim:office?width=64&height=48");
    EXPECT_GT(slow, 300);
    EXPECT_LT(frames_a_round("sim:office?width=64&height=48&speed=1&turn=90"), slow);
}

}  // namespace
}  // namespace planemap::benchmark
