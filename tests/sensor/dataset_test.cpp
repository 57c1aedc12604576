// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/dataset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "sensor/test_images.hpp"
#include "temporary_folder.hpp"

namespace planemap::sensor {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using Status = ReadResult::Status;

constexpr const char* kCamera = R"({"depth_camera": {"width": 16, "height": 12, "fx": 20, "fy": 20, "cx": 8,
    "cy": 6}, "depth_units_per_metre": 1000})";

/// A folder with a camera and two depth images, `depth/1.png` and `depth/2.png`.
struct Folder : test::TemporaryFolder {
    Folder() {
        write("camera.json", kCamera);
        write("depth/1.png", encode_depth_png(numbered_depth(16, 12)));
        write("depth/2.png", encode_depth_png(DepthImage(16, 12, 7)));
        write("rgb/1.jpg", encode_jpeg(16, 12));
        write("depth.txt", "# depth\n1.0 depth/1.png\n2.0 depth/2.png\n");
    }
};

TEST(Dataset, ReadsFramesInOrderOfTime) {
    const Folder folder;
    folder.write("rgb.txt", "1.015 rgb/1.jpg\n");
    folder.write("depth.txt", "# comment\n\n2.0 depth/2.png\r\n1.0 depth/1.png\n");
    Dataset dataset(folder.path());
    EXPECT_EQ(dataset.size(), 2u);
    SensorFrame frame;
    EXPECT_EQ(dataset.next(frame).status, Status::kFrame);
    EXPECT_EQ(frame.utime, 1000000);
    EXPECT_EQ(frame.color_utime, 1015000);
    EXPECT_EQ(frame.depth.pixels, numbered_depth(16, 12).pixels);
    const std::string jpeg = encode_jpeg(16, 12);
    EXPECT_TRUE(std::equal(frame.color_jpeg.begin(), frame.color_jpeg.end(), jpeg.begin(), jpeg.end(),
                           [](std::uint8_t a, char b) { return static_cast<char>(a) == b; }));
    EXPECT_TRUE(frame.color.empty());
    EXPECT_EQ(dataset.next(frame).status, Status::kFrame);
    EXPECT_EQ(frame.utime, 2000000);
    EXPECT_EQ(frame.color_utime, 0);
    EXPECT_TRUE(frame.color_jpeg.empty());
    EXPECT_EQ(dataset.next(frame).status, Status::kEnd);
    EXPECT_EQ(dataset.next(frame).status, Status::kEnd);
}

TEST(Dataset, TheTimeWindowIsAnOption) {
    const Folder folder;
    folder.write("rgb.txt", "1.015 rgb/1.jpg\n");
    EXPECT_FALSE(Dataset(folder.path(), {.max_color_gap_s = 0.01}).frames()[0].color);
    EXPECT_THROW(open_source(folder.path().string(), {.max_color_gap_s = -1}), std::invalid_argument);
}

TEST(Dataset, OnlyTheChosenFrames) {
    const Folder folder;
    SensorFrame frame;
    Dataset second(folder.path(), {.frames = {1, {}}});
    EXPECT_EQ(second.size(), 1u);
    ASSERT_EQ(second.next(frame).status, Status::kFrame);
    EXPECT_EQ(frame.utime, 2000000);
    EXPECT_EQ(second.next(frame).status, Status::kEnd);
    Dataset first(folder.path(), {.frames = {0, 1}});
    ASSERT_EQ(first.next(frame).status, Status::kFrame);
    EXPECT_EQ(frame.utime, 1000000);
    EXPECT_EQ(first.next(frame).status, Status::kEnd);
    EXPECT_THROW(Dataset(folder.path(), {.frames = {2, {}}}), std::invalid_argument);
}

TEST(Dataset, AssociationsMayHaveEitherOrder) {
    for (const char* line : {"1.1 rgb/1.jpg 1.0 depth/1.png\n", "1.0 depth/1.png 1.1 rgb/1.jpg\n"}) {
        const Folder folder;
        folder.write("associations.txt", line);
        Dataset dataset(folder.path());
        SensorFrame frame;
        EXPECT_EQ(dataset.size(), 1u);
        EXPECT_EQ(dataset.next(frame).status, Status::kFrame);
        EXPECT_EQ(frame.utime, 1000000);
        EXPECT_EQ(frame.color_utime, 1100000);
        EXPECT_FALSE(frame.color_jpeg.empty());
    }
}

