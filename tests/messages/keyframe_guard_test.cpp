// SPDX-License-Identifier: BSD-3-Clause
#include "messages/keyframe_guard.hpp"

#include <gtest/gtest.h>

#include "messages/convert.hpp"
#include "messages/told_status.hpp"

namespace planemap::messages {
namespace {

keyframe_t keyframe(int id, std::int64_t session) {
    keyframe_t message{};
    message.id = message.seq = id;
    message.utime = 1000000 + 500000 * std::int64_t{id};
    message.session = session;
    return message;
}

bool admits(KeyframeGuard& guard, const keyframe_t& message, bool is_known = false) {
    const bool admitted = guard.admits(message, to_bytes(message), is_known);
    if (admitted) guard.took(message);
    return admitted;
}

TEST(KeyframeGuard, WhatOdometrySendsAgainIsCountedAndNotUsed) {
    ModuleStatus status("map");
    KeyframeGuard guard(status);
    EXPECT_TRUE(admits(guard, keyframe(0, 7)));
    EXPECT_TRUE(admits(guard, keyframe(1, 7)));
    EXPECT_FALSE(admits(guard, keyframe(0, 7), true));
    EXPECT_TRUE(admits(guard, keyframe(2, 7)));
    EXPECT_EQ(status.losses().at("keyframes that came twice"), 1);
    EXPECT_EQ(guard.session(), 7);
    EXPECT_EQ(test::told(status).received, 3);
}

TEST(KeyframeGuard, AnIdIsKnownInItsSessionAlone) {
    ModuleStatus status("map");
    KeyframeGuard guard(status);
    EXPECT_TRUE(admits(guard, keyframe(0, 0)));
    EXPECT_TRUE(admits(guard, keyframe(1, 0), true)) << "without a session nobody sends on purpose again";
    EXPECT_EQ(status.losses().count("keyframes that came twice"), 0u);
}

TEST(KeyframeGuard, GoesOnWhereTheProcessBeforeEnded) {
    ModuleStatus status("map");
    KeyframeGuard guard(status);
    const keyframe_t newest = keyframe(5, 7);
    guard.resume(newest, to_bytes(newest));
    EXPECT_EQ(guard.session(), 7);
    EXPECT_EQ(test::told(status).received, 0);
    EXPECT_FALSE(admits(guard, newest, true));
    EXPECT_FALSE(admits(guard, keyframe(6, 8))) << "another sender, beside the one that lives";
    EXPECT_TRUE(admits(guard, keyframe(6, 7)));
}

}  // namespace
}  // namespace planemap::messages
