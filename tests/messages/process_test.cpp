// SPDX-License-Identifier: BSD-3-Clause
// What every process does alike, in this process: tests/tools runs whole ones.
#include "messages/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <stdexcept>

#include "messages/channels.hpp"
#include "messages/log.hpp"
#include "messages/sample_messages.hpp"
#include "temporary_folder.hpp"

namespace planemap::messages {
namespace {

/// Takes what comes on one channel; says that it can use it or not.
class CountingShell : public Shell {
  public:
    CountingShell(Bus& bus, bool uses, int& handled, int& finished) : handled_(handled), finished_(finished) {
        bus.subscribe("A", status_.guard([this, uses](const RawMessage&) {
            ++handled_;
            status_.received();
            uses ? status_.published() : status_.dropped();
        }));
    }
    ModuleStatus& status() override { return status_; }
    void finish() override { ++finished_; }

  private:
    ModuleStatus status_{"counting"};
    int &handled_, &finished_;
};

class ProcessTest : public testing::Test {
  protected:
    TemporaryFolder folder_;
    std::shared_ptr<spdlog::logger> before_ = spdlog::default_logger();
    int handled_ = 0, finished_ = 0;

    ~ProcessTest() override { spdlog::set_default_logger(before_); }

    /// A log with three messages on A, as a URL without a pause.
    std::string log() {
        const std::filesystem::path file = folder_ / "three.lcmlog";
        LogWriter writer(file);
        for (int i = 0; i < 3; ++i) writer.write({i, 1000000 + i, "A", std::vector<std::uint8_t>(4)});
        writer.close();
        return "file://" + file.string() + "?speed=0";
    }
    static int run(Process& process, std::vector<std::string> arguments,
                   const std::function<std::unique_ptr<Shell>(Bus&)>& make_shell) {
        arguments.insert(arguments.begin(), "planemap-counting");
        std::vector<char*> argv;
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        return process.run(static_cast<int>(arguments.size()), argv.data(), make_shell);
    }
    std::function<std::unique_ptr<Shell>(Bus&)> shell(bool uses) {
        return [this, uses](Bus& bus) {
            return std::make_unique<CountingShell>(bus, uses, handled_, finished_);
        };
    }
};

TEST_F(ProcessTest, RunsItsShellToTheEndOfWhatItHears) {
    Process process("counting", "Counts");
    EXPECT_EQ(run(process, {"--lcm-url", log()}, shell(true)), 0);
    EXPECT_EQ(handled_, 3);
    EXPECT_EQ(finished_, 1);
}

TEST_F(ProcessTest, OneThatCouldUseNothingFails) {
    Process process("counting", "Counts");
    testing::internal::CaptureStderr();
    EXPECT_EQ(run(process, {"--lcm-url", log()}, shell(false)), 1);
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                testing::HasSubstr("planemap-counting: none of the 3 inputs could be used"));
    EXPECT_EQ(finished_, 1) << "what it has is written all the same";
}

TEST_F(ProcessTest, OnABusOfItsOwnItWouldWaitForEver) {
    Process process("counting", "Counts");
    testing::internal::CaptureStderr();
    EXPECT_EQ(run(process, {"--lcm-url", "memq://"}, shell(true)), 1);
    EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("hears nobody but itself"));
    EXPECT_EQ(finished_, 0);
}

TEST_F(ProcessTest, WrongFlagsAreNoErrorOfTheModule) {
    Process process("counting", "Counts");
    testing::internal::CaptureStderr();
    EXPECT_EQ(run(process, {"--no-such-flag"}, shell(true)), 2);
    EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("--no-such-flag"));
}

TEST_F(ProcessTest, WithAStateItHasAJournalAndASession) {
    Process process("counting", "Counts");
    EXPECT_TRUE(process.journal().empty());
    std::vector<std::int64_t> sessions;
    for (int life = 0; life < 2; ++life) {
        Process again("counting", "Counts");
        EXPECT_EQ(run(again, {"--lcm-url", log(), "--state", folder_.path().string()},
                      [&](Bus& bus) {
                          sessions.push_back(bus.session());
                          return shell(true)(bus);
                      }),
                  0);
        EXPECT_EQ(again.journal(), folder_ / "counting.journal");
    }
    EXPECT_NE(sessions.at(0), sessions.at(1));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "counting.session"));
}

TEST(RunMain, AnExceptionIsOneLineAndAnExitCode) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(run_main("program", [] { return 7; }), 7);
    EXPECT_EQ(run_main("program", []() -> int { throw std::runtime_error("what went wrong"); }), 1);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "program: what went wrong\n");
}

TEST(RequireShared, ABusThatOthersCanBeOnWillDo) {
    EXPECT_THROW(require_shared(Bus("memq://")), std::invalid_argument);
    EXPECT_NO_THROW(require_shared(Bus("udpm://239.255.76.67:7667?ttl=0")));
}

}  // namespace
}  // namespace planemap::messages
