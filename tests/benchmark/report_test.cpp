// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap::benchmark {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::vector<SequenceInfo> kThree{{"a", "", "", "", 0}, {"moon", "", "", "", 0}, {"b", "", "", "", 0}};

TEST(Report, KeepsRowsAndSkipsWhatIsMissing) {
    const TemporaryFolder folder;
    Options options;
    options.json = folder.path() / "rows.json";
    testing::internal::CaptureStdout();
    Report report(options, "none");
    std::size_t kept = 0;
    report.for_each(kThree, [&](const SequenceInfo& sequence) {
        if (sequence.name == "b") kept = Json::parse(read_file(options.json)).size();
        if (sequence.name == "moon") throw DataMissing("/data/moon: no such folder");
        report.add({{"sequence", sequence.name}}, {{"sequence", "sequence", -10}});
    });
    report.finish();
    EXPECT_EQ(kept, 1u) << "what was measured is there if a later one fails";
    EXPECT_EQ(Json::parse(read_file(options.json)), Json::parse(R"([{"sequence": "a"}, {"sequence": "b"}])"));
    EXPECT_THAT(
        testing::internal::GetCapturedStdout(),
        AllOf(HasSubstr("peers     none"), HasSubstr("moon: skipped. /data/moon"), HasSubstr("a    ")));
}

TEST(Report, OtherErrorsEndIt) {
    testing::internal::CaptureStdout();
    Report report({}, "none");
    EXPECT_THROW(
        report.for_each(kThree, [](const SequenceInfo&) { throw std::runtime_error("a method failed"); }),
        std::runtime_error);
    testing::internal::GetCapturedStdout();
}

TEST(Report, WithoutRowsTheFileHoldsAnEmptyList) {
    const TemporaryFolder folder;
    Options options;
    options.json = folder.path() / "rows.json";
    testing::internal::CaptureStdout();
    Report(options, "none").finish();
    testing::internal::GetCapturedStdout();
    EXPECT_EQ(read_file(options.json), "[]\n");
}

TEST(RunReport, WritesWhatWasMeasuredAndRefusesWrongOptionsBefore) {
    const TemporaryFolder folder;
    Options options;
    options.json = folder.path() / "rows.json";
    testing::internal::CaptureStdout();
    run_report(options, "none", [](Report& report) { report.add({{"sequence", "a"}}); });
    testing::internal::GetCapturedStdout();
    EXPECT_EQ(Json::parse(read_file(options.json)), Json::parse(R"([{"sequence": "a"}])"));
    options.frames = -1;
    EXPECT_THROW(run_report(options, "none", [](Report&) { FAIL(); }), std::invalid_argument);
}

}  // namespace
}  // namespace planemap::benchmark
