// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/true_planes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/geometry/angle.hpp"

namespace planemap::evaluation {
namespace {

using Eigen::Vector3d;

const PinholeCamera kCamera{640, 480, 525, 525, 319.5, 239.5};

/// Adds a panel that faces -y (towards a camera that looks along y), `left` and `right` along x, 2 m high.
void add_panel(simulator::WorldBuilder& builder, const std::string& name, double left, double right,
               double y) {
    builder.add_panel(name, {left, y, 1}, Vector3d::UnitX(), -Vector3d::UnitZ(), right - left, 2,
                      {simulator::Pattern::kPaint, {1, 1, 1}});
}

/// What a camera at (x, y, 0) sees that looks along y.
simulator::View look(const simulator::World& world, double x, double y) {
    Pose pose = Pose::Identity();
    pose.linear().col(0) = Vector3d::UnitX();
    pose.linear().col(1) = -Vector3d::UnitZ();
    pose.linear().col(2) = Vector3d::UnitY();
    pose.translation() = Vector3d(x, y, 0);
    return render_view(world, kCamera, pose);
}

TEST(TruthCollector, SeesARectangleWithoutHoles) {
    simulator::WorldBuilder builder("test", 1);
    add_panel(builder, "wall", -0.5, 0.5, 2);
    TruthCollector truth(builder.world());
    EXPECT_TRUE(truth.planes().empty());
    truth.add(look(builder.world(), 0, 0), {});
    const auto planes = truth.planes();
    ASSERT_EQ(planes.size(), 1u);
    EXPECT_EQ(planes[0].name, "wall");
    EXPECT_NEAR(planes[0].visible.area(), 1 * 2 * 239.5 / 525 * 2,
                0.1);  // the view is not as high as the wall
    EXPECT_LT((planes[0].centre() - Vector3d(0, 2, 0)).norm(), 0.02);
    EXPECT_NEAR(planes[0].plane.signed_distance(Vector3d::Zero()), 2, 1e-12);
    const PlaneRaster& raster = planes[0].visible;
    int changes = 0;  // of a row through the middle: in and out once each
    for (int x = raster.x0 - 1; x <= raster.x0 + raster.mask.width; ++x)
        changes += raster.at(x, 0) != raster.at(x + 1, 0);
    EXPECT_EQ(changes, 2);
}

TEST(TruthCollector, SeesNothingBehindOrOutOfRangeOrGrazing) {
    simulator::WorldBuilder builder("test", 1);
    add_panel(builder, "front", -0.5, 0.5, 2);
    add_panel(builder, "hidden", -0.5, 0.5, 3);
    add_panel(builder, "far", -6, 6, 4.2);
    builder.add_panel("floor", {-1, 3, -0.2}, Vector3d::UnitX(), -Vector3d::UnitY(), 2, 6,
                      {simulator::Pattern::kPaint, {1, 1, 1}});
    TruthCollector truth(builder.world());
    truth.add(look(builder.world(), 0, 0), {});
    std::vector<std::string> names;
    double floor_until = 0;
    for (const TruePlane& plane : truth.planes()) {
        names.push_back(plane.name);
        if (plane.name != "floor") continue;
        for_each_cell(plane.visible, [&](int x, int y) {
            const Eigen::Vector2d p = plane.visible.cell_centre(x, y);
            const Vector3d q = plane.world_from_plane * Vector3d(p.x(), p.y(), 0);
            floor_until = std::max(floor_until, q.norm());
        });
    }
    EXPECT_EQ(names, (std::vector<std::string>{"front", "floor"}));
    EXPECT_NEAR(floor_until, 0.2 / std::cos(radians(76)), 0.03);
}

TEST(TruthCollector, PartsOfOnePlaneBelongTogetherWithinHalfAMetre) {
    for (const double gap : {0.4, 0.6}) {
        simulator::WorldBuilder builder("test", 1);
        add_panel(builder, "left", -1.2, -0.5 * gap, 2);
        add_panel(builder, "right", 0.5 * gap, 1.0, 2);
        TruthCollector truth(builder.world());
        truth.add(look(builder.world(), 0, 0), {});
        const auto planes = truth.planes();
        ASSERT_EQ(planes.size(), gap < 0.5 ? 1u : 2u) << gap;
        EXPECT_EQ(planes[0].name, gap < 0.5 ? "left+1" : "left");
    }
}

TEST(TruthCollector, ItIsTheBoxesOfPartsThatAreNear) {
    simulator::WorldBuilder builder("test", 1);
    // A frame of an L, and a piece in its corner that is 0.7 m from either leg.
    builder.add_panel("low", {-1, 2, -0.6}, Vector3d::UnitX(), -Vector3d::UnitZ(), 2, 0.1,
                      {simulator::Pattern::kPaint, {1, 1, 1}});
    builder.add_panel("left", {-1, 2, 0.7}, Vector3d::UnitX(), -Vector3d::UnitZ(), 0.1, 1.35,
                      {simulator::Pattern::kPaint, {1, 1, 1}});
    builder.add_panel("middle", {0.2, 2, 0.5}, Vector3d::UnitX(), -Vector3d::UnitZ(), 0.3, 0.3,
                      {simulator::Pattern::kPaint, {1, 1, 1}});
    TruthCollector truth(builder.world());
    truth.add(look(builder.world(), 0, 0), {});
    ASSERT_EQ(truth.planes().size(), 1u);
    EXPECT_EQ(truth.planes()[0].name, "low+2");
}

TEST(TruthCollector, ThingsBeforeEachOtherAreTwoPlanes) {
    simulator::WorldBuilder builder("test", 1);
    add_panel(builder, "front", -0.5, 0.1, 2);
    add_panel(builder, "back", 0.1, 0.8, 2.002);
    TruthCollector truth(builder.world());
    truth.add(look(builder.world(), 0, 0), {});
    EXPECT_EQ(truth.planes().size(), 2u);
}

TEST(TruthCollector, MoreViewsShowMore) {
    simulator::WorldBuilder builder("test", 1);
    add_panel(builder, "wall", -4, 4, 2);
    TruthCollector truth(builder.world());
    double area = 0;
    for (const double x : {-1.0, 0.0, 1.0, 1.0}) {
        truth.add(look(builder.world(), x, 0), {});
        ASSERT_EQ(truth.planes().size(), 1u);
        const double now = truth.planes()[0].visible.area();
        EXPECT_GE(now, area);
        area = now;
    }
    EXPECT_NEAR(area, (2 * 319.5 / 525 * 2 + 2) * 2 * 239.5 / 525 * 2, 0.2);
}

TEST(TruePlanes, AreKnownOfSimulatedWorldsOnly) {
    EXPECT_FALSE(true_planes("redkitchen", 0));
    const std::string office = "sim:office?width=160&height=120&frames=60";
    const auto some = true_planes(office, 1), more = true_planes(office, 0);
    ASSERT_TRUE(some && more);
    EXPECT_GT(some->size(), 3u);
    EXPECT_GT(more->size(), some->size());
    for (const TruePlane& plane : *more) EXPECT_GT(plane.visible.count(), 0u) << plane.name;
}

TEST(TruePlanes, AreThoseThatAreThereAtTheEnd) {
    const auto planes_of = [](const std::string& world, const std::string& part) {
        const auto all =
            true_planes("sim:" + world + "?width=160&height=120&rate=5&frames=40&change=4", 0).value();
        std::vector<TruePlane> some;
        std::copy_if(all.begin(), all.end(), std::back_inserter(some),
                     [&](const TruePlane& plane) { return plane.name.starts_with(part); });
        EXPECT_GT(all.size(), 5u) << world;
        return some;
    };
    EXPECT_EQ(planes_of("vanishing", "box").size(), 0u);
    EXPECT_GE(planes_of("appearing", "box").size(), 2u);
    EXPECT_EQ(planes_of("walker", "person").size(), 0u) << "on the way";

    // Seen at both places; the one where it is counts, and no more of it than there is.
    const auto moved = planes_of("moved", "box top"), appeared = planes_of("appearing", "box top");
    ASSERT_EQ(moved.size(), 1u);
    ASSERT_EQ(appeared.size(), 1u);
    EXPECT_NEAR(moved[0].world_from_plane.translation().y() - appeared[0].world_from_plane.translation().y(),
                0.35, 1e-9);
    EXPECT_LT(moved[0].visible.area(), 0.56);

    // Closed, its back is seen; open, its front.
    EXPECT_EQ(planes_of("door", "door front").size(), 1u);
    EXPECT_EQ(planes_of("door", "door back").size(), 0u);
}

TEST(TruePlanes, AreNotMirrorsGlassOrBlack) {
    const auto planes = true_planes("sim:glass?width=160&height=120&rate=2&frames=60", 0).value();
    EXPECT_GT(planes.size(), 20u);
    for (const TruePlane& plane : planes) {
        for (const char* name : {"mirror", "pane", "black"})
            EXPECT_EQ(plane.name.find(name), std::string::npos) << plane.name;
    }
}

}  // namespace
}  // namespace planemap::evaluation
