// SPDX-License-Identifier: BSD-3-Clause
#include "messages/log.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <random>

#include "core/files.hpp"

namespace planemap::messages {
namespace {

class Log : public testing::Test {
  protected:
    std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                  ("planemap_log_test_" + std::to_string(::getpid()) + ".lcmlog");
    void TearDown() override { std::filesystem::remove(file_); }

    static LogEvent event(int number, std::size_t size = 10) {
        return {number, 1000 * number, "CHANNEL_" + std::to_string(number),
                std::vector<std::uint8_t>(size, static_cast<std::uint8_t>(number))};
    }
    /// The events that the complaints say are lost in all gaps.
    static std::int64_t told_lost(const std::vector<std::string>& complaints) {
        const std::string before = "are no whole LCM events, about ";
        for (const std::string& line : complaints)
            if (const auto at = line.find(before); at != std::string::npos)
                return std::stoll(line.substr(at + before.size()));
        return 0;
    }
    std::vector<LogEvent> read() {
        LogReader reader(file_);
        std::vector<LogEvent> events;
        for (LogEvent e; reader.next(e);) events.push_back(e);
        skipped_ = reader.bytes_skipped();
        truncated_ = reader.truncated();
        gaps_ = reader.gaps();
        complaints_ = reader.complaints();
        lost_ = told_lost(complaints_);
        return events;
    }
    std::vector<LogEvent> read(const std::string& bytes) {
        std::filesystem::remove(file_);  // neither this way nor like write_file() waits for the disk
        std::ofstream(file_, std::ios::binary) << bytes;
        return read();
    }
    /// Messages of many sizes, three channels, a camera's pace; starts[i] is where event i begins.
    static std::string sample(int events, std::vector<std::size_t>* starts = nullptr, int first = 0) {
        std::mt19937 random(11);
        std::string log;
        for (int i = 0; i < events; ++i) {
            LogEvent e;
            e.number = first + i;
            e.utime = 1700000000000000 + 33333 * i;
            e.channel = i % 3 == 0 ? "OPENNI_FRAME" : i % 3 == 1 ? "PLANEMAP_CAMERA_INFO" : "POSE_BODY";
            e.bytes.resize(20 + random() % 300);
            for (std::uint8_t& byte : e.bytes) byte = static_cast<std::uint8_t>(random());
            if (starts != nullptr) starts->push_back(log.size());
            log += encode_event(e);
        }
        return log;
    }
    /// Of the events read, those that are events of the original, each once and in order, are good.
    struct Outcome {
        std::size_t good = 0, wrong = 0;
    };
    static Outcome judge(const std::vector<LogEvent>& read, const std::vector<LogEvent>& original) {
        Outcome outcome;
        std::size_t next = 0;
        for (const LogEvent& e : read) {
            std::size_t i = next;
            while (i < original.size() && original[i].bytes != e.bytes) ++i;
            if (i < original.size()) {
                ++outcome.good;
                next = i + 1;
            } else {
                ++outcome.wrong;
            }
        }
        return outcome;
    }
    std::int64_t lost_ = 0;
    std::vector<LogGap> gaps_;
    std::vector<std::string> complaints_;
    std::uint64_t skipped_ = 0;
    bool truncated_ = false;
};

TEST_F(Log, WhatIsWrittenIsRead) {
    LogWriter writer(file_);
    for (int i = 0; i < 5; ++i) writer.write(event(i));
    writer.close();
    const auto events = read();
    ASSERT_EQ(events.size(), 5u);
    EXPECT_EQ(events[3].channel, "CHANNEL_3");
    EXPECT_EQ(events[3].utime, 3000);
    EXPECT_EQ(events[3].bytes, event(3).bytes);
    EXPECT_EQ(skipped_, 0u);
    EXPECT_FALSE(truncated_);
}

TEST_F(Log, StrayBytesAreSkippedAndEveryGoodEventIsKept) {
    std::string sync = encode_event(event(9)).substr(0, 4);
    write_file(file_, "junk" + encode_event(event(0)) + std::string(100000, 'x') + encode_event(event(1)) +
                          sync + sync + "abc" + encode_event(event(2)));
    const auto events = read();
    ASSERT_EQ(events.size(), 3u);
    EXPECT_EQ(events[2].number, 2);
    EXPECT_EQ(skipped_, 4u + 100000u + 11u);
    EXPECT_FALSE(truncated_);
}

TEST_F(Log, HostileLengthsAreNotAllocated) {
    std::string bad = encode_event(event(1));
    bad[24] = 0x7f;
    bad[25] = bad[26] = bad[27] = static_cast<char>(0xff);
    write_file(file_, encode_event(event(0)) + bad + encode_event(event(2)));
    const auto events = read();
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[1].number, 2);
}

TEST_F(Log, ALogCutShortGivesWhatIsWholeAndSaysSo) {
    const std::string whole = encode_event(event(0)) + encode_event(event(1, 5000));
    for (const std::size_t cut : {std::size_t{1}, std::size_t{100}, std::size_t{5015}}) {
        write_file(file_, whole.substr(0, whole.size() - cut));
        EXPECT_EQ(read().size(), 1u) << cut;
        EXPECT_TRUE(truncated_) << cut;
    }
}

TEST_F(Log, EmptyAndRandomFiles) {
    write_file(file_, "");
    EXPECT_TRUE(read().empty());
    std::mt19937_64 random(5);
    std::string noise(200000, ' ');
    for (char& c : noise) c = static_cast<char>(random());
    write_file(file_, noise);
    EXPECT_TRUE(read().empty());
    EXPECT_EQ(skipped_, noise.size());
}

/// Every bit of every header: at most the event itself and one more are lost, none is made up, and what is
/// lost is said.
TEST_F(Log, AFlippedBitOfAHeaderCostsAtMostTwoEvents) {
    constexpr std::size_t kEvents = 12;
    std::vector<std::size_t> starts;
    const std::string log = sample(kEvents, &starts);
    const std::vector<LogEvent> original = read(log);
    ASSERT_EQ(original.size(), kEvents);
    ASSERT_TRUE(complaints_.empty());
    std::size_t whole = 0, one = 0, lengths = 0;
    for (std::size_t event = 0; event < kEvents; ++event) {
        const std::size_t header = 28 + original[event].channel.size();
        for (std::size_t bit = 0; bit < 8 * header; ++bit) {
            std::string damaged = log;
            char& byte = damaged[starts[event] + bit / 8];
            byte = static_cast<char>(byte ^ (1 << bit % 8));
            const std::vector<LogEvent> events = read(damaged);
            const Outcome outcome = judge(events, original);
            const std::string where =
                "event " + std::to_string(event) + ", bit " + std::to_string(bit) + " of its header";
            ASSERT_GE(outcome.good + 2, kEvents) << where;
            ASSERT_EQ(outcome.wrong, 0u) << where;
            if (outcome.good < kEvents) {
                ASSERT_GT(skipped_, 0u) << where;
                ASSERT_FALSE(complaints_.empty()) << where;
                ASSERT_NEAR(static_cast<double>(lost_), static_cast<double>(kEvents - outcome.good), 1)
                    << where;
            }
            whole += outcome.good == kEvents;
            one += outcome.good + 1 == kEvents;
            lengths += bit >= 160 && bit < 224;
            // A number between two that are consecutive is seen to be wrong, though its event is used.
            const bool number = bit >= 32 && bit < 96;
            if (number && event > 0 && event + 1 < kEvents) {
                ASSERT_FALSE(complaints_.empty()) << where;
            }
        }
    }
    EXPECT_EQ(one, lengths) << "only a damaged length costs an event, and only its own";
    EXPECT_EQ(whole + one, 8 * (28 * kEvents + 4 * 12 + 4 * 20 + 4 * 9));
}

/// Records of one size that is a power of two: a flipped bit makes one end exactly where a later one does.
TEST_F(Log, ALengthThatEndsOnALaterRecordIsSeen) {
    std::string log;
    std::vector<LogEvent> original;
    for (int i = 0; i < 20; ++i) {
        original.push_back(
            {i, 1000 * i, "CHAN", std::vector<std::uint8_t>(96, static_cast<std::uint8_t>(i))});
        log += encode_event(original.back());
    }
    ASSERT_EQ(log.size(), 20u * 128);
    for (const std::size_t event : {0, 3, 15, 17, 18, 19}) {
        for (const int bit : {7, 8, 9, 10}) {  // of the data length: 1, 2, 4, 8 records
            std::string damaged = log;
            char& byte = damaged[event * 128 + 27 - static_cast<std::size_t>(bit / 8)];
            byte = static_cast<char>(byte ^ (1 << bit % 8));
            const Outcome outcome = judge(read(damaged), original);
            EXPECT_EQ(outcome.good, 19u) << event << " " << bit;
            EXPECT_EQ(outcome.wrong, 0u) << event << " " << bit;
            EXPECT_EQ(lost_, 1) << event << " " << bit;
        }
    }
}

TEST_F(Log, BytesInsertedOrRemovedCostAtMostTwoEvents) {
    constexpr std::size_t kEvents = 12;
    const std::string log = sample(kEvents);
    const std::vector<LogEvent> original = read(log);
    for (std::size_t at = 0; at < log.size(); at += 3) {
        for (const std::size_t n : {1, 3, 17, 64}) {
            std::string damaged = log;
            damaged.insert(at, std::string(n, 'q'));
            Outcome outcome = judge(read(damaged), original);
            EXPECT_GE(outcome.good + 2, kEvents) << n << " inserted at " << at;
            EXPECT_EQ(outcome.wrong, 0u) << n << " inserted at " << at;
            EXPECT_GT(skipped_, 0u) << n << " inserted at " << at;
            damaged = log;
            damaged.erase(at, n);
            outcome = judge(read(damaged), original);
            EXPECT_GE(outcome.good + 2, kEvents) << n << " removed at " << at;
            EXPECT_GT(skipped_, 0u) << n << " removed at " << at;
            EXPECT_EQ(outcome.wrong, 0u) << n << " removed at " << at;
        }
    }
}

TEST_F(Log, ZerosThatACrashLeavesCostWhatTheyCover) {
    constexpr std::size_t kEvents = 40;
    std::vector<std::size_t> starts;
    const std::string log = sample(kEvents, &starts);
    const std::vector<LogEvent> original = read(log);
    for (std::size_t at = 0; at + 512 < log.size(); at += 101) {
        std::string damaged = log;
        std::fill_n(damaged.begin() + static_cast<std::ptrdiff_t>(at), 512, '\0');
        std::size_t covered = 0;
        for (std::size_t i = 0; i < kEvents; ++i) {
            const std::size_t end = i + 1 < kEvents ? starts[i + 1] : log.size();
            covered += starts[i] < at + 512 && at < end;
        }
        const Outcome outcome = judge(read(damaged), original);
        EXPECT_GE(outcome.good + covered, kEvents) << at;
        EXPECT_LE(outcome.wrong, 1u) << at << ": an event whose last bytes are zeros may still look whole";
        EXPECT_GT(skipped_, 0u) << at;
        ASSERT_EQ(gaps_.size(), 1u) << at;
        EXPECT_LE(gaps_[0].at, at + 512);
        EXPECT_NEAR(static_cast<double>(gaps_[0].events), static_cast<double>(covered), 1) << at;
    }
}

TEST_F(Log, ZerosAtTheEndAreNoEvents) {
    const std::string log = sample(40);
    for (const std::size_t zeros : {28u, 5000u, 3000000u}) {
        EXPECT_EQ(read(log + std::string(zeros, '\0')).size(), 40u) << zeros;
        EXPECT_EQ(skipped_, zeros);
        EXPECT_EQ(lost_, 0) << zeros;
        ASSERT_EQ(complaints_.size(), 1u) << zeros;
        const std::string size = zeros == 3000000u ? "3.0 MB" : std::to_string(zeros) + " bytes";
        EXPECT_EQ(complaints_[0],
                  file_.string() + ": " + size + " of zeros at the end: the log was not closed");
    }
    // The last event was not written to its end, either.
    EXPECT_EQ(read(log.substr(0, log.size() - 10) + std::string(1000000, '\0')).size(), 39u);
    EXPECT_EQ(lost_, 1);
    ASSERT_EQ(complaints_.size(), 3u);
    EXPECT_NE(complaints_[0].find("1.0 MB of zeros at the end"), std::string::npos) << complaints_[0];
    EXPECT_NE(complaints_[1].find("about 1 event lost"), std::string::npos) << complaints_[1];
    EXPECT_TRUE(read(std::string(100000, '\0')).empty());
    EXPECT_EQ(lost_, 0);
}

TEST_F(Log, LogsOneAfterTheOtherCutAnywhereGiveAllThatIsWhole) {
    std::vector<std::size_t> starts;
    const std::string log = sample(10, &starts);
    const std::vector<LogEvent> original = read(log);
    EXPECT_EQ(read(log + log).size(), 20u);
    EXPECT_TRUE(complaints_.empty()) << complaints_[0];
    for (std::size_t cut = 0; cut <= log.size(); cut += 5) {
        std::size_t before = 0;
        while (before < 10 && (before + 1 < 10 ? starts[before + 1] : log.size()) <= cut) ++before;
        const std::size_t after =
            static_cast<std::size_t>(starts.end() - std::lower_bound(starts.begin(), starts.end(), cut));
        const std::vector<LogEvent> joined = read(log.substr(0, cut) + log);
        EXPECT_EQ(joined.size(), before + 10) << cut;
        const std::vector<LogEvent> back = read(log.substr(cut));
        EXPECT_EQ(back.size(), after) << cut;
        if (!back.empty()) {
            EXPECT_EQ(back.back().bytes, original.back().bytes);
        }
    }
}

/// A log in a message is a payload like any other while its own record is good.
TEST_F(Log, ALogInsideAMessageIsNotSplit) {
    const std::string inner = sample(8);
    std::vector<LogEvent> original;
    for (int i = 0; i < 6; ++i) {
        LogEvent e = event(i, 50);
        e.utime += 1700000000000000;
        if (i == 3 || i == 5) e.bytes.assign(inner.begin(), inner.end());
        original.push_back(e);
    }
    std::string log;
    std::vector<std::size_t> starts;
    for (const LogEvent& e : original) {
        starts.push_back(log.size());
        log += encode_event(e);
    }
    const std::vector<LogEvent> whole = read(log);
    ASSERT_EQ(whole.size(), 6u);
    EXPECT_EQ(whole[3].bytes, original[3].bytes);
    EXPECT_TRUE(complaints_.empty());

    // Its own record is good, the next one's header is gone.
    std::string next = log;
    std::fill_n(next.begin() + static_cast<std::ptrdiff_t>(starts[4]), 28, '\0');
    const Outcome outcome = judge(read(next), original);
    EXPECT_EQ(outcome.good, 5u);
    EXPECT_EQ(outcome.wrong, 0u);

    // Its own length is damaged: it is lost, and what is inside is not taken for events of this log.
    for (const int bit : {2, 5, 9, 14, 29}) {
        std::string damaged = log;
        char& byte = damaged[starts[3] + 27 - static_cast<std::size_t>(bit / 8)];
        byte = static_cast<char>(byte ^ (1 << bit % 8));
        const Outcome own = judge(read(damaged), original);
        EXPECT_EQ(own.good, 5u) << bit;
        EXPECT_EQ(own.wrong, 0u) << bit;
    }
}

TEST_F(Log, ForeignNumbersLoseNothing) {
    // Filtered copies keep their numbers, other writers give none, or start again.
    for (const int step : {0, 1, 7, -1}) {
        std::string log;
        for (int i = 0; i < 30; ++i) {
            LogEvent e = event(i, 64 + static_cast<std::size_t>(i));
            e.number = 100 + step * i;
            log += encode_event(e);
        }
        EXPECT_EQ(read(log).size(), 30u) << step;
        EXPECT_TRUE(complaints_.empty()) << step;
        log[700] = static_cast<char>(log[700] ^ 0x10);
        std::string damaged = log;
        const std::size_t third = encode_event(event(0, 64)).size() + encode_event(event(1, 65)).size();
        damaged[third + 26] = 1;  // the data length of the third
        EXPECT_GE(read(damaged).size(), 28u) << step;
        EXPECT_GT(skipped_, 0u);
    }
    for (const std::int64_t odd : {std::numeric_limits<std::int64_t>::max(), std::int64_t{-1}}) {
        LogEvent e = event(3);
        e.number = e.utime = odd;
        EXPECT_EQ(
            read(encode_event(event(0)) + encode_event(e) + encode_event(e) + encode_event(event(1))).size(),
            4u);
    }
}

TEST_F(Log, StraySyncWordsHideNothing) {
    const std::string sync = encode_event(event(9)).substr(0, 4);
    const std::string log = sample(10);
    for (int n = 1; n < 40; ++n) {
        std::string stray;
        for (int i = 0; i < n; ++i) stray += sync;
        EXPECT_EQ(read(stray + log).size(), 10u) << n;
        EXPECT_EQ(skipped_, 4u * static_cast<unsigned>(n));
    }
    std::string words, headers;
    for (int i = 0; i < 1 << 21; ++i) words += sync;
    LogEvent far = event(1);
    far.bytes.resize(600000);
    const std::string header = encode_event(far).substr(0, 28 + far.channel.size());
    while (headers.size() < 2 << 20) headers += header;
    // Megabytes of them, which a reader that looks at each from the start would not get through.
    EXPECT_EQ(read(words + log).size(), 10u);
    EXPECT_EQ(read(headers + std::string(700000, 'x') + log).size(), 10u);
}

TEST_F(Log, SaysWhereAndHowMuchIsLostAndNoMoreThanTwentyPlaces) {
    std::vector<std::size_t> starts;
    std::string log = sample(100, &starts);
    for (int i = 2; i < 100; i += 3) log[starts[static_cast<std::size_t>(i)] + 26] ^= 4;
    read(log);
    ASSERT_EQ(gaps_.size(), LogReader::kMaxGaps);
    EXPECT_EQ(gaps_[0].at, starts[2]);
    EXPECT_EQ(gaps_[0].bytes, starts[3] - starts[2]);
    EXPECT_EQ(gaps_[0].events, 1);
    EXPECT_EQ(gaps_[0].utime_before, 1700000000000000 + 33333);
    EXPECT_EQ(gaps_[0].utime_after, 1700000000000000 + 3 * 33333);
    EXPECT_EQ(lost_, 33);
    ASSERT_EQ(complaints_.size(), 1 + LogReader::kMaxGaps + 1);
    EXPECT_NE(complaints_[0].find("in 33 places are no whole LCM events, about 33 events lost"),
              std::string::npos)
        << complaints_[0];
    EXPECT_NE(complaints_[1].find("about 1 event lost, after 0.033 s, before 0.100 s"), std::string::npos)
        << complaints_[1];
    EXPECT_NE(complaints_.back().find("and 13 places more"), std::string::npos) << complaints_.back();
}

TEST_F(Log, WhatCannotBeReadIsOneLine) {
    const std::string fifo = file_.string() + ".fifo";
    ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
    for (const std::string& name : {fifo, std::string("/dev/zero"), std::string("/tmp")}) {
        try {
            LogReader reader(name);
            ADD_FAILURE() << name;
        } catch (const std::runtime_error& error) {
            EXPECT_EQ(std::string(error.what()).rfind(name + ": cannot open: is ", 0), 0u) << error.what();
        }
    }
    std::filesystem::remove(fifo);
    const std::string log = sample(2000);
    write_file(file_, log);
    LogReader reader(file_);
    LogEvent e;
    ASSERT_TRUE(reader.next(e));
    std::filesystem::resize_file(file_, log.size() / 2);
    try {
        while (reader.next(e)) {
        }
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("became shorter while it was read"), std::string::npos)
            << error.what();
    }
}

TEST_F(Log, MissingFileNamesIt) {
    try {
        LogReader reader("/nowhere/at/all.lcmlog");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("/nowhere/at/all.lcmlog"), std::string::npos);
    }
    EXPECT_THROW(LogReader("/tmp"), std::runtime_error);
}

}  // namespace
}  // namespace planemap::messages
