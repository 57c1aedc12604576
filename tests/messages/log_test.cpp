// SPDX-License-Identifier: BSD-3-Clause
#include "messages/log.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <random>

#include "core/files.hpp"

namespace planemap {
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
    std::vector<LogEvent> read() {
        LogReader reader(file_);
        std::vector<LogEvent> events;
        for (LogEvent e; reader.next(e);) events.push_back(e);
        skipped_ = reader.bytes_skipped();
        truncated_ = reader.truncated();
        return events;
    }
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
}  // namespace planemap
