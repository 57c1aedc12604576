// SPDX-License-Identifier: BSD-3-Clause
// What moves, comes and goes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/files.hpp"
#include "simulator/planes_truth.hpp"
#include "temporary_folder.hpp"

namespace planemap::simulator {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::json;

Pose at(double x) {
    Pose pose = Pose::Identity();
    pose.translation().x() = x;
    return pose;
}

SimulatedSource source(const std::string& name) {
    return SimulatedSource(
        parse_simulator_name("sim:" + name + "?change=2&frames=60&rate=10&noise=0&width=160&height=120"));
}

/// Pixels of a view that show something of a body.
std::ptrdiff_t pixels_of_bodies(const World& world, const View& view) {
    return std::count_if(view.rectangle.pixels.begin(), view.rectangle.pixels.end(), [&](std::int16_t i) {
        return i >= 0 && world.rectangles[static_cast<std::size_t>(i)].body >= 0;
    });
}

TEST(Body, IsBetweenItsKeysAndStaysAtTheEnds) {
    const Body body{"", 0, 5, {{1, at(0)}, {3, at(1)}, {3, at(4)}, {4, at(4)}}};
    for (const auto& [seconds, x] :
         std::vector<std::pair<double, double>>{{-9, 0}, {1, 0}, {2, 0.5}, {3, 4}, {9, 4}})
        EXPECT_NEAR(body.pose_at(seconds).translation().x(), x, 1e-12) << seconds;
    EXPECT_TRUE(body.is_there(0));
    EXPECT_FALSE(body.is_there(5));
    EXPECT_FALSE(body.is_there(-0.01));
}

TEST(Body, StaysWhereItStandsLongEnough) {
    const Body body{"", 0, 5, {{1, at(0)}, {3, at(1)}, {3, at(4)}, {4, at(4)}}};
    const auto stays = body.stays(1);
    ASSERT_EQ(stays.size(), 2u);
    EXPECT_EQ(stays[0].from_s, 0);
    EXPECT_EQ(stays[0].until_s, 1);
    EXPECT_EQ(stays[1].from_s, 3);
    EXPECT_EQ(stays[1].until_s, 5);
    EXPECT_EQ(stays[1].world_from_rest.translation().x(), 4);
    EXPECT_EQ(body.stays(1.5).size(), 1u);
    ASSERT_EQ(Body{}.stays(1).size(), 1u);
    EXPECT_TRUE(std::isinf(Body{}.stays(1)[0].until_s));
}

TEST(Changing, ABoxAppearsAndAnotherVanishes) {
    const SimulatedSource appearing = source("appearing"), vanishing = source("vanishing");
    for (const std::size_t i : {0u, 10u, 19u, 20u, 40u}) {
        const View with_or_without = appearing.depth_view(i), other = vanishing.depth_view(i);
        const auto box = pixels_of_bodies(appearing.world(), with_or_without);
        const auto other_box = pixels_of_bodies(vanishing.world(), other);
        EXPECT_EQ(box > 0, i >= 20) << i;
        EXPECT_EQ(other_box > 0, i < 20) << i;
        EXPECT_GT(box + other_box, 300) << "it is in the middle of the view";
    }
    // Without the box the two worlds are one.
    const SimulatedSource gone(
        parse_simulator_name("sim:vanishing?change=0&frames=60&rate=10&noise=0&width=160&height=120"));
    EXPECT_EQ(appearing.frame(5).depth.pixels, gone.frame(5).depth.pixels);
}

TEST(Changing, WhatIsReadIsWhereTheWorldIsThen) {
    for (const char* name : {"moved", "door", "walker"}) {
        const SimulatedSource changing = source(name);
        for (const std::size_t i : {5u, 25u, 33u, 55u}) {
            const World now = changing.world_at(changing.utime(i));
            const View view = changing.depth_view(i);
            const SensorFrame frame = changing.frame(i);
            for (int v = 0; v < view.camera.height; v += 3) {
                for (int u = 0; u < view.camera.width; u += 3) {
                    const auto raw = frame.depth(u, v);
                    const std::int16_t index = view.rectangle(u, v);
                    if (index < 0 || !is_valid_depth(raw)) continue;
                    const Rectangle& r = now.rectangles[static_cast<std::size_t>(index)];
                    const Vector3d p =
                        view.world_from_camera * view.camera.unproject(u, v, changing.camera().metres(raw));
                    ASSERT_NEAR(now.surfaces[static_cast<std::size_t>(r.surface)].plane.signed_distance(p), 0,
                                1e-3);
                    ASSERT_LT((r.nearest(p) - p).norm(), 0.02) << name << i;
                    ASSERT_FALSE(r.absent);
                }
            }
        }
    }
}

TEST(Changing, ThePersonComesGoesAndKeepsItsDistance) {
    const SimulatedSource walker(
        parse_simulator_name("sim:walker?change=1&frames=200&rate=10&noise=0&width=160&height=120"));
    int seen = 0;
    for (std::size_t i = 0; i < 200; i += 4) {
        const auto pixels = pixels_of_bodies(walker.world(), walker.depth_view(i));
        seen += pixels > 200 ? 1 : 0;
        if (i < 15 || i > 150) {
            EXPECT_EQ(pixels, 0) << i;
        }
        const World now = walker.world_at(walker.utime(i));
        EXPECT_GT(now.clearance(walker.world_from_color(walker.utime(i)).translation()), 0.4) << i;
    }
    EXPECT_GT(seen, 8);
}

Json truth_of(const SimulatedSource& source) {
    const test::TemporaryFolder folder;
    write_planes_truth(folder.path() / "truth.json", source);
    return Json::parse(read_file(folder.path() / "truth.json"));
}

TEST(PlanesTruth, SaysWhenAPlaneIsThere) {
    const auto times = [](const char* name) {
        std::multiset<std::string> all;
        const Json truth = truth_of(source(name));
        for (const Json& plane : truth["planes"]) {
            if (!plane.contains("body")) continue;
            all.insert((plane.contains("from") ? plane["from"].dump() : "-") + " " +
                       (plane.contains("until") ? plane["until"].dump() : "-"));
        }
        return all;
    };
    // The first frame's stamp is 1 s, the change 2 s later. A box has five sides, a leaf six.
    EXPECT_EQ(times("appearing"), std::multiset<std::string>({"3.0 -", "3.0 -", "3.0 -", "3.0 -", "3.0 -"}));
    EXPECT_EQ(times("vanishing"), std::multiset<std::string>({"- 3.0", "- 3.0", "- 3.0", "- 3.0", "- 3.0"}));
    EXPECT_EQ(times("moved").count("- 3.0"), 5u);
    EXPECT_EQ(times("moved").count("3.0 -"), 5u);
    EXPECT_EQ(times("door").count("- 3.0"), 6u);
    EXPECT_EQ(times("door").count("5.0 -"), 6u);
    EXPECT_EQ(times("door").size(), 12u);
    EXPECT_TRUE(times("office").empty());
}

TEST(PlanesTruth, HasBodiesMaterialsAndTheSensorWhereThereAreAny) {
    const Json walker = truth_of(source("walker"));
    ASSERT_EQ(walker["bodies"].size(), 3u);
    EXPECT_EQ(walker["bodies"][0]["name"], "person");
    EXPECT_EQ(walker["bodies"][0]["from"], 3.0);
    EXPECT_GT(walker["bodies"][0]["until"], 8.0);
    EXPECT_FALSE(walker.contains("sensor"));

    std::set<std::string> materials;
    const Json glass = truth_of(source("glass"));
    for (const Json& plane : glass["planes"]) materials.insert(plane.value("material", "matt"));
    EXPECT_EQ(materials, (std::set<std::string>{"matt", "mirror", "glass", "black"}));

    const SimulatedSource bent(
        parse_simulator_name("sim:office?frames=2&profile=kinect1&width=160&height=120"));
    const Json sensor = truth_of(bent)["sensor"];
    EXPECT_EQ(sensor["profile"], "kinect1");
    EXPECT_EQ(sensor["depth_camera"]["fx"], bent.true_cameras().depth.fx);
    ASSERT_EQ(sensor["bias"]["error_at_4m"].size(), 4u);
    const int u = sensor["bias"]["columns"][3], v = sensor["bias"]["rows"][2];
    EXPECT_NEAR(sensor["bias"]["error_at_4m"][2][3].get<double>(), bent.bias()->read(u, v, 4) - 4, 1e-9);

    const Json office = truth_of(source("office"));
    EXPECT_FALSE(office.contains("bodies") || office.contains("sensor"));
    for (const Json& plane : office["planes"])
        EXPECT_FALSE(plane.contains("from") || plane.contains("body") || plane.contains("material"));
}

TEST(Rooms, AllTwentyAreEntered) {
    const SimulatedSource rooms(parse_simulator_name("sim:rooms?rate=2&width=64&height=48"));
    std::set<int> entered;
    std::vector<int> order;
    for (const StampedPose& pose : rooms.ground_truth()) {
        const Vector3d p = pose.world_from_camera.translation();
        const int column = static_cast<int>(p.x() / 4.6);
        const int room = p.y() > 2.5 ? column : p.y() < -0.5 ? 19 - column : -1;
        if (room >= 0 && entered.insert(room).second) order.push_back(room);
    }
    EXPECT_EQ(entered.size(), 20u);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end())) << "one after another";
}

}  // namespace
}  // namespace planemap::simulator
