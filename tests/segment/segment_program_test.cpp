// SPDX-License-Identifier: BSD-3-Clause
// planemap-segment as a user runs it: real files, real exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

#include "core/files.hpp"
#include "segment/small_scene.hpp"
#include "sensor/test_images.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class SegmentProgram : public testing::Test {
  protected:
    struct Result {
        int exit_code;
        std::string out, err;
    };
    Result run(const std::string& arguments) const {
        const std::string out = folder.path() / "stdout", err = folder.path() / "stderr";
        const std::string command = "cd '" + folder.path().string() +
                                    "' && " PLANEMAP_BIN "/planemap-segment " + arguments + " >'" + out +
                                    "' 2>'" + err + "'";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(out),
                read_file(err)};
    }
    template <typename Matcher>
    void expect_error(const std::string& arguments, const Matcher& message) const {
        const Result result = run(arguments);
        EXPECT_TRUE(result.exit_code == 1 || result.exit_code == 2) << arguments << result.exit_code;
        EXPECT_THAT(result.err, message) << arguments;
    }
    bool exists(const char* name) const { return std::filesystem::exists(folder.path() / name); }

    const test::TemporaryFolder folder;
    const std::filesystem::path camera = folder.write("camera.json", small_camera_json());
    const std::filesystem::path first = folder.write("a.png", sensor::encode_depth_png(small_depth()));
    const std::filesystem::path second = folder.write("b.png", sensor::encode_depth_png(small_depth()));
};

TEST_F(SegmentProgram, WritesLabelsAndRegionsOfEachImage) {
    const Result result = run("a.png --camera camera.json b.png --output out --overlay --repeat 2");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("2 of 2 images"));
    for (const char* file : {"out/a.png", "out/a.json", "out/a.overlay.png", "out/b.png", "out/b.json"})
        EXPECT_TRUE(exists(file)) << file;
}

TEST_F(SegmentProgram, KnowsThePapersMethodOrSaysThatItIsLeftOut) {
    const Result result = run("a.png --camera camera.json --output out --method ransac");
#ifdef PLANEMAP_PCL
    EXPECT_EQ(result.exit_code, 0) << result.err;
#else
    EXPECT_NE(result.exit_code, 0);
    EXPECT_THAT(result.err, HasSubstr("without PCL"));
#endif
}

TEST_F(SegmentProgram, GoesOnAfterABadImageAndSaysSoInTheExitCode) {
    folder.write("bad.png", "no image");
    const Result result = run("a.png bad.png b.png --camera camera.json --output out");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.err, AllOf(HasSubstr("bad.png"), HasSubstr("not a PNG")));
    EXPECT_THAT(result.out, HasSubstr("2 of 3 images"));
    EXPECT_TRUE(exists("out/b.json"));
}

TEST_F(SegmentProgram, MistakesAreNamed) {
    expect_error("--camera camera.json --output out", HasSubstr("DEPTH.png"));
    expect_error("a.png --output out", HasSubstr("--camera"));
    expect_error("a.png --camera camera.json", HasSubstr("--output"));
    expect_error("a.png --camera none.json --output out", HasSubstr("none.json"));
    expect_error("a.png --camera camera.json --output out --method hough", HasSubstr("method"));
    expect_error("a.png --camera camera.json --output out --repeat -3", HasSubstr("repeat"));
    expect_error("a.png --camera camera.json --output out --overlays", HasSubstr("--overlays"));
    EXPECT_FALSE(exists("out"));
}

TEST_F(SegmentProgram, ACameraWithBadIntrinsicsIsNamedByField) {
    folder.write(
        "zero.json",
        R"({"depth_camera": {"width": 320, "height": 240, "fx": 0, "fy": 277, "cx": 159.5, "cy": 119.5}, )"
        R"("depth_units_per_metre": 1000})");
    expect_error("a.png --camera zero.json --output out", AllOf(HasSubstr("zero.json"), HasSubstr("fx")));
    folder.write(
        "nan.json",
        R"({"depth_camera": {"width": 320, "height": 240, "fx": 277, "fy": 277, "cx": NaN, "cy": 1}, )"
        R"("depth_units_per_metre": 1000})");
    expect_error("a.png --camera nan.json --output out", HasSubstr("nan.json"));
    folder.write(
        "null.json",
        R"({"depth_camera": {"width": 320, "height": 240, "fx": 277, "fy": 277, "cx": null, "cy": 1}, )"
        R"("depth_units_per_metre": 1000})");
    expect_error("a.png --camera null.json --output out", AllOf(HasSubstr("null.json"), HasSubstr("cx")));
}

TEST_F(SegmentProgram, HelpTeaches) {
    const Result result = run("--help");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, AllOf(HasSubstr("Example"), HasSubstr("--repeat"), HasSubstr("--method")));
}

}  // namespace
}  // namespace planemap
