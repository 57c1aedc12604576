// SPDX-License-Identifier: BSD-3-Clause
#include "results/result_folder.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <set>
#include <stdexcept>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::vector<std::string> kNames{"a", "b", "c"};

Result text(const std::string& name, const std::string& bytes) {
    return {name, [=](const auto& file) { write_file(file, bytes); }};
}

/// What lies in a folder, hidden things included.
std::set<std::string> names_in(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename().string());
    return names;
}

/// Exit code of a body run in a process of its own; minus the signal that ended it.
int in_child(const std::function<int()>& body) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(body());
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST(ResultFolder, ReplacesEarlierResultsTogetherAndNothingElse) {
    const test::TemporaryFolder folder;
    write_file(folder / "notes.txt", "foreign");
    for (const std::string& name : kNames) write_file(folder / name, "old");
    {
        ResultFolder results(folder.path(), kNames);
        results.make(text("a", "new"));
        results.make(text("b", "draft"));
        results.make(text("b", "new"));
        for (const std::string& name : kNames) EXPECT_EQ(read_file(folder / name), "old") << "not yet";
        EXPECT_TRUE(results.holds_earlier());
        results.replace();
        EXPECT_THAT(results.take_notes(), IsEmpty());
    }
    EXPECT_EQ(read_file(folder / "a"), "new");
    EXPECT_EQ(read_file(folder / "b"), "new");
    EXPECT_THAT(names_in(folder.path()), ElementsAre("a", "b", "notes.txt")) << "c is of the earlier run";
}

TEST(ResultFolder, ReplacesSomeNamesWhereOnlyTheyAreMeant) {
    const test::TemporaryFolder folder;
    for (const std::string& name : kNames) write_file(folder / name, "old");
    ResultFolder results(folder.path(), kNames);
    results.make(text("a", "new"));
    results.replace({"a", "b"});
    EXPECT_EQ(read_file(folder / "a"), "new");
    EXPECT_FALSE(std::filesystem::exists(folder / "b"));
    EXPECT_EQ(read_file(folder / "c"), "old");
}

TEST(ResultFolder, WhatFailsLeavesWhatWasThere) {
    const test::TemporaryFolder folder;
    write_file(folder / "a", "old");
    ResultFolder results(folder.path(), kNames);
    results.make(text("a", "draft"));
    EXPECT_THAT(error_of([&] {
                    results.make({"a", [](const auto&) { throw std::runtime_error("disk full"); }});
                }),
                HasSubstr("disk full"));
    EXPECT_EQ(read_file(results.made("a")), "draft");
    results.discard();
    EXPECT_EQ(read_file(folder / "a"), "old");
}

TEST(ResultFolder, ResultsThatWentAwayReplaceNothing) {
    const test::TemporaryFolder folder;
    for (const std::string& name : kNames) write_file(folder / name, "old");
    ResultFolder results(folder.path(), kNames);
    for (const std::string& name : kNames) results.make(text(name, "new"));
    std::filesystem::remove(results.made("b"));
    EXPECT_THAT(error_of([&] { results.replace(); }), AllOf(HasSubstr("b"), HasSubstr("gone")));
    for (const std::string& name : kNames) EXPECT_EQ(read_file(folder / name), "old");
}

TEST(ResultFolder, ASecondRunIsRefusedWhileTheFirstLives) {
    const test::TemporaryFolder folder;
    int ready[2];
    ASSERT_EQ(::pipe(ready), 0);
    const pid_t first = ::fork();
    if (first == 0) {
        const ResultFolder results(folder.path(), kNames);
        (void)!::write(ready[1], "x", 1);
        ::pause();
        ::_exit(0);
    }
    char byte = 0;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    EXPECT_THAT(error_of([&] { ResultFolder(folder.path(), kNames); }),
                AllOf(HasSubstr(folder.path().string()), HasSubstr("another run")));
    ::kill(first, SIGKILL);
    ::waitpid(first, nullptr, 0);
    EXPECT_EQ(error_of([&] { ResultFolder(folder.path(), kNames); }), "") << "a kill leaves no lock behind";
    EXPECT_THAT(names_in(folder.path()), IsEmpty());
}