TEST(Dataset, BrokenDepthIsOneBrokenFrame) {
    const std::string whole = encode_depth_png(numbered_depth(16, 12));
    const std::pair<std::string, const char*> cases[] = {
        {whole.substr(0, whole.size() / 2), "cut short"},
        {encode_depth_png(numbered_depth(8, 12)), "8x12"},
        {encode_png(16, 12, SPNG_COLOR_TYPE_GRAYSCALE, 8, std::vector<std::uint8_t>(192)), "8-bit"},
        {"", "not a PNG"},
    };
    for (const auto& [bytes, reason] : cases) {
        const Folder folder;
        folder.write("depth/1.png", bytes);
        Dataset dataset(folder.path());
        SensorFrame frame;
        const ReadResult broken = dataset.next(frame);
        EXPECT_EQ(broken.status, Status::kBroken);
        EXPECT_THAT(broken.message, AllOf(HasSubstr("depth/1.png"), HasSubstr(reason)));
        EXPECT_TRUE(frame.depth.empty());
        EXPECT_EQ(dataset.next(frame).status, Status::kFrame);
        EXPECT_EQ(frame.utime, 2000000);
    }
}

TEST(Dataset, APngCutShortBehindItsPixelsIsUsedAndTold) {
    const DepthImage depth = numbered_depth(16, 12);
    const std::string whole = encode_depth_png(depth);
    const std::string rgb =
        encode_png(16, 12, SPNG_COLOR_TYPE_TRUECOLOR, 8, std::vector<std::uint8_t>(576, 9));
    constexpr std::size_t kEndMarker = 12;
    const Folder folder;
    folder.write("rgb.txt", "1.0 rgb/1.png\n");
    for (const bool of_depth : {true, false}) {
        folder.write("depth/1.png", whole.substr(0, whole.size() - (of_depth ? kEndMarker : 0)));
        folder.write("rgb/1.png", rgb.substr(0, rgb.size() - (of_depth ? 0 : kEndMarker)));
        Dataset dataset(folder.path());
        SensorFrame frame;
        const ReadResult result = dataset.next(frame);
        EXPECT_EQ(result.status, Status::kFrame);
        EXPECT_TRUE(result.end_missing);
        EXPECT_FALSE(result.color_left_out);
        EXPECT_THAT(result.message,
                    AllOf(HasSubstr(of_depth ? "depth/1.png" : "rgb/1.png"), HasSubstr("cut short")));
        EXPECT_EQ(frame.depth.pixels, depth.pixels);
        EXPECT_EQ(frame.color(15, 11), (Rgb{9, 9, 9}));
        EXPECT_FALSE(dataset.next(frame).end_missing);
    }
}

TEST(Dataset, TheReasonIsTheSameForAllFilesWithTheSameFault) {
    const Folder folder;
    folder.write("depth.txt", "1.0 depth/none.png\n2.0 depth/neither.png\n3.0 depth/\x1b[2J.png\n");
    Dataset dataset(folder.path());
    SensorFrame frame;
    const ReadResult first = dataset.next(frame), second = dataset.next(frame), third = dataset.next(frame);
    EXPECT_NE(first.message, second.message);
    EXPECT_EQ(first.reason, second.reason);
    EXPECT_EQ(first.reason, "cannot open: No such file or directory");
    EXPECT_EQ(third.reason, first.reason);
    EXPECT_THAT(third.message, testing::Not(HasSubstr("\x1b")));
}

