// SPDX-License-Identifier: BSD-3-Clause
// What becomes of results when disks are full, folders are used, and runs are killed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "core/trajectory.hpp"
#include "map/map_file.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/image_codec.hpp"
#include "messages/log.hpp"
#include "tools/programs.hpp"

namespace planemap {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class RunResults : public test::Programs {
  protected:
    /// All files of a folder with their bytes, hidden ones included; folders in it are left out.
    std::map<std::string, std::string> bytes_of(const std::string& name) {
        std::map<std::string, std::string> bytes;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / name))
            if (entry.is_regular_file()) bytes[entry.path().filename().string()] = read_file(entry.path());
        return bytes;
    }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
    /// The one folder of that kind in a folder; empty if there is none or more.
    std::filesystem::path aside(const std::string& name) {
        std::filesystem::path found;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / name)) {
            if (!entry.path().filename().string().starts_with("partial-")) continue;
            EXPECT_EQ(found, "");
            found = entry.path();
        }
        return found;
    }
    void expect_essentials(const std::filesystem::path& folder) {
        EXPECT_GT(map::read_plane_map(folder / "plane_map.lcmlog").planes.size(), 0u);
        EXPECT_GT(read_trajectory(folder / "trajectory.txt").size(), 0u);
        EXPECT_GT(nlohmann::json::parse(read_file(folder / "planes.json")).at("planes").size(), 0u);
    }
    /// A log of frames without a reading, so far apart.
    std::string dark_log(std::int64_t step_us = 33333) {
        CameraInfo camera;
        camera.depth = camera.color = {64, 48, 50, 50, 31.5, 23.5};
        messages::LogWriter log(folder_ / "dark.lcmlog");
        const auto write = [&](const char* channel, const auto& message) {
            messages::LogEvent event{
                0, 0, channel, std::vector<std::uint8_t>(static_cast<std::size_t>(message.getEncodedSize()))};
            message.encode(event.bytes.data(), 0, message.getEncodedSize());
            log.write(event);
        };
        write(messages::channels::kCameraInfo, messages::to_message(camera, 0, 0));
        for (int i = 0; i < 5; ++i) {
            bot_core::images_t images;
            images.utime = 1000000 + step_us * i;
            images.n_images = 1;
            images.image_types = {bot_core::images_t::DEPTH_MM_ZIPPED};
            images.images = {messages::depth_image_message(DepthImage(64, 48), images.utime,
                                                           messages::DepthEncoding::kZipped)};
            write(messages::channels::kFrame, images);
        }
        log.close();
        return path("dark.lcmlog");
    }
};

TEST_F(RunResults, ALaterRunLeavesNothingOfAnEarlierOneAndNothingOfOthersIsTouched) {
    ASSERT_EQ(run("planemap-run", "'sim:office?frames=20' -q -o " + path("out")).exit_code, 0);
    EXPECT_TRUE(exists("out/octomap.bt") && exists("out/groundtruth.txt") && exists("out/planes_truth.json"));
    write_file(folder_ / "out/notes.txt", "foreign");
    ASSERT_EQ(run("planemap-simulate", "'sim:office?frames=20' -o " + path("log/office.lcmlog")).exit_code,
              0);
    const std::string common = "-q --no-octomap -o " + path("out");
    ASSERT_EQ(run("planemap-run", path("log/office.lcmlog") + " " + common).exit_code, 0);
    for (const char* name : {"octomap.bt", "groundtruth.txt", "planes_truth.json"})
        EXPECT_FALSE(exists(std::string("out/") + name)) << name;
    EXPECT_EQ(read_file(folder_ / "out/notes.txt"), "foreign");

    // A recording's own truth has the name of the simulator's.
    write_file(folder_ / "out/groundtruth.txt", "# foreign\n");
    ASSERT_EQ(run("planemap-run", path("log/office.lcmlog") + " " + common).exit_code, 0);
    expect_error("planemap-run", "'sim:office?frames=20' " + common, "groundtruth.txt");
    expect_error("planemap-simulate", "'sim:office?frames=20' -o " + path("out/office.lcmlog"),
                 "groundtruth.txt");
    EXPECT_EQ(read_file(folder_ / "out/groundtruth.txt"), "# foreign\n");
    for (const auto& [name, bytes] : bytes_of("out")) EXPECT_NE(name[0], '.') << name;
}