TEST(ResultFolder, WhatARunLeftIsKeptAndDoesNotPileUp) {
    const test::TemporaryFolder folder;
    for (int run = 0; run < 9; ++run) {
        EXPECT_EQ(in_child([&] {
                      ResultFolder results(folder.path(), kNames);
                      results.make(text("a", "run " + std::to_string(run)));
                      ::raise(SIGKILL);
                      return 0;
                  }),
                  -SIGKILL);
    }
    ResultFolder results(folder.path(), kNames);
    EXPECT_THAT(results.take_notes(), testing::Contains(HasSubstr("partial-")));
    std::set<std::string> kept;
    for (const std::string& name : names_in(folder.path())) {
        if (!name.starts_with("partial-")) continue;
        EXPECT_THAT(names_in(folder / name), ElementsAre("a"));
        kept.insert(read_file(folder / name / "a"));
    }
    EXPECT_EQ(kept.size(), 5u);
    EXPECT_TRUE(kept.contains("run 8")) << "the newest";
}

TEST(ResultFolder, LeftoversThatCanBeMadeAgainAreRemoved) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder / ".a.part");
    write_file(folder / ".a.part/a", "half");
    ResultFolder results(folder.path(), {"a"}, ".a.part", ResultFolder::Leftovers::kRemove);
    EXPECT_THAT(results.take_notes(), ElementsAre(HasSubstr("removed")));
    EXPECT_FALSE(results.holds_made());
}

/// Whenever a run is killed, the next one finds results that belong together.
TEST(ResultFolder, AKillAtAnyMomentMixesNothing) {
    const test::TemporaryFolder folder;
    for (int round = 0; round < 40; ++round) {
        const pid_t child = ::fork();
        if (child == 0) {
            for (int i = 0;; ++i) {
                ResultFolder results(folder.path(), kNames);
                // c is a result of every other run only.
                const std::string bytes = std::to_string(round) + "." + std::to_string(i);
                for (const char* name : {"a", "b"}) results.make(text(name, bytes));
                if (i % 2 == 0) results.make(text("c", bytes));
                results.replace();
            }
        }
        ::usleep(static_cast<useconds_t>(2000 + 311 * round));
        ::kill(child, SIGKILL);
        ::waitpid(child, nullptr, 0);
        const ResultFolder results(folder.path(), kNames);
        if (!results.holds_earlier()) continue;
        const std::string bytes = read_file(folder / "a");
        EXPECT_EQ(read_file(folder / "b"), bytes);
        const bool even = (bytes.back() - '0') % 2 == 0;
        ASSERT_EQ(std::filesystem::exists(folder / "c"), even) << bytes;
        if (even) {
            EXPECT_EQ(read_file(folder / "c"), bytes);
        }
    }
}

TEST(ResultFolder, PutsInPlaceWhatAKillInterrupted) {
    const test::TemporaryFolder folder;
    write_file(folder / "a", "new");  // moved already
    write_file(folder / "b", "old");
    write_file(folder / "c", "old");
    std::filesystem::create_directories(folder / ".partial-whole");
    write_file(folder / ".partial-whole/b", "new");
    write_file(folder / ".partial-whole/.stale-c", "");
    ResultFolder results(folder.path(), kNames);
    EXPECT_THAT(results.take_notes(), ElementsAre(HasSubstr("in place")));
    EXPECT_EQ(read_file(folder / "b"), "new");
    EXPECT_FALSE(std::filesystem::exists(folder / "c"));
    EXPECT_FALSE(std::filesystem::exists(folder / ".partial-whole"));
}

TEST(ResultFolder, AFolderThatWentAwayIsMadeAgain) {
    const test::TemporaryFolder parent;
    const std::filesystem::path folder = parent / "out";
    ResultFolder results(folder, kNames);
    results.make(text("a", "interim"));
    std::filesystem::remove_all(folder);
    for (const std::string& name : kNames) results.make(text(name, "final"));
    results.replace();
    for (const std::string& name : kNames) EXPECT_EQ(read_file(folder / name), "final");
    EXPECT_THAT(results.take_notes(), ElementsAre(HasSubstr("removed meanwhile")));
}

