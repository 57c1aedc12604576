// SPDX-License-Identifier: BSD-3-Clause
#include "segment/segment_images.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "segment/small_scene.hpp"
#include "sensor/png.hpp"
#include "sensor/test_images.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class SegmentImages : public testing::Test {
  protected:
    SegmentImagesReport segment(const std::vector<std::filesystem::path>& images) {
        options.images = images;
        return segment_images(options, camera);
    }
    nlohmann::json json(const std::string& name) const {
        return nlohmann::json::parse(read_file(options.output / name));
    }

    const test::TemporaryFolder folder;
    const CameraInfo camera = small_camera();
    const std::filesystem::path image = folder.write("a.png", sensor::encode_depth_png(small_depth()));
    SegmentImagesOptions options{{}, folder.path() / "out", 0, false, true, {}};
};

TEST_F(SegmentImages, LabelsAreTheLibrarys) {
#ifdef PLANEMAP_PCL
    const std::vector<std::string> methods{"cells", "ransac"};
#else
    const std::vector<std::string> methods{"cells"};
#endif
    for (const std::string& method : methods) {
        options.segmentation.method = method;
        const SegmentImagesReport report = segment({image});
        EXPECT_THAT(report.errors, IsEmpty());
        segmentation::Segmentation expected;
        segmentation::make_segmenter(options.segmentation)->segment(small_depth(), camera, expected);
        EXPECT_EQ(report.regions, expected.regions.size());
        EXPECT_EQ(sensor::decode_depth_png(read_file(options.output / "a.png"), 320, 240).pixels,
                  expected.labels.pixels);
        EXPECT_EQ(json("a.json")["regions"].size(), expected.regions.size());
        EXPECT_EQ(json("a.json")["method"], method);
        EXPECT_FALSE(json("a.json").contains("time_ms"));
    }
}

TEST_F(SegmentImages, TimeIsMeasuredOnRequest) {
    options.repeat = 5;
    segment({image});
    const nlohmann::json time = json("a.json")["time_ms"];
    EXPECT_EQ(time["repeats"], 5);
    EXPECT_GT(time["median"], 0);
    EXPECT_GE(time["p95"], time["median"]);
}

TEST_F(SegmentImages, OverlayIsDrawnOnRequest) {
    segment({image});
    EXPECT_FALSE(std::filesystem::exists(options.output / "a.overlay.png"));
    options.overlay = true;
    segment({image});
    EXPECT_EQ(sensor::decode_color_png(read_file(options.output / "a.overlay.png"), 320, 240).width, 320);
}

TEST_F(SegmentImages, ABadImageCostsItselfOnly) {
    const std::string png = sensor::encode_depth_png(small_depth());
    const SegmentImagesReport report =
        segment({folder.path() / "missing.png",
                 folder.write("size.png", sensor::encode_depth_png(DepthImage(10, 20))),
                 folder.write("cut.png", png.substr(0, png.size() / 2)), folder.write("text.png", "hello"),
                 folder.write("empty.png", ""), image});
    EXPECT_THAT(report.errors,
                ElementsAre(AllOf(HasSubstr("missing.png"), HasSubstr("No such file")),
                            AllOf(HasSubstr("size.png"), HasSubstr("10x20"), HasSubstr("320x240")),
                            HasSubstr("cut.png"), AllOf(HasSubstr("text.png"), HasSubstr("not a PNG")),
                            HasSubstr("empty.png")));
    EXPECT_TRUE(std::filesystem::exists(options.output / "a.json"));
    EXPECT_FALSE(std::filesystem::exists(options.output / "size.png"));
}

TEST_F(SegmentImages, ImagesCutBehindTheirLastPixelAreUsedAndSaid) {
    const std::string png = sensor::encode_depth_png(small_depth());
    const std::string cut = png.substr(0, png.size() - 12);  // IEND
    const SegmentImagesReport report =
        segment({image, folder.write("cut.png", cut), folder.write("too.png", cut)});
    EXPECT_THAT(report.errors, IsEmpty());
    EXPECT_THAT(report.notes,
                ElementsAre(AllOf(HasSubstr("cut.png: the PNG is cut short, but behind its last pixel"),
                                  HasSubstr("and 1 more such images"))));
    EXPECT_EQ(json("cut.json").at("regions"), json("a.json").at("regions"));
}

