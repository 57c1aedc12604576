// SPDX-License-Identifier: BSD-3-Clause
// Mirrors, glass and black.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "core/geometry/angle.hpp"
#include "simulator/sensor_model.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::simulator {
namespace {

using Eigen::Vector3d;

const PinholeCamera kCamera{160, 120, 131, 131, 79.5, 59.5};
const Vector3d kRight = Vector3d::UnitX(), kDown = Vector3d::UnitY();

/// Seen by a camera at the origin that looks along z: a wall at 3 m, before it, at 2 m and turned, a piece of
/// the material, and things around the camera.
World scene(Material material, double turned = 0.3) {
    WorldBuilder builder("scene", 1, 8);
    builder.add_panel("wall", {-8, -6, 3}, kRight, kDown, 16, 12, {Pattern::kBrick, {0.6f, 0.4f, 0.3f}});
    builder.add_panel("behind", {8, -6, -2}, -kRight, kDown, 16, 12, {Pattern::kTiles, {0.5f, 0.6f, 0.6f}});
    builder.add_box("box", {{0.9, 0.6, 0.2}, kRight, -kDown}, {0.5, 0.5, 0.6}, {Pattern::kBooks, {}},
                    {Pattern::kPoster, {}}, {});
    builder.use(material);
    const Vector3d right(std::cos(turned), 0, std::sin(turned));
    builder.add_panel("piece", Vector3d(0, -0.5, 2) - 0.5 * right, right, kDown, 1, 1, {});
    return builder.world();
}

std::int16_t index_of(const World& world, Material material) {
    for (std::size_t i = 0; i < world.rectangles.size(); ++i) {
        if (world.rectangles[i].material == material) return static_cast<std::int16_t>(i);
    }
    return -1;
}

/// Where a ray ends, nothing for what is made of other materials than matt: its length.
std::optional<double> cast(const World& world, const Vector3d& from, const Vector3d& ray, double margin) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Rectangle& r : world.rectangles) {
        const Plane& plane = world.surfaces[static_cast<std::size_t>(r.surface)].plane;
        const double along = plane.normal.dot(ray), distance = plane.signed_distance(from);
        if (r.material != Material::kMatt || along >= 0 || distance <= 0) continue;
        const Vector3d offset = from - distance / along * ray - r.centre;
        const bool inside = std::abs(offset.dot(r.half_u)) <= (1 + margin) * r.half_u.squaredNorm() &&
                            std::abs(offset.dot(r.half_v)) <= (1 + margin) * r.half_v.squaredNorm();
        if (inside) nearest = std::min(nearest, -distance / along);
    }
    if (std::isinf(nearest)) return std::nullopt;
    return nearest;
}

TEST(Mirror, ShowsTheDepthOfWhatItMirrors) {
    const World world = scene(Material::kMirror);
    const std::int16_t mirror = index_of(world, Material::kMirror);
    const Rectangle& glass = world.rectangles[static_cast<std::size_t>(mirror)];
    const Plane& plane = world.surfaces[static_cast<std::size_t>(glass.surface)].plane;
    const View view = render_view(world, kCamera, Pose::Identity());
    int checked = 0;
    for (int v = 0; v < kCamera.height; ++v) {
        for (int u = 0; u < kCamera.width; ++u) {
            if (view.mirror(u, v) != mirror) {
                EXPECT_GE(view.rectangle(u, v), 0);
                continue;
            }
            EXPECT_EQ(view.rectangle(u, v), -1) << "nothing is there where a mirror shows it";
            const Vector3d ray = kCamera.unproject(u, v, 1).normalized();
            const double to_mirror = -plane.d / plane.normal.dot(ray);
            const Vector3d back = ray - 2 * plane.normal.dot(ray) * plane.normal;
            const auto inner = cast(world, to_mirror * ray, back, -1e-6);
            const auto outer = cast(world, to_mirror * ray, back, 1e-6);
            if (inner != outer) continue;  // at an edge
            ASSERT_EQ(inner.has_value(), view.mirrored(u, v) >= 0);
            if (!inner) continue;
            EXPECT_NEAR(view.depth(u, v), ray.z() * (to_mirror + *inner), 1e-4) << u << " " << v;
            ++checked;
        }
    }
    EXPECT_GT(checked, 2500);
}