TEST(Dataset, NotesSayWhatIsLeftOver) {
    const Folder folder;
    EXPECT_THAT(Dataset(folder.path()).notes(), ElementsAre(HasSubstr("rgb.txt: missing")));
    folder.write("rgb.txt", "1.0 a\n2.0 b\n");
    EXPECT_THAT(Dataset(folder.path()).notes(), ElementsAre());
    folder.write("rgb.txt", "1.0 a\n1.5 b\n2.5 c\n");
    EXPECT_THAT(Dataset(folder.path()).notes(),
                ElementsAre(AllOf(HasSubstr("1 of 2 depth images"), HasSubstr("the nearest is 0.5 s away"),
                                  HasSubstr("2 of 3 colour images"))));
    folder.write("associations.txt", "1.0 depth/1.png 1.0 a\n");
    EXPECT_THAT(Dataset(folder.path()).notes(),
                ElementsAre(HasSubstr("leaves out 1 of the 2 images of depth.txt"),
                            HasSubstr("leaves out 2 of the 3 images of rgb.txt")));
    folder.write("rgb.txt", "what\n");
    EXPECT_THAT(Dataset(folder.path()).notes(), testing::Contains(HasSubstr("rgb.txt:1: expected")));
}

TEST(Dataset, WhatCameraJsonSaysInVainIsNoted) {
    const Folder folder;
    folder.write("rgb.txt", "1.0 a\n2.0 b\n");
    folder.write("camera.json", R"({"depth_camera": {"width": 16, "height": 12, "fx": 20, "fy": 20, "cx": 8,
        "cy": 6}, "depth_units_per_metre": 1000, "registered": true,
        "color_from_depth": {"rotation_vector_rad": [0, 0, 0], "translation_m": [0, 0, 0]}})");
    EXPECT_THAT(Dataset(folder.path()).notes(),
                ElementsAre(HasSubstr("camera.json: known, but not used: color_from_depth")));
}

TEST(Dataset, AMissingFileIsABrokenFrame) {
    const Folder folder;
    folder.write("depth.txt", "1.0 depth/none.png\n2.0 depth\n");
    Dataset dataset(folder.path());
    SensorFrame frame;
    const ReadResult missing = dataset.next(frame);
    EXPECT_EQ(missing.status, Status::kBroken);
    EXPECT_THAT(missing.message, HasSubstr("depth/none.png"));
    EXPECT_EQ(dataset.next(frame).status, Status::kBroken);
    EXPECT_EQ(dataset.next(frame).status, Status::kEnd);
}

TEST(Dataset, BrokenColorLeavesTheDepth) {
    const std::string jpeg = encode_jpeg(16, 12);
    const std::pair<std::string, const char*> cases[] = {{jpeg.substr(0, jpeg.size() - 10), "cut short"},
                                                         {encode_jpeg(32, 12), "32x12"},
                                                         {"GIF89a", "neither a PNG nor a JPEG"}};
    for (const auto& [bytes, reason] : cases) {
        const Folder folder;
        folder.write("rgb.txt", "1.0 rgb/1.jpg\n");
        folder.write("rgb/1.jpg", bytes);
        Dataset dataset(folder.path());
        SensorFrame frame;
        const ReadResult result = dataset.next(frame);
        EXPECT_EQ(result.status, Status::kFrame);
        EXPECT_THAT(result.message, AllOf(HasSubstr("rgb/1.jpg"), HasSubstr(reason)));
        EXPECT_FALSE(frame.depth.empty());
        EXPECT_TRUE(frame.color_jpeg.empty());
        EXPECT_EQ(frame.color_utime, 0);
    }
}

TEST(Dataset, PngColorIsDecoded) {
    const Folder folder;
    folder.write("rgb.txt", "1.0 rgb/1.png\n");
    folder.write("rgb/1.png",
                 encode_png(16, 12, SPNG_COLOR_TYPE_TRUECOLOR, 8, std::vector<std::uint8_t>(576, 9)));
    Dataset dataset(folder.path());
    SensorFrame frame;
    EXPECT_EQ(dataset.next(frame).message, "");
    EXPECT_EQ(frame.color.width, 16);
    EXPECT_EQ(frame.color(3, 3), (Rgb{9, 9, 9}));
    EXPECT_TRUE(frame.color_jpeg.empty());
}

TEST(Dataset, NothingToReadIsOneClearError) {
    const test::TemporaryFolder empty;
    EXPECT_THAT(test::error_of([&] { open_source((empty.path() / "none").string()); }),
                HasSubstr("no such folder"));
    EXPECT_THAT(test::error_of([&] { open_source(empty.path().string()); }), HasSubstr("depth.txt"));
    const auto file = empty.write("file", "x");
    EXPECT_THAT(test::error_of([&] { open_source(file.string()); }), HasSubstr("is no LCM log"));
    const Folder folder;
    folder.write("depth.txt", "# nothing\n");
    EXPECT_THAT(test::error_of([&] { open_source(folder.path().string()); }), HasSubstr("no depth images"));
}

