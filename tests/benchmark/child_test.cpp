// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/child.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <string>
#include <vector>

#include "messages/module_status.hpp"
#include "temporary_folder.hpp"

namespace planemap::benchmark {
namespace {

TEST(Child, ReturnsWhatItFoundHoweverLong) {
    const std::string longer(300000, 'x');  // than a pipe holds
    const ChildResult result = run_in_child([&]() -> nlohmann::json { return {{"text", longer}}; });
    EXPECT_EQ(result.value["text"], longer);
}

TEST(Child, CountsItsOwnTimeAndMemory) {
    const ChildResult idle = run_in_child([]() -> nlohmann::json { return 1; });
    const ChildResult busy = run_in_child([]() -> nlohmann::json {
        std::vector<char> block(200u << 20, 1);
        const double start_ms = messages::thread_cpu_ms();
        std::size_t sum = 0;
        while (messages::thread_cpu_ms() - start_ms < 200)
            sum += static_cast<std::size_t>(block[sum % block.size()]);
        return sum;
    });
    EXPECT_GT(busy.cpu_s, 0.19);
    EXPECT_GT(busy.peak_rss_mb, idle.peak_rss_mb + 150);
    EXPECT_LT(run_in_child([]() -> nlohmann::json { return 1; }).peak_rss_mb, idle.peak_rss_mb + 50)
        << "the one before does not count";
}

TEST(Child, ItsErrorIsOurs) {
    EXPECT_EQ(test::error_of([] {
                  run_in_child([]() -> nlohmann::json { throw std::invalid_argument("no such frame"); });
              }),
              "no such frame");
    EXPECT_THAT(test::error_of([] {
                    run_in_child([]() -> nlohmann::json {
                        std::raise(SIGKILL);
                        return 0;
                    });
                }),
                testing::HasSubstr("signal 9"));
}

}  // namespace
}  // namespace planemap::benchmark