TEST_F(RunResults, AGoodMapIsNotReplacedByAnEmptyOne) {
    ASSERT_EQ(run("planemap-run", "'sim:office?frames=20' -q -o " + path("out")).exit_code, 0);
    const auto good = bytes_of("out");
    const std::string dark = dark_log();
    const Outcome empty = run("planemap-run", dark + " -o " + path("out"));
    EXPECT_EQ(empty.exit_code, 1);
    EXPECT_THAT(empty.err, AllOf(HasSubstr("none of its 5 frames"),
                                 HasSubstr(path("out") + " keeps the results of an earlier run")));
    EXPECT_EQ(std::count(empty.err.begin(), empty.err.end(), '\n'), 1) << empty.err;
    EXPECT_TRUE(bytes_of("out") == good);
    EXPECT_EQ(aside("out"), "") << "there is nothing to keep";

    // What is said is why: the depth of frames that are refused was not looked at.
    const Outcome refused = run("planemap-run", dark_log(-33333) + " -o " + path("other"));
    EXPECT_THAT(refused.err, HasSubstr("could be tracked: 4 frames whose stamp went back are not used"));

    // Tracked, but no planes: its trajectory is worth something.
    const Outcome bare = run("planemap-run",
                             "'sim:office?frames=20' -q --no-octomap --map-min-area-m2 1e6 "
                             "--map-min-single-m2 1e6 -o " +
                                 path("out"));
    EXPECT_EQ(bare.exit_code, 1);
    EXPECT_THAT(bare.err, HasSubstr("no planes"));
    EXPECT_TRUE(bytes_of("out") == good);
    EXPECT_EQ(read_trajectory(aside("out") / "trajectory.txt").size(), 20u);
}

/// The walk of a log with its stamps falling: all frames but the first are refused.
void let_stamps_fall(const std::filesystem::path& from, const std::filesystem::path& to) {
    messages::LogReader walk(from);
    messages::LogWriter log(to);
    for (messages::LogEvent event; walk.next(event);) {
        if (event.channel == messages::channels::kFrame) {
            auto images = messages::decode<bot_core::images_t>(event.bytes);
            images.utime = 100000000 - images.utime;
            event.bytes.resize(static_cast<std::size_t>(images.getEncodedSize()));
            images.encode(event.bytes.data(), 0, images.getEncodedSize());
        }
        log.write(event);
    }
    log.close();
}

TEST_F(RunResults, ARunThatTrackedFewFramesDoesNotReplaceABetterOne) {
    ASSERT_EQ(run("planemap-simulate", "'sim:office?frames=20' -o " + path("log/walk.lcmlog")).exit_code, 0);
    let_stamps_fall(folder_ / "log/walk.lcmlog", folder_ / "log/falling.lcmlog");
    const std::string common = " -q --no-octomap -o " + path("out");
    ASSERT_EQ(run("planemap-run", path("log/walk.lcmlog") + common).exit_code, 0);
    const auto good = bytes_of("out");
    const Outcome falling = run("planemap-run", path("log/falling.lcmlog") + common);
    EXPECT_EQ(falling.exit_code, 1);
    EXPECT_TRUE(bytes_of("out") == good);
    ASSERT_NE(aside("out"), "");
    EXPECT_THAT(
        falling.err,
        AllOf(HasSubstr("falling.lcmlog: only 1 of its 20 frames tracked; " + path("out") +
                        " keeps the results of an earlier run, the new ones are in " + aside("out").string()),
              HasSubstr("why not the others: 19 frames whose stamp went back are not used")));
    EXPECT_EQ(report(aside("out").string()).at("tracked"), 1);

    // Into a folder of its own it is written, and a better run replaces it.
    const std::string fresh = " -q --no-octomap -o " + path("fresh");
    EXPECT_EQ(run("planemap-run", path("log/falling.lcmlog") + fresh).exit_code, 0);
    EXPECT_EQ(run("planemap-run", path("log/falling.lcmlog") + fresh).exit_code, 0) << "no worse than before";
    EXPECT_EQ(report("fresh").at("tracked"), 1);
    EXPECT_EQ(run("planemap-run", path("log/walk.lcmlog") + fresh).exit_code, 0);
    EXPECT_EQ(report("fresh").at("tracked"), 20);
    EXPECT_EQ(aside("fresh"), "");
}

