// SPDX-License-Identifier: BSD-3-Clause
#include "messages/stream_guard.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "messages/told_status.hpp"

namespace planemap::messages {
namespace {

class Admission : public testing::Test {
  protected:
    bool admits(std::int32_t seq, std::uint8_t sender = 0) {
        const std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(seq), sender};
        return guard_.admits(0, seq, 1000000 + 500000 * std::int64_t{seq} + sender, bytes);
    }
    ModuleStatus status_{"graph"};
    StreamGuard guard_{"PLANEMAP_KEYFRAME", "keyframes", status_};
};

TEST_F(Admission, ARepeatedMessageIsNotUsedAndNoLossBesideTheMainStream) {
    StreamGuard trajectories("PLANEMAP_TRAJECTORY", "trajectories", status_, false);
    const std::vector<std::uint8_t> bytes{1}, more{2};
    EXPECT_TRUE(trajectories.admits(0, 0, std::nullopt, bytes));
    EXPECT_FALSE(trajectories.admits(0, 0, std::nullopt, bytes));
    EXPECT_FALSE(trajectories.admits(0, 0, std::nullopt, bytes));
    EXPECT_TRUE(trajectories.admits(0, 1, std::nullopt, more));
    EXPECT_EQ(test::told(status_).received, 0) << "not the main stream";
    EXPECT_EQ(test::told(status_).dropped, 0);
    EXPECT_TRUE(status_.losses().empty());
    // Of the main stream nobody sends a message again but an old log.
    EXPECT_TRUE(admits(0));
    EXPECT_FALSE(admits(0));
    EXPECT_TRUE(admits(1));
    EXPECT_EQ(test::told(status_).received, 2);
    EXPECT_EQ(status_.losses().at("keyframes that came twice"), 1);
}

TEST_F(Admission, WhatAnotherSenderSaysIsCountedAndNamed) {
    for (int i = 50; i < 60; ++i) EXPECT_TRUE(admits(i));
    for (int i = 0; i < 10; ++i) {
        EXPECT_FALSE(admits(i, 1)) << "an old log's results among the new";
        EXPECT_TRUE(admits(60 + i));
    }
    EXPECT_EQ(status_.losses().at("keyframes of another sender"), 9);
    EXPECT_EQ(status_.losses().at("keyframes from before those that came"), 1);
    EXPECT_EQ(test::told(status_).dropped, 10);
}

TEST_F(Admission, NumbersOrderASendersMessagesWhereItsTimeGoesBack) {
    // An odometry whose input began again: each of its keyframes counts, the first ones too.
    for (const std::int64_t session : {0, 7}) {
        StreamGuard guard("PLANEMAP_KEYFRAME", "keyframes", status_);
        for (int i = 0; i < 20; ++i) {
            const std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(i)};
            EXPECT_TRUE(guard.admits(session, i, 1000000 + 500000 * std::int64_t{i % 10}, bytes)) << i;
        }
    }
    EXPECT_TRUE(status_.losses().empty());
    EXPECT_EQ(test::told(status_).dropped, 0);
}

TEST_F(Admission, SessionsTellTwoSendersOfTheSameNumbersAndTimesApart) {
    for (int i = 0; i < 10; ++i) {
        const std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(i)};
        const std::int64_t utime = 1000000 + 500000 * std::int64_t{i};
        EXPECT_TRUE(guard_.admits(7, i, utime, bytes));
        EXPECT_FALSE(guard_.admits(8, i, utime, bytes)) << "the first one lives";
        EXPECT_FALSE(guard_.admits(0, i, utime, bytes)) << "one that does not say";
    }
    EXPECT_EQ(status_.losses().at("keyframes of another sender"), 20);
    EXPECT_EQ(test::told(status_).received, 10);
    // The first one is gone.
    int admitted = 0;
    for (int i = 10; i < 20; ++i) {
        const std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(i)};
        admitted += guard_.admits(8, i, 1000000 + 500000 * std::int64_t{i}, bytes);
    }
    EXPECT_GE(admitted, 5);
}

TEST_F(Admission, ALateOneIsAdmitted) {
    for (const int i : {0, 1, 3, 2, 4}) EXPECT_TRUE(admits(i));
    EXPECT_TRUE(status_.losses().empty());
}

TEST_F(Admission, BesideTheMainStreamALateOneIsOutdated) {
    StreamGuard trajectories("PLANEMAP_TRAJECTORY", "trajectories", status_, false);
    const auto admits = [&](int seq) {
        return trajectories.admits(7, seq, std::nullopt,
                                   std::vector<std::uint8_t>{static_cast<std::uint8_t>(seq)});
    };
    for (const int seq : {0, 1, 2, 4, 5}) EXPECT_TRUE(admits(seq));
    EXPECT_FALSE(admits(3)) << "the map would go back to it";
    EXPECT_FALSE(admits(1));
    EXPECT_TRUE(admits(6));
    std::int64_t lost = 0;
    for (const auto& [what, count] : status_.losses()) lost += count;
    EXPECT_EQ(lost, 2);
    EXPECT_EQ(test::told(status_).dropped, 0);
}

}  // namespace
}  // namespace planemap::messages
