// SPDX-License-Identifier: BSD-3-Clause
#include "bench_run/program_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace planemap::bench_run {
namespace {

using ::testing::HasSubstr;

TEST(ProgramRun, CountsWhatItsChildrenTook) {
    const ProgramRun idle = run_program_to_end({"sh", "-c", "sleep 0.3"});
    EXPECT_GE(idle.wall_s, 0.3);
    EXPECT_LT(idle.cpu_s, idle.wall_s);
    const ProgramRun busy =
        run_program_to_end({"sh", "-c", "sh -c 'i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done'; true"});
    EXPECT_GT(busy.cpu_s, idle.cpu_s);
    EXPECT_GT(idle.peak_rss_mb, 0);
}

TEST(ProgramRun, AFailureSaysWhatTheProgramSaidLast) {
    const auto error = [](const std::vector<std::string>& command) {
        return error_of([&] { run_program_to_end(command); });
    };
    EXPECT_THAT(error({"sh", "-c", "echo first >&2; echo the reason >&2; exit 3"}),
                testing::AllOf(HasSubstr("sh: failed: the reason"), testing::Not(HasSubstr("first"))));
    EXPECT_THAT(error({"/nowhere/planemap-run"}), HasSubstr("/nowhere/planemap-run: cannot be started"));
    EXPECT_THAT(error({"sh", "-c", "kill -9 $$"}), HasSubstr("sh: failed"));
}

}  // namespace
}  // namespace planemap::bench_run