TEST_F(SegmentImages, AnImageWithoutReadingsHasNoRegions) {
    const SegmentImagesReport report =
        segment({folder.write("dark.png", sensor::encode_depth_png(DepthImage(320, 240)))});
    EXPECT_THAT(report.errors, IsEmpty());
    EXPECT_EQ(json("dark.json")["regions"], nlohmann::json::array());
}

TEST_F(SegmentImages, TwoImagesOfOneNameAreRefusedBeforeAnythingIsDone) {
    const auto twin = folder.write("other/a.png", sensor::encode_depth_png(small_depth()));
    EXPECT_THAT(test::error_of([&] {
                    segment({image, twin});
                }),
                AllOf(HasSubstr(image.string()), HasSubstr(twin.string())));
    EXPECT_FALSE(std::filesystem::exists(options.output));
}

TEST_F(SegmentImages, InputsAreNotOverwritten) {
    options.output = folder.path();
    EXPECT_THAT(segment({image}).errors, ElementsAre(AllOf(HasSubstr("a.png"), HasSubstr("--output"))));
    EXPECT_EQ(read_file(image), sensor::encode_depth_png(small_depth()));
}

TEST_F(SegmentImages, AnEarlierRunsResultsAreReplacedAndOthersImagesAreNot) {
    options.overlay = true;
    segment({image});
    options.overlay = false;
    folder.write("out/b.png", "a picture of something else");
    folder.write("out/c.json", "{}");
    const auto second = folder.write("b.png", sensor::encode_depth_png(small_depth()));
    EXPECT_THAT(segment({image, second}).errors,
                ElementsAre(AllOf(HasSubstr("b.png"), HasSubstr("--output"))));
    EXPECT_FALSE(std::filesystem::exists(options.output / "a.overlay.png")) << "of the earlier run";
    EXPECT_EQ(read_file(options.output / "b.png"), "a picture of something else");
    EXPECT_TRUE(std::filesystem::exists(options.output / "c.json")) << "of an image that is not done now";
    EXPECT_FALSE(std::filesystem::exists(options.output / ".partial"));
}

TEST_F(SegmentImages, BadOptionsAreNamed) {
    options.repeat = -1;
    EXPECT_THAT(test::error_of([&] { segment({}); }), AllOf(HasSubstr("repeat"), HasSubstr("images")));
    options.repeat = 0;
    options.segmentation.method = "hough";
    EXPECT_THAT(test::error_of([&] { segment({image}); }), HasSubstr("method"));
    options.segmentation.method = "cells";
    options.output = image / "below a file";
    EXPECT_THAT(test::error_of([&] { segment({image}); }), HasSubstr("below a file"));
}

TEST_F(SegmentImages, ABadCameraIsNamedByField) {
    CameraInfo bad = camera;
    bad.depth.fx = 0;
    bad.depth.cy = std::numeric_limits<double>::quiet_NaN();
    options.images = {image};
    EXPECT_THAT(test::error_of([&] { segment_images(options, bad); }),
                AllOf(HasSubstr("fx"), HasSubstr("cy")));
}

TEST(TakeFiles, TellsFilesFromFlagsAndTheirValues) {
    std::vector<std::string> arguments{"a.png",      "--camera", "c.json", "b.png", "--overlay", "c.png",
                                       "--repeat=3", "-o",       "out",    "d.png", "--",        "-e.png"};
    EXPECT_THAT(take_files(arguments, {"--overlay"}),
                ElementsAre("a.png", "b.png", "c.png", "d.png", "-e.png"));
    EXPECT_THAT(arguments, ElementsAre("--camera", "c.json", "--overlay", "--repeat=3", "-o", "out"));
    arguments = {"--camera"};
    EXPECT_THAT(take_files(arguments, {}), IsEmpty());
    EXPECT_THAT(arguments, ElementsAre("--camera"));
}

}  // namespace
}  // namespace planemap
