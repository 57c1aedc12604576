// SPDX-License-Identifier: BSD-3-Clause
#include "messages/sender_guard.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace planemap::messages {
namespace {

using Message = SenderGuard::Message;
using Verdict = SenderGuard::Verdict;

constexpr std::int64_t kStep_us = 33333;

/// A sender of frames; every message's bytes are others.
struct Sender {
    std::optional<std::uint64_t> id = std::nullopt;
    bool numbered = true;
    std::int64_t utime = 0;
    std::uint32_t seq = 0;
    std::uint32_t salt = 0;
    std::optional<std::uint32_t> kind = std::nullopt;

    Message next(std::int64_t step_us = kStep_us) {
        Message message{id, kind, std::nullopt, utime, salt * 1000000 + seq};
        if (numbered) message.seq = seq;
        ++seq;
        utime += step_us;
        return message;
    }
};

class Guard : public testing::Test {
  protected:
    Verdict judge(const Message& message) {
        const Verdict verdict = guard_.judge(message);
        ++count_[verdict];
        if (!guard_.news().empty()) news_.push_back(guard_.news());
        return verdict;
    }
    bool said(const std::string& words) const {
        return std::any_of(news_.begin(), news_.end(),
                           [&](const auto& line) { return line.find(words) != std::string::npos; });
    }
    SenderGuard guard_{"OPENNI_FRAME"};
    std::map<Verdict, int> count_;
    std::vector<std::string> news_;
};

TEST_F(Guard, TakesAStreamWithPausesAndGaps) {
    for (const bool numbered : {true, false}) {
        guard_ = SenderGuard("OPENNI_FRAME");
        count_.clear();
        Sender sender{.numbered = numbered, .utime = 1000};
        for (int i = 0; i < 100; ++i) {
            judge(sender.next(i % 10 == 0 ? 1500000 : kStep_us));
            if (i % 7 == 0) sender.next();  // lost on the way
        }
        EXPECT_EQ(count_[Verdict::kTake], 100);
    }
    // Stills, by hand, some seconds to a minute apart.
    Sender stills{.numbered = false};
    guard_ = SenderGuard("OPENNI_FRAME");
    count_.clear();
    for (const int seconds : {5, 9, 3, 60, 7, 12, 31, 2}) judge(stills.next(seconds * 1000000));
    EXPECT_EQ(count_[Verdict::kTake], 8);
    EXPECT_TRUE(news_.empty()) << news_[0];
}

TEST_F(Guard, ALongPauseCostsAMessageOnlyWhereNothingTiesTheStream) {
    for (const bool numbered : {true, false}) {
        guard_ = SenderGuard("OPENNI_FRAME");
        count_.clear();
        Sender sender{.numbered = numbered};
        for (int i = 0; i < 20; ++i) judge(sender.next(i == 9 ? 3600000000 : kStep_us));
        EXPECT_EQ(count_[Verdict::kTake], numbered ? 20 : 19);
        EXPECT_EQ(count_[Verdict::kJumped], numbered ? 0 : 1);
    }
}

TEST_F(Guard, WhatComesLateOrTwiceIsToldApartFromTimeThatGoesBack) {
    for (const bool numbered : {true, false}) {
        guard_ = SenderGuard("OPENNI_FRAME");
        count_.clear();
        Sender sender{.numbered = numbered};
        std::vector<Message> messages;
        for (int i = 0; i < 30; ++i) messages.push_back(sender.next());
        std::swap(messages[9], messages[10]);
        std::swap(messages[20], messages[22]);  // the middle one is late too
        messages.insert(messages.begin() + 15, messages[14]);
        for (const Message& message : messages) judge(message);
        EXPECT_EQ(count_[Verdict::kTake], 27);
        EXPECT_EQ(count_[Verdict::kLate], 3);
        EXPECT_EQ(count_[Verdict::kRepeated], 1);
        EXPECT_EQ(guard_.switches(), 0);
    }
}

TEST_F(Guard, StampsThatDecreaseAreSaidOnceWithAFigure) {
    for (const bool numbered : {true, false}) {
        guard_ = SenderGuard("OPENNI_FRAME");
        count_.clear();
        news_.clear();
        Sender sender{.numbered = numbered, .utime = 100000000};
        for (int i = 0; i < 40; ++i) judge(sender.next(-kStep_us));
        EXPECT_EQ(count_[Verdict::kTake], 1);
        EXPECT_GE(count_[Verdict::kWentBack], 37);
        ASSERT_EQ(news_.size(), 1u);
        EXPECT_TRUE(said("went back by 0.")) << news_[0];
    }
}

TEST_F(Guard, AStreamThatStartsAgainIsFollowedAndSaid) {
    for (const bool numbered : {true, false}) {
        guard_ = SenderGuard("OPENNI_FRAME");
        count_.clear();
        news_.clear();
        Sender first{.numbered = numbered, .utime = 50000000}, again{.numbered = numbered, .utime = 20000000};
        for (int i = 0; i < 30; ++i) judge(first.next());
        for (int i = 0; i < 30; ++i) judge(again.next());
        EXPECT_EQ(count_[Verdict::kTake], 58);
        EXPECT_EQ(count_[Verdict::kWentBack], 2);
        EXPECT_EQ(guard_.switches(), 1);
        EXPECT_TRUE(said("went back by 30.9"));
    }
}

TEST_F(Guard, ASecondSenderIsNamedAndIgnoredWhileTheFirstLives) {
    struct Case {
        Sender first, second;
        const char* what;
    };
    const std::int64_t hour = 3600000000;
    const Case cases[] = {
        {{.id = 1}, {.id = 2, .utime = 500, .salt = 1}, "ids, the same clock, the same numbers"},
        {{.id = 1}, {.utime = 500, .salt = 1}, "an id and none"},
        {{.utime = hour}, {.utime = 0, .seq = 9000, .salt = 1}, "behind, numbered"},
        {{.numbered = false, .utime = hour}, {.numbered = false, .salt = 1}, "behind, not numbered"},
        {{.numbered = false, .kind = 1},
         {.numbered = false, .utime = 500, .salt = 1, .kind = 2},
         "other images"},
    };
    for (Case c : cases) {
        guard_ = SenderGuard("OPENNI_FRAME");
        count_.clear();
        news_.clear();
        for (int i = 0; i < 10; ++i) ASSERT_EQ(judge(c.first.next()), Verdict::kTake);
        count_.clear();
        for (int i = 0; i < 200; ++i) {
            ASSERT_EQ(judge(c.first.next()), Verdict::kTake) << c.what;
            ASSERT_NE(judge(c.second.next()), Verdict::kTake) << c.what;
        }
        EXPECT_GE(count_[Verdict::kForeign], 199) << c.what;
        const bool told_apart = c.first.id || c.first.kind;
        EXPECT_TRUE(said(told_apart ? "another sender on OPENNI_FRAME is ignored"
                                    : "another sender or messages out of order on OPENNI_FRAME"))
            << c.what;
        EXPECT_LE(news_.size(), 2u) << c.what;
        // The first falls silent: two seconds of the other, then that one.
        count_.clear();
        for (int i = 0; i < 90; ++i) judge(c.second.next());
        EXPECT_NEAR(count_[Verdict::kTake], 30, 2) << c.what;
        EXPECT_EQ(guard_.switches(), 1) << c.what;
        EXPECT_TRUE(said("another one is followed")) << c.what;
    }
}

TEST_F(Guard, ASecondSenderAheadInTimeDoesNotOustTheFirst) {
    Sender first{.numbered = false}, second{.numbered = false, .utime = 3600000000, .salt = 1};
    for (int i = 0; i < 10; ++i) judge(first.next());
    for (int i = 0; i < 100; ++i) {
        ASSERT_EQ(judge(first.next()), Verdict::kTake);
        ASSERT_NE(judge(second.next()), Verdict::kTake);
    }
    EXPECT_TRUE(said("another sender"));
}

TEST_F(Guard, TheSameNumberAndTimeButOtherBytesAreOfAnotherSender) {
    Sender first{}, second{.salt = 1};
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(judge(first.next()), Verdict::kTake);
        EXPECT_EQ(judge(second.next()), Verdict::kForeign);
    }
    EXPECT_TRUE(said("another sender"));
}