TEST_F(RunResults, AnInterruptedRunDoesNotReplaceAWholeOne) {
    ASSERT_EQ(run("planemap-run", "'sim:office?frames=20' -q --no-octomap -o " + path("out")).exit_code, 0);
    EXPECT_FALSE(report("out").at("interrupted").get<bool>());
    const auto good = bytes_of("out");
    const std::string interrupt =
        "$bin/planemap-run 'sim:office?frames=4000' --no-octomap -o $dir/OUT >/dev/null 2>$dir/said & "
        "run=$!\n"
        "for ((i = 0; i < 600; ++i)); do [[ -e $dir/OUT/.partial/planes.json ]] && break; sleep 0.1; done\n"
        "kill -INT $run; wait $run; code=$?; cat $dir/said >&2; exit $code";
    const auto into = [&](std::string name) {
        std::string line = interrupt;
        for (auto at = line.find("OUT"); at != std::string::npos; at = line.find("OUT"))
            line.replace(at, 3, name);
        return run_shell(line);
    };
    const Outcome stopped = into("out");
    EXPECT_EQ(stopped.exit_code, 1);
    EXPECT_TRUE(bytes_of("out") == good);
    ASSERT_NE(aside("out"), "");
    EXPECT_THAT(stopped.err, AllOf(HasSubstr("ended before the end of its input"),
                                   HasSubstr("keeps the results of an earlier run, the new ones are in " +
                                             aside("out").string())));
    EXPECT_TRUE(report(aside("out").string()).at("interrupted").get<bool>());

    EXPECT_EQ(into("fresh").exit_code, 0);
    EXPECT_TRUE(report("fresh").at("interrupted").get<bool>());
    expect_essentials(folder_ / "fresh");
}

TEST_F(RunResults, AStopBeforeTheFirstFrameDoesNotBlameTheInput) {
    const Outcome stopped = run_shell(
        "for ((i = 0; i < 40; ++i)); do\n"
        "  $bin/planemap-run 'sim:office?frames=50' -q --no-octomap -o $dir/out >/dev/null 2>$dir/said & "
        "run=$!\n"
        "  until [[ -e $dir/out/.partial.lock ]]; do :; done; kill -INT $run; wait $run; code=$?\n"
        "  grep -q 'stopped after 0 frames' $dir/said && break; rm -rf $dir/out; code=77\n"
        "done; cat $dir/said >&2; exit $code");
    if (stopped.exit_code == 77) GTEST_SKIP() << "no stop came before the first frame";
    EXPECT_EQ(stopped.exit_code, 1);
    EXPECT_THAT(stopped.err, AllOf(HasSubstr("stopped before the first frame of sim:office"),
                                   Not(HasSubstr("could be used"))));
}

TEST_F(RunResults, TwoLogsInOneFolderDoNotShareATruth) {
    const std::string a = "-o " + path("sim/a.lcmlog"), b = "-o " + path("sim/b.lcmlog");
    ASSERT_EQ(run("planemap-simulate", "'sim:office?frames=3' " + a).exit_code, 0);
    const auto first = bytes_of("sim");
    expect_error("planemap-simulate", "'sim:office?frames=5' " + b,
                 "groundtruth.txt: is the truth of a.lcmlog");
    write_file(folder_ / "sim/b.lcmlog", "a recording of another kind");
    expect_error("planemap-simulate", "'sim:office?frames=5' " + b,
                 "groundtruth.txt: is the truth of a.lcmlog");
    std::filesystem::remove(folder_ / "sim/b.lcmlog");
    EXPECT_TRUE(bytes_of("sim") == first);
    EXPECT_EQ(run("planemap-simulate", "'sim:office?frames=5' " + a).exit_code, 0) << "its own it replaces";
    EXPECT_EQ(read_trajectory(folder_ / "sim/groundtruth.txt").size(), 5u);
}

TEST_F(RunResults, WhatTakesTheFoldersPlaceIsSaidAsItIs) {
    const Outcome result = run_shell(
        "$bin/planemap-run 'sim:office?frames=4000' -q --no-octomap -o $dir/out >/dev/null & run=$!\n"
        "for ((i = 0; i < 600; ++i)); do [[ -e $dir/out/.partial/planes.json ]] && break; sleep 0.1; done\n"
        "rm -r $dir/out; echo mine >$dir/out; sleep 0.5; kill -INT $run; wait $run");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("out: is no folder any more; the results go to " + path("out-2")));
    EXPECT_EQ(read_file(folder_ / "out"), "mine\n");
    expect_essentials(folder_ / "out-2");
}

