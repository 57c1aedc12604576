// SPDX-License-Identifier: BSD-3-Clause
// What all programs do alike, and planemap-evaluate's and planemap-run's answers about trajectories and
// frames.
#include "tools/programs.hpp"

#include <gmock/gmock.h>

#include "core/trajectory.hpp"
#include "core/version.hpp"
#include "data_folder.hpp"

namespace planemap {
namespace {

using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kPrograms[] = {
    "planemap-run",          "planemap-evaluate",  "planemap-export", "planemap-report",
    "planemap-simulate",     "planemap-segment",   "planemap-sensor", "planemap-log",
    "planemap-segmentation", "planemap-odometry",  "planemap-graph",  "planemap-map",
    "planemap-octomap",      "planemap-convert",   "planemap-viewer", "planemap-virtual-camera",
    "planemap-launch",       "planemap-calibrate", "planemap-measure"};

struct ProgramsTest : test::Programs {
    Json evaluate(const std::string& truth, const std::string& estimate) {
        const Outcome outcome = run("planemap-evaluate", truth + " " + estimate + " --json -");
        EXPECT_EQ(outcome.exit_code, 0) << truth << " " << estimate << "\n" << outcome.err;
        return outcome.exit_code == 0 ? Json::parse(outcome.out) : Json::object();
    }
};

TEST_F(ProgramsTest, UnknownFlagsAreNamed) {
    for (const char* program : kPrograms) expect_error(program, "--verbsoe", "unknown flag --verbsoe");
    for (const char* program : {"planemap-run", "planemap-simulate", "planemap-segment", "planemap-map"})
        expect_error(program, "sim:office --outptu x", "unknown flag --outptu, did you mean --output?");
    for (const char* tool : {"install", "spy", "test"}) {
        const Outcome outcome = run_shell("tools/" + std::string(tool) + " --no-such-option");
        EXPECT_NE(outcome.exit_code, 0) << tool;
        EXPECT_THAT(outcome.err, HasSubstr("--no-such-option")) << tool;
    }
}

TEST_F(ProgramsTest, SayTheirVersion) {
    for (const char* program : kPrograms) {
        const Outcome outcome = run(program, "--version");
        EXPECT_EQ(outcome.exit_code, 0) << program;
        EXPECT_EQ(outcome.out, std::string(program) + " " + version() + "\n");
    }
}

TEST_F(ProgramsTest, SayWhenStandardOutputCannotBeWritten) {
    for (const char* program : kPrograms) {
        for (const char* flag : {"--version", "--help", "--dump-config"}) {
            const Outcome outcome = run(program, std::string(flag) + " >/dev/full");
            EXPECT_EQ(outcome.exit_code, 1) << program << flag;
            EXPECT_EQ(outcome.err, std::string(program) +
                                       ": standard output: cannot be written: No space left on device\n")
                << flag;
        }
    }
}

TEST_F(ProgramsTest, ValuesThatCannotBeMeantAreOneLine) {
    const std::string to = " --output " + path("out");
    expect_error("planemap-run", "sim:office --seed -1" + to, "--seed: \"-1\" is no whole number from 0");
    expect_error("planemap-run", "sim:office --frames ''" + to, "--frames: must not be empty");
    expect_error("planemap-run", "sim:office --frames 5:2" + to, "frames \"5:2\": no frame lies in it");
    expect_error("planemap-run", "sim:office -o ''", "--output: must not be empty");
    expect_error("planemap-run", "'sim:office?frames=3&frames=4'" + to, "frames is given twice");
    expect_error("planemap-run", "'sim:office?frames=3&rate=-1&units=1'" + to, "rate is -1");
    for (const char* module : {"segmentation", "odometry", "graph", "octomap"})
        expect_error("planemap-" + std::string(module), "--lcm-url ''", "--lcm-url: must not be empty");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(ProgramsTest, DumpTheirOptionsWithTheRightUnits) {
    for (const char* program : kPrograms) {
        const Outcome dumped = run(program, "--dump-config");
        ASSERT_EQ(dumped.exit_code, 0) << program << "\n" << dumped.err;
        std::istringstream lines(dumped.out);
        for (std::string line; std::getline(lines, line);) {
            const std::string name = line.substr(0, line.find(" ="));
            if (name.ends_with("-sigmas")) {
                EXPECT_THAT(line, AllOf(Not(HasSubstr("metres")), testing::ContainsRegex("sigma|residual")))
                    << program;
            }
            for (const char* unit : {"-deg", "-rad", "-px", "-s"}) {
                if (name.ends_with(unit)) {
                    EXPECT_THAT(line, Not(HasSubstr("metres"))) << program;
                }
            }
        }
        const std::string file = path("all.ini");
        write_file(file, dumped.out);
        EXPECT_EQ(run(program, "--config " + file + " --dump-config").out, dumped.out) << program;
    }
}

TEST_F(ProgramsTest, HelpIsShortAndHelpAllWhole) {
    const std::string help = run("planemap-run", "--help").out, all = run("planemap-run", "--help-all").out;
    const auto flags = [](const std::string& text) {
        std::istringstream lines(text);
        int count = 0;
        for (std::string line; std::getline(lines, line);) count += line.starts_with("  -");
        return count;
    };
    EXPECT_LE(flags(help), 60);
    EXPECT_GT(flags(all), flags(help));
    for (const char* flag : {"--poses", "--map ", "--camera", "--seed", "--frames", "--no-octomap", "--quiet",
                             "--output", "--config", "--map-merge-distance-m", "--map-merge-gap-m",
                             "--odometry-method", "--segmentation-method", "--graph-max-alike"})
        EXPECT_THAT(help, HasSubstr(flag));
    std::istringstream dumped(run("planemap-run", "--dump-config").out);
    for (std::string line; std::getline(dumped, line);) {
        if (line.find(" =") == std::string::npos) continue;  // a remark, or a module's heading
        std::string name = line.substr(0, line.find(" ="));
        if (name.starts_with("# ")) name.erase(0, 2);
        if (name.empty() || name.find(' ') != std::string::npos || name == "input" || name == line) continue;
        EXPECT_THAT(all, HasSubstr("--" + name)) << line;
    }
    expect_error("planemap-run", "sim:office --output " + path("x") + " --odometry-flow-levels 3",
                 "unknown flag --odometry-flow-levels");
}

TEST_F(ProgramsTest, ADumpedConfigGivesTheSameRun) {
    const std::string flags =
        "'sim:office?frames=4&width=160&height=120' --map-min-area-m2 0.3 --octomap-resolution-m 0.1 --seed "
        "3 -q";
    const Outcome dumped = run("planemap-run", flags + " --output " + path("a") + " --dump-config");
    ASSERT_EQ(dumped.exit_code, 0) << dumped.err;
    write_file(folder_ / "run.ini", dumped.out);
    ASSERT_EQ(run("planemap-run", flags + " --output " + path("a")).exit_code, 0);
    ASSERT_EQ(run("planemap-run", "--config " + path("run.ini") + " --output " + path("b")).exit_code, 0);
    for (const char* file : {"trajectory.txt", "planes.json", "plane_map.lcmlog", "octomap.bt"})
        EXPECT_EQ(read_file(folder_ / "a" / file), read_file(folder_ / "b" / file)) << file;
    Json a = report("a"), b = report("b");
    EXPECT_EQ(a.at("version"), version());
    EXPECT_EQ(a.at("seed"), 3);
    EXPECT_EQ(a.at("options").at("map-min-area-m2"), 0.3);
    b["options"]["output"] = a["options"]["output"];
    EXPECT_EQ(a.at("options"), b.at("options"));
    for (const char* key : {"plane_map_zstd", "plane_map_working", "octomap_bt_memory", "octomap_bt_occupied",
                            "octomap_bt_zstd", "octomap_bt_occupied_zstd", "octomap_working"})
        EXPECT_GT(a.at("sizes_bytes").at(key).get<std::int64_t>(), 0) << key;
    EXPECT_LT(a.at("sizes_bytes").at("octomap_bt_occupied"), a.at("sizes_bytes").at("octomap_bt"));
    EXPECT_LE(a.at("sizes_bytes").at("octomap_bt_memory"), a.at("sizes_bytes").at("octomap_memory"));
    EXPECT_LT(a.at("sizes_bytes").at("octomap_bt_zstd"), a.at("sizes_bytes").at("octomap_bt"));
    EXPECT_LT(a.at("sizes_bytes").at("octomap_bt_occupied_zstd"),
              a.at("sizes_bytes").at("octomap_bt_occupied"));
    EXPECT_GT(a.at("sizes_bytes").at("plane_map_working"), a.at("sizes_bytes").at("plane_map_memory"));
}

TEST_F(ProgramsTest, EvaluateReadsEveryFormOfTheCases) {
    PLANEMAP_NEEDS_DATA("cases");
    const std::string cases = test::data_folder("cases").string() + "/evaluate/";
    const Json right = evaluate(cases + "truth.txt", cases + "estimate.txt");
    EXPECT_EQ(right.at("pairs"), 100);
    for (const auto& [truth, estimate] : {std::pair("truth_ns.txt", "estimate_ns.txt"),
                                          {"truth_euroc.csv", "estimate.txt"},
                                          {"truth_euroc.csv", "estimate_ns.txt"},
                                          {"truth.txt", "estimate_ns.txt"},
                                          {"truth_kitti.txt", "estimate_kitti.txt"}}) {
        const Json figures = evaluate(cases + truth, cases + estimate);
        EXPECT_EQ(figures.at("pairs"), 100) << truth;
        for (const char* key : {"ate", "rpe_frame"}) {
            const Json &a = figures.at(key), &b = right.at(key);
            const Json &rmse_a = a.contains("rmse") ? a.at("rmse") : a.at("trans").at("rmse"),
                       &rmse_b = b.contains("rmse") ? b.at("rmse") : b.at("trans").at("rmse");
            EXPECT_NEAR(rmse_a.get<double>(), rmse_b.get<double>(), 2e-6) << truth << " " << estimate << key;
        }
        EXPECT_NEAR(figures.at("path_length_m").get<double>(), 1.62, 0.005) << truth;
    }
}

TEST_F(ProgramsTest, EvaluateRefusesWhatCannotBeCompared) {
    write_file(folder_ / "tum.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n3 1 0 0 0 0 0 1\n");
    const std::string pose = "1 0 0 0 0 1 0 0 0 0 1 0\n";
    write_file(folder_ / "kitti.txt", pose + pose + pose);
    write_file(folder_ / "short.txt", pose + pose);
    write_file(folder_ / "matrices.txt", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
    const std::string tum = path("tum.txt"), kitti = path("kitti.txt"), matrices = path("matrices.txt");
    expect_error("planemap-evaluate", tum + " " + kitti, "KITTI");
    expect_error("planemap-evaluate", kitti + " " + tum, "KITTI");
    expect_error("planemap-evaluate", kitti + " " + path("short.txt"), "equally long");
    expect_error("planemap-evaluate", kitti + " " + kitti + " --offset 1", "--offset");
    expect_error("planemap-evaluate", kitti + " " + kitti + " --delta 1", "--delta-unit");
    expect_error("planemap-evaluate", tum + " " + matrices,
                 "matrices.txt:1: 16 numbers a line: 4 x 4 matrices");
    expect_error("planemap-run", "sim:office --output " + path("out") + " --poses " + kitti, "KITTI");
}

TEST_F(ProgramsTest, EvaluateSaysWhatIsWrongWithTheFiles) {
    const std::string pose = " 0 0 0 0 0 0 1\n";
    write_file(folder_ / "truth.txt", "1" + pose + "2" + pose + "3" + pose);
    write_file(folder_ / "far.txt", "1" + pose + "2 1e308 0 0 0 0 0 1\n3" + pose);
    write_file(folder_ / "empty.txt", "# nothing\n");
    write_file(folder_ / "later.txt", "11" + pose + "12" + pose + "13" + pose);
    write_file(folder_ / "twice.txt", "1" + pose + "1 5 0 0 0 0 0 1\n2" + pose + "2" + pose + "3" + pose);
    const std::string truth = path("truth.txt") + " ";
    expect_error("planemap-evaluate", truth + path("far.txt"), "far.txt:2: tx is 1e+308 m");
    expect_error("planemap-evaluate", truth + path("empty.txt"), "empty.txt: holds no poses");
    expect_error("planemap-evaluate", path("empty.txt") + " " + truth, "empty.txt: holds no poses");
    expect_error("planemap-evaluate", truth + path("later.txt"),
                 "later.txt covers 11.000 to 13.000 s, the truth " + path("truth.txt") + " 1.000 to 3.000 s");
    const Outcome twice = run("planemap-evaluate", truth + path("twice.txt"));
    EXPECT_EQ(twice.exit_code, 0) << twice.err;
    EXPECT_EQ(twice.err,
              "planemap-evaluate: " + path("twice.txt") +
                  ": 1 pose stands there twice, 1 pose says something else than another of the same "
                  "stamp, of which the last is taken\n");
}

TEST_F(ProgramsTest, GivenPosesThatFitNothingAreAnError) {
    const std::string world = "'sim:office?frames=4&width=160&height=120' --no-octomap -q ";
    write_file(folder_ / "empty.txt", "");
    expect_error("planemap-run", world + "--output " + path("out") + " --poses " + path("empty.txt"),
                 "empty.txt: holds no poses");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
    write_file(folder_ / "other.txt", "100 0 0 0 0 0 0 1\n200 0 0 0 0 0 0 1\n");
    expect_error("planemap-run", world + "--output " + path("out") + " --poses " + path("other.txt"),
                 "other.txt covers 100.000 to 200.000 s, the input 1.000 to 1.100 s");
}

TEST_F(ProgramsTest, FramesOfEveryInput) {
    const std::string world = "'sim:office?frames=12&width=320&height=240' ";
    ASSERT_EQ(run("planemap-simulate", world + "--output " + path("office.lcmlog")).exit_code, 0);
    const Trajectory truth = read_trajectory(folder_ / "groundtruth.txt");
    for (const std::string& input : {world, path("office.lcmlog")}) {
        for (const auto& [range, first, count] :
             {std::tuple("4:9", 4, 5), {"8:", 8, 4}, {":3", 0, 3}, {"10:99", 10, 2}}) {
            const Outcome outcome = run(
                "planemap-run", input + " --no-octomap -q --output " + path("out") + " --frames " + range);
            ASSERT_EQ(outcome.exit_code, 0) << input << range << outcome.err;
            EXPECT_EQ(report("out").at("frames"), count) << input << range;
            // The first frame's own time, or its colour image's, some milliseconds away.
            const Trajectory trajectory = read_trajectory(folder_ / "out/trajectory.txt");
            EXPECT_NEAR(static_cast<double>(trajectory.at(0).utime),
                        static_cast<double>(truth.at(static_cast<std::size_t>(first)).utime), 15000.0);
        }
        for (const char* bad : {"12:", "9:4", "x:4", "4"})
            expect_error("planemap-run", input + " -q --output " + path("out") + " --frames " + bad,
                         "frames ");
    }
}

TEST_F(ProgramsTest, GivenPosesAreNotAccuracy) {
    const std::string world = "'sim:office?frames=8&width=160&height=120' --no-octomap -q ";
    const Outcome tracked = run("planemap-run", world + "--output " + path("a"));
    ASSERT_EQ(tracked.exit_code, 0) << tracked.err;
    EXPECT_THAT(tracked.out, AllOf(HasSubstr("ATE"), HasSubstr("There is no OctoMap of this run"),
                                   Not(HasSubstr("explain **not measured**"))));
    std::filesystem::copy_file(folder_ / "a/groundtruth.txt", folder_ / "poses");
    const Outcome truth = run("planemap-run", world + "--output " + path("b") + " --poses " + path("poses"));
    ASSERT_EQ(truth.exit_code, 0) << truth.err;
    EXPECT_THAT(truth.out,
                AllOf(Not(HasSubstr("ATE")), HasSubstr("they are the truth beside the input itself")));
    EXPECT_FALSE(report("b").contains("accuracy"));
    const Outcome other =
        run("planemap-run", world + "--output " + path("c") + " --poses " + path("a/trajectory.txt"));
    ASSERT_EQ(other.exit_code, 0) << other.err;
    EXPECT_THAT(other.out, AllOf(HasSubstr("ATE"), HasSubstr("poses that were given (--poses)")));
}

TEST_F(ProgramsTest, FramesFarApartAreWarnedOf) {
    const std::string common = " --no-octomap -q --output " + path("out");
    const Outcome slow = run("planemap-run", "'sim:office?frames=6&rate=1.5&width=160&height=120'" + common);
    EXPECT_THAT(slow.err, HasSubstr("frames are 0.67 s apart"));
    EXPECT_THAT(slow.out, HasSubstr("**Warning:** frames are 0.67 s apart"));
    EXPECT_FALSE(report("out").at("warnings").empty());
    const Outcome fast = run("planemap-run", "'sim:office?frames=6&width=160&height=120'" + common);
    EXPECT_EQ(fast.exit_code, 0) << fast.err;
    EXPECT_TRUE(report("out").at("warnings").empty());
}

}  // namespace
}  // namespace planemap
