// SPDX-License-Identifier: BSD-3-Clause
#include "messages/journal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap::messages {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Journals : public testing::Test {
  protected:
    static void add(Journal& journal, const std::string& text) {
        journal.add("C", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    }
    static std::vector<std::string> messages(Journal& journal) {
        std::vector<std::string> all;
        journal.replay([&](const LogEvent& event) {
            EXPECT_EQ(event.channel, "C");
            all.emplace_back(event.bytes.begin(), event.bytes.end());
        });
        return all;
    }
    TemporaryFolder folder_;
    std::filesystem::path file() const { return folder_ / "state/map.journal"; }
};

TEST_F(Journals, GiveBackWhatWasAddedAndGoOn) {
    {
        Journal journal(file());
        EXPECT_EQ(messages(journal), std::vector<std::string>());
        add(journal, "one");
        add(journal, "two");
        EXPECT_THAT(messages(journal), ElementsAre("one", "two")) << "at once: a kill loses nothing";
    }
    Journal journal(file());
    EXPECT_EQ(journal.complaints(), std::vector<std::string>());
    add(journal, "three");
    EXPECT_THAT(messages(journal), ElementsAre("one", "two", "three"));
    EXPECT_EQ(journal.trouble(), "");
}

TEST_F(Journals, ARecordThatWasNotWrittenWholeIsCutOffAndSaid) {
    std::string whole;
    {
        Journal journal(file());
        add(journal, "one");
        const std::size_t first = journal.bytes();
        add(journal, "two");
        whole = read_file(file());
        ASSERT_GT(whole.size(), first);
    }
    const std::size_t first = whole.size() / 2;
    for (std::size_t size = first + 1; size < whole.size(); ++size) {
        write_file(file(), whole.substr(0, size));
        Journal journal(file());
        ASSERT_EQ(journal.complaints().size(), 1u) << size;
        EXPECT_THAT(journal.complaints()[0], HasSubstr("map.journal"));
        add(journal, "again");
        ASSERT_THAT(messages(journal), ElementsAre("one", "again")) << size;
        EXPECT_EQ(journal.bytes(), std::filesystem::file_size(file()));
    }
}

TEST_F(Journals, AreMadeSmallerByWhatIsKept) {
    Journal journal(file());
    EXPECT_FALSE(journal.is_due_to_compact());
    const std::string large(1 << 20, 'x');
    for (int i = 0; i < 6; ++i) add(journal, large);
    add(journal, "last");
    EXPECT_TRUE(journal.is_due_to_compact());
    journal.compact([](LogEvent& event) {
        if (event.bytes.size() > 100) return false;
        event.bytes[0] = 'L';
        return true;
    });
    EXPECT_FALSE(journal.is_due_to_compact());
    add(journal, "more");
    EXPECT_THAT(messages(journal), ElementsAre("Last", "more"));
    EXPECT_EQ(journal.bytes(), std::filesystem::file_size(file()));
    EXPECT_FALSE(std::filesystem::exists(file().string() + ".new"));
}

TEST_F(Journals, OneProcessHasOne) {
    std::optional<Journal> journal(file());
    try {
        Journal second(file());
        FAIL() << "two at once";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("map.journal"));
    }
    journal.reset();
    EXPECT_NO_THROW(Journal{file()});
}

TEST_F(Journals, WhatACompactionThatWasKilledLeftIsRemoved) {
    std::filesystem::create_directories(file().parent_path());
    write_file(file().string() + ".new", "half");
    Journal journal(file());
    EXPECT_FALSE(std::filesystem::exists(file().string() + ".new"));
}

/// On a device that is always full.
TEST_F(Journals, AFullDiskIsSaidAndEndsNothing) {
    std::filesystem::create_symlink("/dev/full", folder_ / "full");
    EXPECT_THROW(Journal(folder_ / "full"), std::runtime_error) << "no regular file";
}

}  // namespace
}  // namespace planemap::messages
