// SPDX-License-Identifier: BSD-3-Clause
// planemap-report as a user runs it.
#include <gmock/gmock.h>

#include "exports/corner.hpp"
#include "map/map_file.hpp"
#include "tools/programs.hpp"

namespace planemap {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

class ReportProgram : public test::Programs {
  protected:
    void map_the_office(const std::string& name, const std::string& more = "") {
        const Outcome outcome =
            run("planemap-run", "'sim:office?frames=12' --no-octomap -q -o " + path(name) + " " + more);
        ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    }
    Outcome report_on(const std::string& arguments) { return run("planemap-report", arguments); }
};

TEST_F(ReportProgram, WritesThePageOfAFolderAsTheRunDid) {
    map_the_office("run");
    const std::string of_run = read_file(folder_ / "run/report.html");
    EXPECT_THAT(of_run, HasSubstr("sim:office"));
    const Outcome outcome = report_on(path("run") + " --html");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, path("run/report.html") + "\n");
    EXPECT_THAT(read_file(folder_ / "run/report.html"), HasSubstr("\"label\":\"wall\""));
    EXPECT_NEAR(static_cast<double>(read_file(folder_ / "run/report.html").size()),
                static_cast<double>(of_run.size()), 2000);
    EXPECT_EQ(Json::parse(report_on(path("run") + " --json").out), report("run"));
    EXPECT_THAT(report_on(path("run") + " --html --md").out, StartsWith("# planemap: sim:office"));
}

TEST_F(ReportProgram, SeveralAreATableAndTwoAreCompared) {
    map_the_office("a");
    map_the_office("b", "--seed 5");
    const std::string both = path("a") + " " + path("b");
    const Outcome table = report_on(both);
    EXPECT_EQ(table.exit_code, 0) << table.err;
    EXPECT_THAT(table.out, HasSubstr("# planemap: 2 maps"));
    EXPECT_THAT(table.out, HasSubstr("| " + path("b") + " | 12 |"));
    EXPECT_EQ(Json::parse(report_on(both + " --json").out).at(1).at("report"), report("b"));
    const Outcome compared = report_on("--compare " + both);
    EXPECT_EQ(compared.exit_code, 0) << compared.err;
    EXPECT_THAT(compared.out, HasSubstr("| --seed | - | 5 |"));
    EXPECT_THAT(compared.out, HasSubstr("One world frame: 12 poses"));
    EXPECT_TRUE(
        Json::parse(report_on("--json --compare " + both).out).at("world_frames").at("are_one").get<bool>());
}

TEST_F(ReportProgram, OfALogItSaysWhatTheMapTells) {
    map::write_plane_map(folder_ / "map.lcmlog", scene::corner());
    const Outcome outcome = report_on(path("map.lcmlog"));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("3 planes, no trajectory. Made of a stored map"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "report.md"))
        << "nothing is written beside a log that nobody asked for";
    EXPECT_EQ(report_on(path("map.lcmlog") + " --html").out, path("map.html") + "\n");
    EXPECT_THAT(read_file(folder_ / "map.html"), HasSubstr("\"label\":\"ceiling\""));
}

TEST_F(ReportProgram, BadInputIsOneLine) {
    expect_error("planemap-report", path("none"), "none/report.json: there is no such folder");
    expect_error("planemap-report", "--compare " + path("none"),
                 "--compare takes two folders or logs, not 1");
    expect_error("planemap-report", "--compare a b --html", "--compare gives text or --json, not --html");
    expect_error("planemap-report", "a --json --md", "give one of them");
    expect_error("planemap-report", "", "inputs");
    write_file(folder_ / "text.lcmlog", "a letter\n");
    expect_error("planemap-report", path("text.lcmlog"), "text.lcmlog: ");
    std::filesystem::create_directories(folder_ / "bad");
    write_file(folder_ / "bad/report.json", "{\"input\": 3}");
    expect_error("planemap-report", path("bad"),
                 "bad/report.json: is no report of planemap-run: input is number");
    expect_error("planemap-report", path("bad") + " --html", "bad/report.json: is no report of planemap-run");
}

}  // namespace
}  // namespace planemap
