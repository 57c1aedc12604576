// SPDX-License-Identifier: BSD-3-Clause
#include "exports/planes_json_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "core/files.hpp"
#include "core/random_values.hpp"
#include "exports/corner.hpp"
#include "exports/exports.hpp"

namespace planemap::exports {
namespace {

using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class PlanesJsonReader : public testing::Test {
  protected:
    ~PlanesJsonReader() override { std::filesystem::remove(file_); }

    PlaneMap read(const std::string& text) {
        write_file(file_, text);
        return read_planes_json(file_);
    }
    /// What reading the corner says after a change to it; empty if it is read.
    std::string refusal(const std::function<void(Json&)>& change) {
        Json json = Json::parse(planes_json(scene::corner()));
        change(json);
        try {
            read(json.dump());
        } catch (const std::exception& error) {
            return error.what();
        }
        return {};
    }

    std::filesystem::path file_ =
        std::filesystem::temp_directory_path() / ("planes_" + std::to_string(::getpid()) + ".json");
};

/// But for what rounding does, and the keyframes that planes.json alone has.
void expect_same(const PlaneMap& a, const PlaneMap& b) {
    EXPECT_EQ(a.utime, b.utime);
    EXPECT_EQ(a.revision, b.revision);
    EXPECT_LT((a.up - b.up).norm(), 1e-6f);
    ASSERT_EQ(a.planes.size(), b.planes.size());
    for (std::size_t i = 0; i < a.planes.size(); ++i) {
        const MapPlane &p = a.planes[i], &q = b.planes[i];
        EXPECT_EQ(p.id, q.id);
        EXPECT_EQ(p.label, q.label);
        EXPECT_EQ(p.keyframes, q.keyframes);
        EXPECT_LT((p.normal - q.normal).norm(), 1e-6f);
        EXPECT_LT((p.center - q.center).norm(), 1e-5f);
        EXPECT_LT((p.half_extents - q.half_extents).norm(), 1e-4f);
        EXPECT_NEAR(p.rms, q.rms, 1e-6);
        EXPECT_NEAR(p.area, q.area, 1e-5);
        EXPECT_EQ(p.inliers, q.inliers);
        const Outline one = p.outline.rings(), other = q.outline.rings();
        ASSERT_EQ(one.rings.size(), other.rings.size());
        for (std::size_t r = 0; r < one.rings.size(); ++r)
            for (std::size_t v = 0; v < one.rings[r].size(); ++v)
                EXPECT_LT(
                    (p.world_from_plane() * Eigen::Vector3d(one.rings[r][v].x(), one.rings[r][v].y(), 0) -
                     q.world_from_plane() * Eigen::Vector3d(other.rings[r][v].x(), other.rings[r][v].y(), 0))
                        .norm(),
                    2e-3);
    }
    ASSERT_EQ(a.inferred.size(), b.inferred.size());
    EXPECT_EQ(a.lines.size(), b.lines.size());
    EXPECT_EQ(a.points.size(), b.points.size());
}

TEST_F(PlanesJsonReader, ReadsWhatIsWritten) {
    PlaneMap map = scene::corner();
    map.inferred.push_back({3, MapOutline(Outline{{{{0, 0}, {0.5, 0}, {0.5, 0.25}}}})});
    expect_same(map, read(planes_json(map)));
    map.up.setZero();
    expect_same(map, read(planes_json(map)));
    expect_same({}, read(planes_json({})));
    test::Random random(2);
    PlaneMap tilted;
    for (int i = 0; i < 20; ++i) tilted.planes.push_back(scene::plane_of(i, {random.pose(30), 1.5, 0.5, {}}));
    expect_same(tilted, read(planes_json(tilted)));
}

TEST_F(PlanesJsonReader, WhatIsNotKnownStaysUnknown) {
    PlaneMap map = scene::corner();
    map.planes[0].rms = map.planes[0].area = map.planes[0].inliers = std::numeric_limits<float>::quiet_NaN();
    const PlaneMap again = read(planes_json(map));
    EXPECT_TRUE(std::isnan(again.planes[0].rms) && std::isnan(again.planes[0].area));
    Json earlier = Json::parse(planes_json(map));
    for (Json& plane : earlier["planes"])
        for (const char* key : {"keyframe_count", "keyframes", "inferred_area"}) plane.erase(key);
    EXPECT_EQ(read(earlier.dump()).planes[0].keyframes, 0);
}

TEST_F(PlanesJsonReader, NamesTheBadField) {
    const auto plane = [](const char* key, const Json& value) {
        return [=](Json& json) { json["planes"][1][key] = value; };
    };
    const auto expect = [&](const std::string& field, const std::function<void(Json&)>& change) {
        const std::string line = refusal(change);
        EXPECT_THAT(line, AllOf(HasSubstr(file_.string() + ": "), HasSubstr(field)));
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        EXPECT_LT(line.size(), 400u);
    };
    EXPECT_EQ(refusal([](Json&) {}), "");
    expect("format", [](Json& json) { json["format"] = "planemap planes 9"; });
    expect("format", [](Json& json) { json.erase("format"); });
    expect("utime is \"x\"", [](Json& json) { json["utime"] = "x"; });
    expect("utime", [](Json& json) { json["utime"] = 18446744073709551615u; });
    expect("up is", [](Json& json) { json["up"] = {0, 0, 2}; });
    expect("planes is missing", [](Json& json) { json.erase("planes"); });
    expect("planes is 3", [](Json& json) { json["planes"] = 3; });
    expect("planes[1] is", [](Json& json) { json["planes"][1] = 7; });
    expect("planes[1].id is -1", plane("id", -1));
    expect("planes[1].id is 1; allowed: ascending", plane("id", 1));
    expect("planes[1].id is 3.5", plane("id", 3.5));
    expect("planes[1].label is \"roof\"; allowed: one of unknown, floor", plane("label", "roof"));
    expect("planes[1].normal is [0,0]", plane("normal", {0, 0}));
    expect("planes[1].normal", plane("normal", {0, 0, 0}));
    expect("planes[1].normal[2] is null", plane("normal", {1, 0, nullptr}));
    expect("planes[1].d is 5", plane("d", 5));
    expect("planes[1].d is null", plane("d", nullptr));
    expect("planes[1].center[0] is 1e+30", plane("center", {1e30, 0, 0}));
    expect("planes[1].rms is -1", plane("rms", -1));
    expect("planes[1].inliers is \"many\"", plane("inliers", "many"));
    expect("planes[1].box_corners", plane("box_corners", Json::array()));
    expect("planes[1].keyframe_count is 99999", plane("keyframe_count", 99999));
    expect("planes[1].outline is {}", plane("outline", Json::object()));
    expect("planes[1].outline[0] is [[1,0,1]]", plane("outline", {{{1, 0, 1}}}));
    expect("planes[1].outline[0][2]", [](Json& json) { json["planes"][1]["outline"][0][2] = {9, 9, 9}; });
    expect("lines[0].planes[1] is 77", [](Json& json) { json["lines"][0]["planes"] = {1, 77}; });
    expect("lines[0].planes is [3,1]", [](Json& json) { json["lines"][0]["planes"] = {3, 1}; });
    expect("points[0].position", [](Json& json) { json["points"][0]["position"] = "here"; });
}

TEST_F(PlanesJsonReader, RefusesWhatIsNoPlanesJson) {
    const auto refused = [&](const std::string& text) {
        try {
            read(text);
        } catch (const std::exception& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(refused(""), HasSubstr("line 1"));
    EXPECT_THAT(refused("[1, 2]"), HasSubstr("not a JSON object"));
    EXPECT_THAT(refused("{}"), HasSubstr("no planes.json"));
    const std::string whole = planes_json(scene::corner());
    EXPECT_THAT(refused(whole.substr(0, whole.size() / 2)), HasSubstr("line"));
    EXPECT_THAT(refused(std::string(40, '[')), HasSubstr("nested deeper"));
    EXPECT_THAT(refused(std::string((32u << 20) + 1, ' ')), HasSubstr(file_.string()));
    EXPECT_THROW(read_planes_json(file_.string() + ".none"), std::runtime_error);
}

}  // namespace
}  // namespace planemap::exports