TEST(ResultFolder, WhateverIsRemovedASecondRunIsRefused) {
    const test::TemporaryFolder parent;
    const std::filesystem::path folder = parent / "out";
    ResultFolder first(folder, kNames);
    const auto second = [&] { return error_of([&] { ResultFolder(folder, kNames); }); };
    std::filesystem::remove(folder / ".partial.lock");
    EXPECT_THAT(second(), HasSubstr("another run"));
    first.make(text("a", "first"));
    EXPECT_THAT(first.take_notes(), ElementsAre(HasSubstr(".partial.lock: was removed meanwhile")))
        << "and not the folder";
    std::filesystem::remove_all(folder);
    EXPECT_THAT(second(), HasSubstr("another run"));
    std::filesystem::create_directory_symlink(parent.path(), parent / "link");
    EXPECT_THAT(error_of([&] { ResultFolder(parent / "link" / "out", kNames); }), HasSubstr("another run"))
        << "by another path";
    std::filesystem::create_directories(folder);
    first.make(text("a", "first"));
    EXPECT_THAT(first.take_notes(), ElementsAre(HasSubstr("out: was removed meanwhile; made again")));
    first.replace();
    EXPECT_EQ(read_file(folder / "a"), "first");
}

TEST(ResultFolder, WhatTookTheFoldersPlaceIsLeftThere) {
    const test::TemporaryFolder parent;
    const std::filesystem::path folder = parent / "out";
    write_file(parent / "out-2", "no folder");
    std::filesystem::create_directories(parent / "out-3");
    write_file(parent / "out-3/a", "of an earlier run");
    ResultFolder results(folder, kNames);
    results.make(text("a", "interim"));
    std::filesystem::remove_all(folder);
    write_file(folder, "a file now");
    results.make(text("a", "final"));
    results.replace();
    EXPECT_EQ(read_file(folder), "a file now");
    EXPECT_EQ(results.path(), parent / "out-4");
    EXPECT_EQ(read_file(parent / "out-4" / "a"), "final");
    EXPECT_EQ(read_file(parent / "out-3" / "a"), "of an earlier run");
    EXPECT_THAT(results.take_notes(),
                ElementsAre(AllOf(HasSubstr("out: is no folder any more"), HasSubstr("out-4"))));
}

/// By a process that does not know the lock's name, as tools/launch.
TEST(ResultFolder, AFolderThatAnotherRunTookIsLeftToIt) {
    const test::TemporaryFolder parent;
    const std::filesystem::path folder = parent / "out";
    ResultFolder first(folder, kNames);
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const int lock = ::open((folder / ".partial.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    ASSERT_EQ(::flock(lock, LOCK_EX), 0);
    first.make(text("a", "first"));
    first.replace();
    ::close(lock);
    EXPECT_THAT(names_in(folder), ElementsAre(".partial.lock"));
    EXPECT_EQ(first.path(), parent / "out-2");
    EXPECT_EQ(read_file(parent / "out-2" / "a"), "first");
    EXPECT_THAT(first.take_notes(), ElementsAre(HasSubstr("another run has taken it")));
}

TEST(ResultFolder, WhatCanBeSeenAtTheStartIsSeenThen) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "b");
    EXPECT_THAT(error_of([&] { ResultFolder(folder.path(), kNames); }), HasSubstr("b: is a folder"));
    write_file(folder / "file", "x");
    EXPECT_THAT(error_of([&] { ResultFolder(folder / "file", kNames); }), HasSubstr("file"));
    EXPECT_THAT(error_of([&] { ResultFolder("/proc/nowhere", kNames); }), HasSubstr("/proc/nowhere"));
    EXPECT_EQ(read_file(folder / "file"), "x");
    // No room: here a limit on the size of files.
    EXPECT_EQ(in_child([&] {
                  const rlimit limit{1000, 1000};
                  ::setrlimit(RLIMIT_FSIZE, &limit);
                  const std::string error = error_of([&] { ResultFolder(folder / "small", kNames); });
                  return error.find("cannot write") != std::string::npos ? 7 : 0;
              }),
              7);
    EXPECT_THAT(names_in(folder / "small"), testing::Not(testing::Contains(".partial.lock")));
}

}  // namespace
}  // namespace planemap
