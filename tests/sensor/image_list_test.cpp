// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/image_list.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace planemap::sensor {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

List<ListedImage> read(const std::string& text) {
    const test::TemporaryFolder folder;
    return read_image_list(folder.write("depth.txt", text));
}

std::string times_and_files(const List<ListedImage>& list) {
    std::string text;
    for (const ListedImage& image : list.entries) {
        text += std::to_string(image.utime) + "=" + image.file.string() + ";";
    }
    return text;
}

TEST(ImageList, EveryWayToWriteALineIsRead) {
    const std::string right = "1500000=depth/a.png;2500000=depth/b.png;";
    for (const char* text : {
             "1.5 depth/a.png\n2.5 depth/b.png\n",
             "1.5 depth/a.png\n2.5 depth/b.png",
             "1.5 depth/a.png\r\n2.5 depth/b.png\r\n",
             "1.5 depth/a.png\r2.5 depth/b.png\r",
             "\xef\xbb\xbf"
             "1.5 depth/a.png\n2.5 depth/b.png\n",
             "\xef\xbb\xbf# timestamp filename\r\n1.5 depth/a.png\r\n2.5 depth/b.png\r\n",
             "1.5\tdepth/a.png\n2.5\t \tdepth/b.png\n",
             "  1.5 depth/a.png  \t \n\n \t\n \t# comment\n2.5   depth/b.png \r\n",
             "#timestamp,filename\n1.5,depth/a.png\n2.5 , depth/b.png\n",
             "1.5e0 depth/a.png\n25e-1 depth/b.png\n",
         }) {
        const auto list = read(text);
        EXPECT_EQ(times_and_files(list), right) << text;
        EXPECT_THAT(list.notes, IsEmpty()) << text;
    }
}

TEST(ImageList, NamesMayHoldBlanks) {
    const test::TemporaryFolder folder;
    folder.write("my scan/1 a.png", "x");
    folder.write("b.png", "x");
    // Behind a name that is a file as it is, more columns may stand, as some tools write them.
    const auto list =
        read_image_list(folder.write("depth.txt", "1 my scan/1 a.png \n2 none  such.png\n3 b.png 640 480\n"));
    EXPECT_EQ(times_and_files(list), "1000000=my scan/1 a.png;2000000=none  such.png;3000000=b.png;");
}

TEST(ImageList, AnyUnitIsReadExactly) {
    const std::string right = "1311868164363181=a;1311868164396514=b;";
    EXPECT_EQ(times_and_files(read("1311868164.363181 a\n1311868164.396514 b\n")), right);
    const std::pair<const char*, const char*> cases[] = {
        {"1311868164363.181 a\n1311868164396.514 b\n", "milliseconds"},
        {"1311868164363181 a\n1311868164396514 b\n", "microseconds"},
        {"1311868164363181000 a\n1311868164396514000 b\n", "nanoseconds"}};
    for (const auto& [text, unit] : cases) {
        const auto list = read(text);
        EXPECT_EQ(times_and_files(list), right) << text;
        EXPECT_THAT(list.notes, ElementsAre(AllOf(HasSubstr("depth.txt"), HasSubstr(unit)))) << text;
    }
}

TEST(ImageList, MixedUnitsAndWhatIsNotFiniteAreErrors) {
    EXPECT_THAT(test::error_of([] { read("1311868164.3 a\n1311868164396514000 b\n"); }),
                AllOf(HasSubstr("depth.txt:2:"), HasSubstr("is in nanoseconds"), HasSubstr("is in seconds")));
    for (const char* bad :
         {"nan a", "inf a", "-inf a", "1e400 a", "1e30 a", "a 1", "1", "1 ", "1,", "\x01"}) {
        EXPECT_THAT(test::error_of([&] { read(std::string("1 a\n# c\n") + bad + "\n"); }),
                    HasSubstr("depth.txt:3:"))
            << bad;
    }
    const std::string hostile = test::error_of([] { read(std::string(100000, 'x') + "\x1b[2J"); });
    EXPECT_LT(hostile.size(), 500u);
    EXPECT_THAT(test::error_of([] { read(std::string("\xff\xfe\x31\0", 4)); }), HasSubstr("UTF-16"));
}

TEST(ImageList, AStepThatIsNoCamerasIsRefused) {
    const auto at_steps = [](double step_s) {
        std::string text;
        for (int i = 0; i < 5; ++i) text += std::to_string(i * step_s) + " a" + std::to_string(i) + "\n";
        return test::error_of([&] { read(text); });
    };
    EXPECT_EQ(at_steps(0.001), "");
    EXPECT_EQ(at_steps(60), "");
    EXPECT_THAT(at_steps(0.0009),
                AllOf(HasSubstr("depth.txt"), HasSubstr("is 0.0009 s if they are in seconds"),
                      HasSubstr("1 ms to 60 s")));
    EXPECT_THAT(at_steps(33333.333), HasSubstr("33333.3 s"));
    EXPECT_THAT(test::error_of([] { read("1 a\n1 b\n1 c\n2 d\n"); }), HasSubstr("is 0 s")) << "whole seconds";
    EXPECT_EQ(test::error_of([] { read("1 a\n1.03 b\n500 c\n500.03 d\n"); }), "") << "a pause";
    EXPECT_EQ(test::error_of([] { read("5 a\n"); }), "") << "one image has no step";
}