TEST(Dataset, WhatToDoIsSaid) {
    const test::TemporaryFolder folder;
    const auto log = folder.write("x.lcmlog", std::string("\xed\xa1\xda\x01", 4) + "and so on");
    EXPECT_THAT(test::error_of([&] { open_source(log.string()); }), HasSubstr("x.lcmlog: is no LCM log"));
    const auto list = folder.write("in/depth.txt", "1 depth/1.png\n");
    EXPECT_THAT(test::error_of([&] { open_source(list.string()); }),
                AllOf(HasSubstr("give its folder"), HasSubstr("/in")));
    EXPECT_THAT(test::error_of([&] { open_source(folder.write("a.bag", "#ROSBAG V2.0").string()); }),
                HasSubstr("a.bag --output NAME.lcmlog` makes one of a ROS 1 bag"));
    EXPECT_THAT(test::error_of([&] { open_source(folder.path().string()); }), HasSubstr("/in is one"));
    const auto loop = folder.path() / "loop";
    std::filesystem::create_symlink(loop, loop);
    EXPECT_THAT(test::error_of([&] { open_source(loop.string()); }), HasSubstr("symbolic links"));
    std::filesystem::create_symlink(loop, folder.path() / "associations.txt");
    EXPECT_THAT(test::error_of([&] { open_source(folder.path().string()); }),
                AllOf(HasSubstr("associations.txt"), HasSubstr("symbolic links")));
}

TEST(Dataset, BadListsNameTheLine) {
    for (const char* text :
         {"1.0 depth/1.png\nx depth/2.png\n", "1.0 a\n2.0\n", "1 a\ninf b\n", "1 a\n1e30 b\n"}) {
        const Folder folder;
        folder.write("depth.txt", text);
        EXPECT_THAT(test::error_of([&] { Dataset{folder.path()}; }), HasSubstr("depth.txt:2")) << text;
    }
    for (const char* text : {"1 rgb/1.jpg 1 rgb/2.jpg\n", "1 depth/a 1 depth/b\n", "1 rgb/a depth/b\n"}) {
        const Folder folder;
        folder.write("associations.txt", text);
        EXPECT_THAT(test::error_of([&] { Dataset{folder.path()}; }), HasSubstr("associations.txt:1")) << text;
    }
}

std::filesystem::path shared_data() {
    const char* set = std::getenv("PLANEMAP_DATA");
    return set != nullptr ? std::filesystem::path(set)
                          : std::filesystem::path(PLANEMAP_SOURCE) / "../shared/data";
}

TEST(Dataset, ReadsTheSharedSequences) {
    if (!std::filesystem::exists(shared_data()))
        GTEST_SKIP() << "no " << shared_data() << "; set PLANEMAP_DATA";
    struct {
        const char* name;
        std::size_t frames;
        bool registered;
    } const sequences[] = {
        {"redkitchen", 1000, false}, {"fr3_cabinet", 58, true}, {"livingroom_micro", 211, true}};
    for (const auto& sequence : sequences) {
        Dataset dataset(shared_data() / sequence.name);
        EXPECT_EQ(dataset.size(), sequence.frames);
        EXPECT_EQ(dataset.camera().registered, sequence.registered);
        SensorFrame frame;
        for (int i = 0; i < 5; ++i) {
            const ReadResult result = dataset.next(frame);
            EXPECT_EQ(result.status, Status::kFrame);
            EXPECT_EQ(result.message, "");
            EXPECT_FALSE(frame.color_jpeg.empty());
        }
    }
    const Dataset rpy(shared_data() / "fr1_rpy_start");
    const auto with_color = std::count_if(rpy.frames().begin(), rpy.frames().end(),
                                          [](const ListedFrame& frame) { return frame.color.has_value(); });
    EXPECT_GT(with_color, 300);
}

}  // namespace
}  // namespace planemap::sensor
