// SPDX-License-Identifier: BSD-3-Clause
#include "report/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/files.hpp"
#include "exports/corner.hpp"
#include "map/map_file.hpp"
#include "temporary_folder.hpp"

namespace planemap {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

class Comparison : public testing::Test {
  protected:
    Subject subject(const std::string& name, const Json& report, const PlaneMap* map) {
        std::filesystem::create_directories(folder_ / name);
        if (map != nullptr) map::write_plane_map(folder_ / name / "plane_map.lcmlog", *map);
        return {folder_ / name, report, true};
    }
    /// Long enough that its poses tie two world frames.
    void give_walk(const std::string& name) {
        Trajectory trajectory;
        for (int i = 0; i < 20; ++i) trajectory.push_back({i * 100'000, Pose::Identity()});
        write_trajectory(folder_ / name / "trajectory.txt", trajectory);
    }
    TemporaryFolder folder_;
};

TEST_F(Comparison, SaysBothNumbersOfWhatChanged) {
    const Json a = {{"planes", 3},
                    {"keyframes", 9},
                    {"explained_points", 0.8},
                    {"options", {{"seed", nullptr}, {"output", "a"}, {"x", 1}}}};
    const Json b = {{"planes", 4},
                    {"keyframes", 9},
                    {"wall_s", 2.5},
                    {"options", {{"seed", 7}, {"output", "b"}, {"x", 1}}}};
    const Json c = compare(subject("a", a, nullptr), subject("b", b, nullptr));
    EXPECT_EQ(c.at("figures_alike"), 1);
    EXPECT_EQ(c.at("options"), Json::parse(R"([{"flag": "seed", "a": null, "b": 7}])"));
    EXPECT_FALSE(c.at("world_frames").at("are_one").get<bool>());
    EXPECT_TRUE(c.at("planes").is_null());
    const std::string text = comparison_markdown(c);
    for (const char* line :
         {"| planes | 3 | 4 | +33.3 % |", "| readings on planes | 80.0 % | - |  |",
          "| time by the clock | - | 2.5 s |  |", "| --seed | - | 7 |", "1 more are the same",
          "holds no plane_map.lcmlog. Planes cannot be compared, only figures."})
        EXPECT_THAT(text, HasSubstr(line));
    EXPECT_THAT(text, Not(HasSubstr("--output")));
}

TEST_F(Comparison, NamesPlanesThatCameWentAndMoved) {
    const PlaneMap a = scene::corner();
    PlaneMap b = scene::corner();
    b.planes[1].center.x() += 0.1F;  // the wall, id 3
    b.planes[2] = scene::plane_of(40, {scene::facing({0, 1, 1}, {0, -1, 0}, {1, 0, 0}), 1, 1, {}});
    b.lines.clear();
    b.points.clear();
    const Subject of_a = subject("a", {{"planes", 3}}, &a), of_b = subject("b", {{"planes", 3}}, &b);
    give_walk("a");
    give_walk("b");
    const Json c = compare(of_a, of_b);
    ASSERT_TRUE(c.at("world_frames").at("are_one").get<bool>()) << c.dump();
    EXPECT_EQ(c.at("planes").at("in_place").size(), 1U);
    EXPECT_EQ(c.at("planes").at("appeared").at(0).at("id"), 40);
    EXPECT_EQ(c.at("planes").at("gone").at(0).at("id"), 12);
    EXPECT_NEAR(c.at("planes").at("moved").at(0).at("offset_m").get<double>(), -0.1, 0.006);
    const std::string text = comparison_markdown(c);
    for (const char* line :
         {"None differs.", "1 planes are in place (3 cm, 2 deg), 1 moved, 1 appeared, 1 are gone",
          "| gone | 12 |  | ceiling |", "| appeared |  | 40 |", "| moved | 3 | 3 | wall |"})
        EXPECT_THAT(text, HasSubstr(line));
}

TEST_F(Comparison, InTwoWorldFramesThereAreFiguresOnly) {
    const PlaneMap a = scene::corner();
    PlaneMap b = scene::corner();
    for (MapPlane& plane : b.planes) plane.center += Eigen::Vector3f(9, 9, 9);
    b.lines.clear();
    b.points.clear();
    const Json c = compare(subject("a", {{"planes", 3}}, &a), subject("b", {{"planes", 5}}, &b));
    EXPECT_TRUE(c.at("planes").is_null());
    EXPECT_THAT(comparison_markdown(c), HasSubstr("The world frames differ, or are not known to be one: "));
    EXPECT_THAT(comparison_markdown(c), HasSubstr("| planes | 3 | 5 |"));
}

}  // namespace
}  // namespace planemap