TEST(Mirror, ShowsColoursAsSeenFromTheOtherSide) {
    const World world = scene(Material::kMirror, 0);
    const View view = render_view(world, kCamera, Pose::Identity());
    LaneImage seen(160, 120), from_there(160, 120);
    shade(world, view, 1, seen);
    Pose other_side = Pose::Identity();  // 4 m ahead, looking back
    other_side.linear() << -1, 0, 0, 0, 1, 0, 0, 0, -1;
    other_side.translation() = Vector3d(0, 0, 4);
    const View back = render_view(scene(Material::kGlass, 0), kCamera, other_side);
    shade(world, back, 0.9, from_there);
    int alike = 0, all = 0;
    for (int v = 0; v < 120; ++v) {
        for (int u = 0; u < 160; ++u) {
            if (view.mirror(u, v) < 0 || back.rectangle(159 - u, v) == 0) continue;
            ++all;
            const auto a = seen(u, v) & 0xff, b = from_there(159 - u, v) & 0xff;
            alike += std::abs(static_cast<int>(a) - static_cast<int>(b)) <= 8 ? 1 : 0;
            EXPECT_NEAR(view.depth(u, v), back.depth(159 - u, v), 1e-3);
        }
    }
    EXPECT_GT(all, 2500);
    EXPECT_GT(alike, 0.9 * all);
}

TEST(Glass, ShowsWhatIsBehind) {
    const World world = scene(Material::kGlass);
    World without = world;
    without.rectangles.pop_back();
    const View view = render_view(world, kCamera, Pose::Identity());
    const View plain = render_view(without, kCamera, Pose::Identity());
    EXPECT_EQ(view.inverse_depth.pixels, plain.inverse_depth.pixels);
    EXPECT_EQ(view.rectangle.pixels, plain.rectangle.pixels);
    const auto& panes = view.pane.pixels;
    EXPECT_GT(std::count(panes.begin(), panes.end(), index_of(world, Material::kGlass)), 2500);
    EXPECT_TRUE(plain.pane.empty()) << "worlds without are not slowed down";
}

TEST(Glass, LosesReadingsWhenLookedThroughAslant) {
    const GaussianTable gaussian;
    const auto lost = [&](double turned) {
        const World world = scene(Material::kGlass, turned);
        const View view = render_view(world, kCamera, Pose::Identity());
        const DepthImage depth = sense_depth(world, view, {}, gaussian, 1);
        double through = 0, none = 0;
        for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
            if (view.pane.pixels[i] < 0) continue;
            ++through;
            none += is_valid_depth(depth.pixels[i]) ? 0 : 1;
        }
        return none / through;
    };
    EXPECT_NEAR(lost(0), 0.15, 0.1);
    EXPECT_GT(lost(radians(65)), 0.25);
}

TEST(Black, HasNoReadingAndAColour) {
    const World world = scene(Material::kBlack);
    const std::int16_t black = index_of(world, Material::kBlack);
    const View view = render_view(world, kCamera, Pose::Identity());
    const GaussianTable gaussian;
    for (const bool noise : {true, false}) {
        DepthSensorOptions options;
        options.noise = noise;
        const DepthImage depth = sense_depth(world, view, options, gaussian, 1);
        int seen = 0;
        for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
            if (view.rectangle.pixels[i] != black) continue;
            EXPECT_EQ(depth.pixels[i], 0);
            ++seen;
        }
        EXPECT_GT(seen, 2500);
        EXPECT_TRUE(is_valid_depth(depth(5, 60)));
    }
    LaneImage sum(160, 120);
    shade(world, view, 1, sum);
    EXPECT_GT(sum(80, 60), 0u);
}

TEST(GlassWorld, HasOfEach) {
    const World office = make_glass(1, 8);
    for (const Material material : {Material::kMirror, Material::kGlass, Material::kBlack})
        EXPECT_GE(index_of(office, material), 0);
    EXPECT_LT(index_of(make_office(1, 8), Material::kMirror), 0);
}

}  // namespace
}  // namespace planemap::simulator