TEST_F(RunResults, OfTwoRunsIntoOneFolderTheSecondIsRefused) {
    const Outcome both = run_shell(
        "$bin/planemap-run 'sim:office?frames=2000' -q --no-octomap -o $dir/out >/dev/null & first=$!\n"
        "until [[ -e $dir/out/.partial.lock ]]; do sleep 0.05; done; sleep 0.2\n"
        "$bin/planemap-run 'sim:office?frames=5' -q -o $dir/out; code=$?\n"
        "kill -INT $first; wait $first || echo first failed\n"
        "exit $code");
    EXPECT_EQ(both.exit_code, 1);
    EXPECT_THAT(both.err, HasSubstr("another run"));
    EXPECT_THAT(both.out, Not(HasSubstr("failed")));
    EXPECT_GT(report("out").at("frames").get<int>(), 5) << "Ctrl-C wrote what was mapped";
    EXPECT_FALSE(exists("out/.partial.lock"));
}

TEST_F(RunResults, AKilledRunLeavesWhatItHadAndTheNextOneSaysWhere) {
    const Outcome killed = run_shell(
        "$bin/planemap-run 'sim:office?frames=4000' -q --no-octomap -o $dir/out >/dev/null & run=$!\n"
        "for ((i = 0; i < 600; ++i)); do [[ -e $dir/out/.partial/planes.json ]] && break; sleep 0.1; done\n"
        "kill -KILL $run; wait $run; [[ $? -eq 137 ]]");
    ASSERT_EQ(killed.exit_code, 0) << killed.err;
    expect_essentials(folder_ / "out/.partial");
    const Outcome next = run("planemap-run", "'sim:office?frames=10' -q --no-octomap -o " + path("out"));
    EXPECT_EQ(next.exit_code, 0) << next.err;
    ASSERT_NE(aside("out"), "");
    EXPECT_THAT(next.err, HasSubstr(aside("out").string()));
    expect_essentials(aside("out"));
    expect_essentials(folder_ / "out");
}

TEST_F(RunResults, AFolderThatIsRemovedMeanwhileIsThereAtTheEnd) {
    const Outcome result = run_shell(
        "$bin/planemap-run 'sim:office?frames=4000' -q --no-octomap -o $dir/out >/dev/null & run=$!\n"
        "for ((i = 0; i < 600; ++i)); do [[ -e $dir/out/.partial/planes.json ]] && break; sleep 0.1; done\n"
        "rm -r $dir/out; sleep 0.5; kill -INT $run; wait $run");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("removed meanwhile"));
    expect_essentials(folder_ / "out");
    EXPECT_GT(report("out").at("planes").get<int>(), 0);
}

/// Files of at most 80 kB: planes_truth.json, points.ply and report.html are larger, and what is made after
/// them is not.
TEST_F(RunResults, WhatCanBeWrittenIsWrittenAndAHalfSetReplacesNoWholeOne) {
    const std::string limited = "ulimit -f 80; $bin/planemap-run 'sim:office?frames=60' -q -o $dir/";
    const Outcome first = run_shell(limited + "first");
    EXPECT_EQ(first.exit_code, 1);
    for (const char* name : {"planes_truth.json", "points.ply", "report.html"})
        EXPECT_THAT(first.err, HasSubstr(std::string(name) + ": cannot write: File too large"));
    EXPECT_THAT(first.err, HasSubstr("3 of the results could not be written"));
    EXPECT_EQ(std::count(first.err.begin(), first.err.end(), '\n'), 4) << first.err;
    EXPECT_THAT(first.out, AllOf(HasSubstr("octomap.bt"), Not(HasSubstr("planes_truth.json"))));
    expect_essentials(folder_ / "first");
    for (const char* name : {"report.json", "map.svg", "planes.glb", "octomap.bt"})
        EXPECT_TRUE(exists(std::string("first/") + name)) << name;
    EXPECT_FALSE(exists("first/planes_truth.json"));

    ASSERT_EQ(run("planemap-run", "'sim:office?frames=20' -q -o " + path("used")).exit_code, 0);
    const auto good = bytes_of("used");
    const Outcome second = run_shell(limited + "used");
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_TRUE(bytes_of("used") == good);
    ASSERT_NE(aside("used"), "");
    EXPECT_THAT(second.err, HasSubstr(aside("used").string()));
    expect_essentials(aside("used"));
    EXPECT_EQ(report(aside("used").string()).at("frames"), 60);
}

