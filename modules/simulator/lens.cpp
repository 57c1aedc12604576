// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/lens.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace planemap::simulator {

using Eigen::Vector2d;
using Eigen::Vector3d;

Lens::Lens(const PinholeCamera& camera, double distortion) : camera_(camera), distortion_(distortion) {
    const double x = std::max(camera.cx, camera.width - 1 - camera.cx);
    const double y = std::max(camera.cy, camera.height - 1 - camera.cy);
    squared_corner_ = x * x + y * y;
}

Vector2d Lens::ideal(double u, double v) const {
    const Vector2d centre(camera_.cx, camera_.cy), offset = Vector2d(u, v) - centre;
    return centre + (1 - distortion_ * offset.squaredNorm() / squared_corner_) * offset;
}

View Lens::distorted(const World& world, const View& pinhole) const {
    View view = pinhole;
    const bool special = !pinhole.mirror.empty();
    using Key = std::pair<std::int16_t, std::int16_t>;  // rectangle and mirror
    std::map<Key, Vector3d> planes;
    auto last = planes.end();
    const auto plane_of = [&](std::int16_t index, std::int16_t mirror) -> const Vector3d& {
        const Key key{index, mirror};
        if (last != planes.end() && last->first == key) return last->second;
        const auto [at, is_new] = planes.try_emplace(key);
        last = at;
        if (is_new) {
            const auto plane = [&](std::int16_t i) -> const Plane& {
                const auto surface = world.rectangles[static_cast<std::size_t>(i)].surface;
                return world.surfaces[static_cast<std::size_t>(surface)].plane;
            };
            const Pose eye = mirror < 0 ? pinhole.world_from_camera
                                        : mirrored_camera(plane(mirror), pinhole.world_from_camera);
            at->second = inverse_depth_plane(eye.inverse(Eigen::Isometry) * plane(index), camera_);
        }
        return at->second;
    };
    for (int v = 0; v < view.camera.height; ++v) {
        for (int u = 0; u < view.camera.width; ++u) {
            const Vector2d from = ideal(u, v);
            const int x = static_cast<int>(std::lround(from.x())),
                      y = static_cast<int>(std::lround(from.y()));
            const std::int16_t mirror = special ? pinhole.mirror(x, y) : std::int16_t{-1};
            const std::int16_t index = mirror >= 0 ? pinhole.mirrored(x, y) : pinhole.rectangle(x, y);
            view.rectangle(u, v) = pinhole.rectangle(x, y);
            view.inverse_depth(u, v) =
                index < 0 ? 0.0f
                          : static_cast<float>(
                                std::max(0.0, plane_of(index, mirror).dot(Vector3d(from.x(), from.y(), 1))));
            if (!special) continue;
            view.mirror(u, v) = mirror;
            view.mirrored(u, v) = pinhole.mirrored(x, y);
            view.pane(u, v) = pinhole.pane(x, y);
        }
    }
    return view;
}

LaneImage Lens::distorted(const LaneImage& pinhole) const {
    LaneImage image(pinhole.width, pinhole.height);
    // Two lanes at a time have room for the weights, which add up to 65536.
    constexpr std::uint64_t kTwo = 0x0000ffff0000ffffu, kHalf = 0x0000800000008000u;
    for (int v = 0; v < image.height; ++v) {
        for (int u = 0; u < image.width; ++u) {
            const Vector2d from = ideal(u, v);
            const int x = std::clamp(static_cast<int>(from.x()), 0, pinhole.width - 2);
            const int y = std::clamp(static_cast<int>(from.y()), 0, pinhole.height - 2);
            const auto right = static_cast<std::uint64_t>(std::clamp((from.x() - x) * 256, 0.0, 256.0));
            const auto down = static_cast<std::uint64_t>(std::clamp((from.y() - y) * 256, 0.0, 256.0));
            const std::uint64_t *top = pinhole.row(y) + x, *bottom = top + pinhole.width;
            const auto mixed = [&](int shift) {
                const auto at = [&](std::uint64_t lanes) { return lanes >> shift & kTwo; };
                return (at(top[0]) * ((256 - right) * (256 - down)) + at(top[1]) * (right * (256 - down)) +
                        at(bottom[0]) * ((256 - right) * down) + at(bottom[1]) * (right * down) + kHalf) >>
                           16 &
                       kTwo;
            };
            image(u, v) = mixed(0) | mixed(16) << 16;
        }
    }
    return image;
}

}  // namespace planemap::simulator
