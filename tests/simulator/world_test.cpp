// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/geometry/angle.hpp"

namespace planemap::simulator {
namespace {

using Eigen::Vector3d;

double area(const World& world) {
    double sum = 0;
    for (const Rectangle& r : world.rectangles) sum += r.picture ? 0 : 4 * r.half_u.norm() * r.half_v.norm();
    return sum;
}

TEST(WorldBuilder, HolesAreLeftOut) {
    WorldBuilder builder("test", 1, 8);
    const Hole holes[] = {{1, 1, 2, 3}, {1, 3.5, 2, 4}, {2.5, 0, 3, 1}};
    builder.add_panel("wall", {0, 0, 4}, Vector3d::UnitX(), -Vector3d::UnitZ(), 5, 4, {}, holes);
    EXPECT_NEAR(area(builder.world()), 20 - 2 - 0.5 - 0.5, 1e-9);
    EXPECT_EQ(builder.world().surfaces.size(), 1u);
    // The wall is seen from y < 0, looking north.
    EXPECT_LT(builder.world().surfaces[0].plane.normal.y(), -0.999);
    EXPECT_NEAR(builder.world().clearance({1.5, 0, 2}), 0.5, 1e-9);
    EXPECT_NEAR(builder.world().clearance({0.5, -0.3, 2}), 0.3, 1e-9);
}

TEST(WorldBuilder, ABoxIsClosedAndFacesOutwards) {
    WorldBuilder builder("test", 1, 8);
    builder.add_box("box", {{1, 2, 3}, Vector3d::UnitX()}, {2, 3, 4}, {}, {}, {});
    EXPECT_EQ(builder.world().surfaces.size(), 6u);
    EXPECT_NEAR(area(builder.world()), 2 * (2 * 3 + 3 * 4 + 2 * 4), 1e-9);
    const Vector3d centre(2, 3.5, 5);
    for (const Surface& surface : builder.world().surfaces) {
        EXPECT_LT(surface.plane.signed_distance(centre), 0) << surface.name;
    }
}

TEST(Office, RectanglesLieOnTheirSurfaces) {
    const World office = make_office(1, 8);
    for (const Rectangle& rectangle : office.rectangles) {
        const Plane& plane = office.surfaces.at(static_cast<std::size_t>(rectangle.surface)).plane;
        EXPECT_TRUE(is_valid(plane));
        EXPECT_LT(static_cast<std::size_t>(rectangle.texture), office.textures.size());
        for (const Vector3d& corner : rectangle.corners())
            EXPECT_NEAR(plane.signed_distance(corner), 0, 1e-9);
        const auto corners = rectangle.corners();
        EXPECT_GT((corners[1] - corners[0]).cross(corners[2] - corners[1]).dot(plane.normal), 0);
    }
}

TEST(Office, HasAWallAt56Degrees) {
    const World office = make_office(1, 8);
    const auto normal = [&](const char* name) {
        for (const Surface& surface : office.surfaces) {
            if (surface.name == name) return surface.plane.normal;
        }
        return Vector3d(0, 0, 0);
    };
    EXPECT_NEAR(angle_between(normal("north wall"), normal("slanted wall")), radians(56), 1e-9);
    EXPECT_NEAR(angle_between(normal("floor"), normal("ceiling")), std::numbers::pi, 1e-9);
}

}  // namespace
}  // namespace planemap::simulator
