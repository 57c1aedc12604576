// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace planemap::simulator {
namespace {

using Eigen::Vector3d;

const PinholeCamera kCamera{160, 120, 131, 130, 79.3, 60.1};

Pose looking_about(const Vector3d& position, const Vector3d& rotation) {
    Pose down_to_up = Pose::Identity();  // forward is world y, down is world -z
    down_to_up.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    Pose pose = down_to_up;
    pose.linear() = so3_exp(rotation) * down_to_up.linear();
    pose.translation() = position;
    return pose;
}

/// Nearest hit of a ray with all rectangles: depth, or 0.
double cast(const World& world, const Pose& world_from_camera, const Vector3d& ray_camera, double margin) {
    const Vector3d ray = world_from_camera.linear() * ray_camera, from = world_from_camera.translation();
    double nearest = 1e9;
    for (const Rectangle& r : world.rectangles) {
        const Plane& plane = world.surfaces[static_cast<std::size_t>(r.surface)].plane;
        const double along = plane.normal.dot(ray);
        if (along >= 0 || plane.signed_distance(from) <= 0) continue;
        const double z = -plane.signed_distance(from) / along;
        const Vector3d offset = from + z * ray - r.centre;
        const bool inside = std::abs(offset.dot(r.half_u)) <= (1 + margin) * r.half_u.squaredNorm() &&
                            std::abs(offset.dot(r.half_v)) <= (1 + margin) * r.half_v.squaredNorm();
        if (z > 0.05 && inside) nearest = std::min(nearest, z);
    }
    return nearest < 1e9 ? nearest : 0;
}

TEST(Renderer, DepthIsTheNearestRayHit) {
    const World office = make_office(3, 8);
    const Pose poses[] = {
        looking_about({3, 2.5, 1.5}, {0, 0, 0.3}), looking_about({2, 2, 1.2}, {-0.5, 0.1, 2.5}),
        looking_about({3.5, 0.3, 1.4}, {0.2, 0.7, 3.1}), looking_about({0.3, 4.2, 2.2}, {0, -0.6, -2})};
    int compared = 0;
    for (const Pose& pose : poses) {
        const View view = render_view(office, kCamera, pose);
        for (int v = 0; v < kCamera.height; v += 3) {
            for (int u = 0; u < kCamera.width; u += 3) {
                const Vector3d ray = kCamera.unproject(u, v, 1);
                const double inner = cast(office, pose, ray, -1e-6), outer = cast(office, pose, ray, 1e-6);
                if (inner != outer) continue;  // at an edge, within rounding
                EXPECT_NEAR(view.depth(u, v), inner, 1e-5 * (1 + inner * inner)) << u << " " << v;
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 8000);
}

TEST(Renderer, PixelsLieOnTheirPlanes) {
    const World office = make_office(1, 8);
    const Pose pose = looking_about({3, 2.5, 1.5}, {0.2, 0.1, 1.0});
    const View view = render_view(office, kCamera, pose);
    for (int v = 0; v < kCamera.height; ++v) {
        for (int u = 0; u < kCamera.width; ++u) {
            ASSERT_GE(view.rectangle(u, v), 0) << "the office is closed: " << u << " " << v;
            const auto& r = office.rectangles[static_cast<std::size_t>(view.rectangle(u, v))];
            const Vector3d p = pose * kCamera.unproject(u, v, view.depth(u, v));
            EXPECT_NEAR(office.surfaces[static_cast<std::size_t>(r.surface)].plane.signed_distance(p), 0,
                        1e-5);
        }
    }
}

TEST(Renderer, APictureCoversItsWall) {
    WorldBuilder builder("test", 1, 8);
    builder.add_panel("wall", {-3, 2, 3}, Vector3d::UnitX(), -Vector3d::UnitZ(), 6, 6, {});
    builder.add_picture(2.5, 2.5, 1, 1, {Pattern::kPoster, {}});
    const View view = render_view(builder.world(), kCamera, looking_about({0, 0, 0}, {0, 0, 0}));
    EXPECT_EQ(view.rectangle(79, 60), 1);
    EXPECT_EQ(view.rectangle(5, 60), 0);
    EXPECT_EQ(view.depth(79, 60), view.depth(5, 60));
}

TEST(Renderer, SeesNothingWhereNothingIs) {
    WorldBuilder builder("test", 1, 8);
    builder.add_panel("wall", {-3, 2, 3}, Vector3d::UnitX(), -Vector3d::UnitZ(), 6, 6, {});
    const World& world = builder.world();
    for (const Pose& pose : {looking_about({0, 0, 0}, {0, 0, 3.14}),     // away from it
                             looking_about({0, 4, 0}, {0, 0, 3.14}),     // from behind
                             looking_about({0, 2, 0}, {0, 0, 1.57}),     // from within its plane
                             looking_about({0, 1.99, 0}, {0, 0, 0})}) {  // nearer than the near plane
        const View view = render_view(world, kCamera, pose);
        for (const float inverse : view.inverse_depth.pixels) EXPECT_EQ(inverse, 0);
        LaneImage sum(kCamera.width, kCamera.height);
        shade(world, view, 1, sum);
        for (const std::uint64_t lanes : sum.pixels) EXPECT_EQ(lanes, 0u);
    }
    EXPECT_EQ(render_view(World{}, kCamera, Pose::Identity()).depth(3, 3), 0);
}

TEST(Renderer, ColorsMoveWithTheSurface) {
    // The same point of a wall looks the same from two places, up to sampling.
    WorldBuilder builder("test", 5);
    builder.add_panel("wall", {-3, 2, 3}, Vector3d::UnitX(), -Vector3d::UnitZ(), 6, 6,
                      {Pattern::kBrick, {0.6f, 0.4f, 0.3f}});
    const World& world = builder.world();
    const Pose a = looking_about({0, 0.4, 0}, {0, 0, 0}),
               b = looking_about({0.3, 0.3, 0.1}, {0.05, 0.02, 0.2});
    const View view_a = render_view(world, kCamera, a), view_b = render_view(world, kCamera, b);
    LaneImage sum_a(160, 120), sum_b(160, 120);
    shade(world, view_a, 1, sum_a);
    shade(world, view_b, 1, sum_b);
    double difference = 0, apart = 0;
    int count = 0;
    for (int v = 10; v < 110; ++v) {
        for (int u = 10; u < 150; ++u) {
            const Vector3d p = a * kCamera.unproject(u, v, view_a.depth(u, v));
            const Eigen::Vector2d pixel = kCamera.project(b.inverse() * p);
            const int x = static_cast<int>(std::lround(pixel.x())),
                      y = static_cast<int>(std::lround(pixel.y()));
            if (!view_b.rectangle.contains(x, y) || !view_b.rectangle.contains(x + 9, y)) continue;
            const auto red = [](std::uint64_t lanes) { return static_cast<double>(lanes & 0xffff); };
            difference += std::abs(red(sum_a(u, v)) - red(sum_b(x, y)));
            apart += std::abs(red(sum_a(u, v)) - red(sum_b(x + 9, y)));
            ++count;
        }
    }
    ASSERT_GT(count, 5000);
    EXPECT_LT(difference, 0.5 * apart);
}

TEST(Renderer, ExposureScalesBrightness) {
    const World office = make_office(1, 8);
    const View view = render_view(office, kCamera, looking_about({3, 2.5, 1.5}, {0, 0, 0.3}));
    LaneImage full(160, 120), half(160, 120);
    shade(office, view, 0.8, full);
    shade(office, view, 0.4, half);
    for (std::size_t i = 0; i < full.pixels.size(); ++i) {
        EXPECT_NEAR(static_cast<double>(half.pixels[i] & 0xffff),
                    0.5 * static_cast<double>(full.pixels[i] & 0xffff), 1.6);
    }
}

}  // namespace
}  // namespace planemap::simulator
