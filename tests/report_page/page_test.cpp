// SPDX-License-Identifier: BSD-3-Clause
#include "report_page/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Json = nlohmann::ordered_json;

constexpr std::string_view kOpens = "<script type=\"application/json\" id=\"planemap-data\">";

/// The text between the tags of the page's data.
std::string data_text(const std::string& page) {
    const std::size_t from = page.find(kOpens) + kOpens.size();
    return page.substr(from, page.find("</script>", from) - from);
}

Json data_of(const PageSource& source) {
    return Json::parse(data_text(report_page(source)));
}

Json one_plane() {
    return Json::parse(R"({"format": "planemap planes 1", "up": [0, -1, 0], "lines": [], "points": [],
        "planes": [{"id": 7, "label": "wall", "normal": [0, 0, -1], "d": 2, "area": 1, "center": [0, 0, 2],
                    "outline": [[[0, 0, 2], [1, 0, 2], [1, 1, 2]]], "keyframes": [1, 2, 3], "box_corners": []}]})");
}

CloudPoint point(float x, int plane) {
    return {{x, 1, -2}, {10, 20, 30}, plane};
}

/// As JavaScript reads it.
std::string decoded(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned buffer = 0;
    int bits = 0;
    for (const char c : text) {
        if (c == '=') break;
        buffer = buffer << 6 | static_cast<unsigned>(digits.find(c));
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(buffer >> bits & 0xffU);
    }
    return bytes;
}

TEST(Page, OfNothingIsAPageThatSaysSo) {
    const Json data = data_of({});
    for (const char* key : {"report", "planes", "trajectory", "points"})
        EXPECT_TRUE(data.at(key).is_null()) << key;
    EXPECT_FALSE(data.at("up_known").get<bool>());
    EXPECT_THAT(data.at("up"), ElementsAre(0, -1, 0));
}

TEST(Page, TextCannotBreakOut) {
    PageSource source;
    const std::string evil = "</script><script>alert(1)</script><!--]]>\u2028\"\\";
    source.report = {{"input", evil}, {evil, std::string("\xff\xfe not UTF-8")}};
    source.planes = one_plane();
    source.planes["planes"][0]["label"] = evil;
    source.notes = {evil};
    const std::string page = report_page(source);
    const Json data = Json::parse(data_text(page));
    EXPECT_EQ(data.at("report").at("input").get<std::string>(), evil);
    EXPECT_EQ(data.at("planes").at("planes").at(0).at("label").get<std::string>(), evil);
    EXPECT_THAT(data.at("notes"), ElementsAre(evil));
    EXPECT_EQ(data_text(page).find('<'), std::string::npos);
    EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
}

TEST(Page, HoldsWhatItShowsAndNotWhatItDoesNot) {
    PageSource source;
    source.planes = one_plane();
    const Json data = data_of(source), plane = data.at("planes").at("planes").at(0);
    EXPECT_TRUE(data.at("up_known").get<bool>());
    EXPECT_EQ(plane.at("id"), 7);
    EXPECT_FALSE(plane.contains("keyframes"));
    source.planes = Json::parse("[1]");
    EXPECT_TRUE(data_of(source).at("planes").is_null());
}

TEST(Page, PointsAreWithinAStepOfWhatTheyWere) {
    PageSource source;
    source.planes = one_plane();
    source.points = {point(-3, 7), point(0.123F, -1), point(5, 99)};
    const Json points = data_of(source).at("points");
    EXPECT_EQ(points.at("total"), 3);
    const std::string positions = decoded(points.at("positions").get<std::string>());
    ASSERT_EQ(positions.size(), 3U * 3 * 2);
    const auto coordinate = [&](std::size_t i, std::size_t k) {
        const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(positions[at]); };
        const std::size_t at = 2 * (3 * i + k);
        return points.at("origin")[k].get<double>() +
               points.at("step")[k].get<double>() * (byte(at) + 256 * byte(at + 1));
    };
    EXPECT_NEAR(coordinate(0, 0), -3, 1e-4);
    EXPECT_NEAR(coordinate(1, 0), 0.123, 8.0 / 65535);
    EXPECT_NEAR(coordinate(2, 0), 5, 1e-4);
    EXPECT_NEAR(coordinate(2, 2), -2, 1e-6) << "no extent along z";
    EXPECT_EQ(decoded(points.at("planes").get<std::string>()), std::string("\0\0\xff\xff\xfe\xff", 6))
        << "the plane's place, none, and one that is not in planes.json";
    EXPECT_EQ(decoded(points.at("colors").get<std::string>()), "\x0a\x14\x1e\x0a\x14\x1e\x0a\x14\x1e");
}

TEST(Page, ManyPointsAndPosesAreThinned) {
    PageSource source;
    source.points.emplace();
    for (int i = 0; i < 200'000; ++i) source.points->push_back(point(static_cast<float>(i), -1));
    for (int i = 0; i < 20'000; ++i) source.trajectory.push_back({i, Pose::Identity()});
    const std::string page = report_page(source);
    EXPECT_LT(page.size(), 2'000'000U);
    EXPECT_EQ(page, report_page(source)) << "the same bytes";
    const Json data = Json::parse(data_text(page));
    EXPECT_EQ(data.at("points").at("total"), 200'000);
    EXPECT_EQ(data.at("points").at("shown"), 80'000);
    EXPECT_EQ(decoded(data.at("trajectory").at("positions").get<std::string>()).size(), 5'000U * 12);
}

TEST(Page, WithoutAnUpHowTheCameraWasHeldStandsForIt) {
    PageSource source;
    source.planes = one_plane();
    source.planes["up"] = nullptr;
    Pose pose = Pose::Identity();
    pose.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // image rows point along -z
    source.trajectory = {{0, pose}};
    const Json data = data_of(source);
    EXPECT_FALSE(data.at("up_known").get<bool>());
    EXPECT_NEAR(data.at("up")[2].get<double>(), 1, 1e-9);
}

TEST(Page, WhatAFolderLacksIsUnknownAndWhatIsBrokenIsNoted) {
    const TemporaryFolder folder;
    EXPECT_THAT(page_source_of(folder.path(), {}).notes, IsEmpty());
    write_file(folder / "planes.json", "{\"planes\": 3}");
    write_file(folder / "trajectory.txt", "1 2 three\n");
    write_file(folder / "points.ply", "ply\n");
    const PageSource source = page_source_of(folder.path(), {});
    EXPECT_THAT(source.notes, ElementsAre(HasSubstr("planes.json: is no planes.json"),
                                          HasSubstr("trajectory.txt"), HasSubstr("points.ply")));
    EXPECT_TRUE(source.planes.is_null());
    EXPECT_FALSE(source.points.has_value());
    EXPECT_THAT(data_of(source).at("notes").size(), 3);
}

}  // namespace
}  // namespace planemap