/// A disk that is full at the end, not at the start.
TEST_F(RunResults, ADiskThatIsFullAtTheEndKeepsTheEarlierMap) {
    const Outcome result = run_shell(
        "cat >$dir/inside <<'END'\n"
        "mount -t tmpfs -o size=16m none $1/disk || exit 77\n"
        "$2/planemap-run 'sim:office?frames=20' -q --no-octomap -o $1/disk/out >/dev/null || exit 1\n"
        "(cd $1/disk/out && sha256sum *) >$1/before\n"
        "$2/planemap-run 'sim:office?frames=4000' -q --no-octomap -o $1/disk/out >/dev/null & run=$!\n"
        "until [[ -e $1/disk/out/.partial/planes.json ]]; do sleep 0.1; done\n"
        "head -c 64m /dev/zero >$1/disk/filler 2>/dev/null; sleep 3.5; kill -INT $run; wait $run; code=$?\n"
        "(cd $1/disk/out && sha256sum *.*) >$1/after\n"
        "ls -d $1/disk/out/partial-*; ls $1/disk/out/partial-*\n"
        "exit $code\n"
        "END\n"
        "mkdir $dir/disk\n"
        "for own in 'unshare --mount' 'unshare --mount --map-root-user'; do\n"
        "  $own true 2>/dev/null || continue; $own bash $dir/inside $dir $bin; exit\n"
        "done; exit 77");
    if (result.exit_code == 77) GTEST_SKIP() << "no mount namespace may be made here";
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_THAT(result.err, AllOf(HasSubstr("No space left on device"), HasSubstr("keeps the results")));
    EXPECT_EQ(read_file(folder_ / "after"), read_file(folder_ / "before"));
    EXPECT_THAT(result.out, AllOf(HasSubstr("plane_map.lcmlog"), HasSubstr("trajectory.txt")))
        << "what was mapped is set aside, in the state that fitted last";
}

TEST_F(RunResults, AReportThatCannotBePrintedIsAnError) {
    const Outcome result =
        run_shell("$bin/planemap-run 'sim:office?frames=10' -q --no-octomap -o $dir/out >/dev/full");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, HasSubstr("standard output"));
    expect_essentials(folder_ / "out");
    EXPECT_EQ(run_shell("$bin/planemap-report $dir/out >/dev/full").exit_code, 1);
    const std::string trajectory = " $dir/out/trajectory.txt ";
    for (const std::string json : {"", "--json -", "--json $dir/figures.json"}) {
        EXPECT_EQ(
            run_shell("$bin/planemap-evaluate" + trajectory + trajectory + json + " >/dev/full").exit_code, 1)
            << json;
    }
}

TEST_F(RunResults, TheSimulatorsWritingErrorsEndIt) {
    ASSERT_EQ(run("planemap-simulate", "'sim:office?frames=5' -o " + path("sim/a.lcmlog")).exit_code, 0);
    const auto good = bytes_of("sim");
    const Outcome cut =
        run_shell("ulimit -f 1000; $bin/planemap-simulate 'sim:office?frames=60' -o $dir/sim/a.lcmlog");
    EXPECT_EQ(cut.exit_code, 1);
    EXPECT_THAT(cut.err, HasSubstr("File too large"));
    EXPECT_EQ(cut.out, "");
    EXPECT_TRUE(bytes_of("sim") == good);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "sim"), {}), 3)
        << "nothing is left behind";

    std::filesystem::create_directories(folder_ / "folder");
    expect_error("planemap-simulate", "sim:office -o " + path("folder"), "is a folder");
    expect_error("planemap-simulate", "sim:office -o " + path("folder") + "/", "is a folder");
    for (const char* name : {"groundtruth.txt", "planes_truth.json"})
        expect_error("planemap-simulate", "sim:office -o " + path("other/") + name,
                     "is the name of the truth");
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "folder"));
}

}  // namespace
}  // namespace planemap