TEST_F(Guard, WithoutTimeStampsNumbersOrderTheStream) {
    const auto numbered = [](std::uint32_t seq, std::uint32_t checksum) {
        return Message{std::nullopt, std::nullopt, seq, std::nullopt, checksum};
    };
    for (std::uint32_t i = 500; i < 520; ++i) EXPECT_EQ(judge(numbered(i, i)), Verdict::kTake);
    EXPECT_EQ(judge(numbered(519, 519)), Verdict::kRepeated);
    for (std::uint32_t i = 0; i < 20; ++i) {
        EXPECT_NE(judge(numbered(i, 7000 + i)), Verdict::kTake);
        EXPECT_EQ(judge(numbered(520 + i, 520 + i)), Verdict::kTake);
    }
    EXPECT_TRUE(said("another sender"));
    EXPECT_GE(count_[Verdict::kForeign], 19);
}

TEST_F(Guard, OneSendersShuffledMessagesAreNotCalledAnothers) {
    for (const bool with_id : {true, false}) {
        guard_ = SenderGuard("OPENNI_FRAME");
        count_.clear();
        news_.clear();
        Sender sender;
        if (with_id) sender.id = 7;
        std::vector<Message> messages;
        for (int i = 0; i < 400; ++i) messages.push_back(sender.next());
        for (std::size_t i = 0; i < messages.size(); ++i) judge(messages[i * 149 % messages.size()]);
        EXPECT_FALSE(news_.empty());
        EXPECT_FALSE(said("another sender on")) << news_[0];
        EXPECT_EQ(said("another sender or messages out of order"), !with_id);
        EXPECT_EQ(count_[Verdict::kForeign] == 0, with_id);
    }
}

TEST_F(Guard, AnyStampsAreJudgedWithoutOverflow) {
    for (const std::int64_t utime : {INT64_MIN, INT64_MAX, std::int64_t{0}, INT64_MIN, INT64_MAX, INT64_MAX})
        EXPECT_NO_THROW(judge({std::nullopt, std::nullopt, std::nullopt, utime, 0}));
}

}  // namespace
}  // namespace planemap::messages