TEST(ImageList, OrderAndRepeatsAreSetRightAndSaid) {
    const auto late = read("1 a\n3 c\n2 b\n4 d\n");
    EXPECT_EQ(times_and_files(late), "1000000=a;2000000=b;3000000=c;4000000=d;");
    EXPECT_THAT(late.notes, ElementsAre(HasSubstr("1 lines are out of order")));
    const auto twice = read("1 a\n1 a\n2 b\n2 b\n3 c\n3 c\n");
    EXPECT_EQ(times_and_files(twice), "1000000=a;2000000=b;3000000=c;");
    EXPECT_THAT(twice.notes, ElementsAre(HasSubstr("3 lines repeat another")));
    const auto clash = read("1 a\n2 b\n2 x\n3 c\n");
    EXPECT_EQ(times_and_files(clash), "1000000=a;2000000=b;3000000=c;");
    EXPECT_THAT(clash.notes, ElementsAre(HasSubstr("1 lines have the timestamp of another")));
}

TEST(Associations, AreReadAsTheListsAre) {
    const test::TemporaryFolder folder;
    folder.write("run 2 b/depth 1.png", "x");
    folder.write("run 2 b/rgb 1.png", "x");
    const auto list = read_associations(folder.write(
        "associations.txt",
        "\xef\xbb\xbf# pairs\r\n2000000000000 run 2 b/rgb 1.png\t2000000000.001 run 2 b/depth 1.png \r\n"
        "1999999999000 rgb/0.png 1999999999.001 depth/0.png\r\n"));
    ASSERT_EQ(list.entries.size(), 2u);
    EXPECT_EQ(list.entries[0].depth.file, "depth/0.png");
    EXPECT_EQ(list.entries[1].depth.file, "run 2 b/depth 1.png");
    EXPECT_EQ(list.entries[1].depth.utime, 2000000000001000);
    EXPECT_EQ(list.entries[1].color->file, "run 2 b/rgb 1.png");
    EXPECT_EQ(list.entries[1].color->utime, 2000000000000000) << "each column may have its unit";
    EXPECT_THAT(list.notes, ElementsAre(HasSubstr("out of order")));
    EXPECT_THAT(test::error_of([&] {
                    read_associations(folder.write("associations.txt", "1 a 1 depth/a\n2e6 a 2e6 depth/b\n"));
                }),
                HasSubstr("the median step"));
}

TEST(Associate, TakesTheNearestFirstAndEachOnce) {
    const std::vector<ListedImage> depth{{0, "a"}, {30, "b"}, {100, "c"}};
    const std::vector<ListedImage> color{{12, "x"}, {28, "y"}, {121, "z"}};
    const auto frames = associate(depth, color, 20);
    ASSERT_EQ(frames.size(), 3u);
    EXPECT_EQ(frames[0].color->file, "x");
    EXPECT_EQ(frames[1].color->file, "y");
    EXPECT_FALSE(frames[2].color);
    // One colour image between two depth images goes to the nearer one.
    const auto shared = associate({{0, "a"}, {10, "b"}}, {{6, "x"}}, 20);
    EXPECT_FALSE(shared[0].color);
    EXPECT_EQ(shared[1].color->file, "x");
    EXPECT_TRUE(associate({}, color, 20).empty());
}

TEST(Associate, WhatIsLeftOverIsCounted) {
    const std::vector<ListedImage> depth{{0, "a"}, {30000, "b"}, {1000000, "c"}};
    const std::vector<ListedImage> color{{1000, "x"}, {31000, "y"}, {32000, "z"}};
    const std::string text = left_over(associate(depth, color, 20000), color, 20000);
    EXPECT_THAT(text, AllOf(HasSubstr("1 of 3 depth images"), HasSubstr("within 0.02 s"),
                            HasSubstr("the nearest is 0.968 s away"), HasSubstr("1 of 3 colour images")));
    EXPECT_EQ(left_over(associate({{0, "a"}}, {{1, "x"}}, 20000), {{1, "x"}}, 20000), "");
    EXPECT_THAT(left_over(associate(depth, {}, 20000), {}, 20000), HasSubstr("3 of 3 depth images"));
    EXPECT_THAT(left_over({}, color, 20000), HasSubstr("3 of 3 colour images"));
}

}  // namespace
}  // namespace planemap::sensor
