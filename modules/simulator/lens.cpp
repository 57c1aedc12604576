// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/lens.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/lens_distortion.hpp"
#include "core/validation.hpp"

namespace planemap::simulator {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// By pixel, what `place` says of it.
template <typename Place>
Image<Vector2d> places_of(const PinholeCamera& camera, const Place& place) {
    Image<Vector2d> places(camera.width, camera.height, Vector2d(0, 0));
    for (int v = 0; v < camera.height; ++v)
        for (int u = 0; u < camera.width; ++u) places(u, v) = place(Vector2d(u, v));
    return places;
}

}  // namespace

Lens::Lens(const PinholeCamera& camera, double distortion) : camera_(camera), pinhole_(camera) {
    if (distortion == 0) return;
    const double x = std::max(camera.cx, camera.width - 1 - camera.cx);
    const double y = std::max(camera.cy, camera.height - 1 - camera.cy);
    const double squared_corner = x * x + y * y;
    places_ = places_of(camera, [&](const Vector2d& pixel) -> Vector2d {
        const Vector2d centre(camera.cx, camera.cy), offset = pixel - centre;
        return centre + (1 - distortion * offset.squaredNorm() / squared_corner) * offset;
    });
}

Lens::Lens(const PinholeCamera& camera, const LensDistortion& model) : camera_(camera), pinhole_(camera) {
    FieldErrors errors("simulator options");
    check_distortion(model, camera, "lens", errors);
    errors.throw_if_any();
    const Vector2d focal(camera.fx, camera.fy), centre(camera.cx, camera.cy);
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    places_ = places_of(camera, [&](const Vector2d& pixel) -> Vector2d {
        const Vector2d ideal = undistorted(model, (pixel - centre).cwiseQuotient(focal))
                                   .value_or(Vector2d(kNan, kNan));  // which stays in what follows
        return ideal.cwiseProduct(focal) + centre;
    });
    widen();
}

/// Makes the pinhole as wide as the places need it.
void Lens::widen() {
    constexpr double kMost = 4;  // times the image, on each side
    Vector2d beyond = Vector2d::Zero();
    for (const Vector2d& place : places_.pixels) {
        if (!place.allFinite()) continue;
        beyond = beyond.cwiseMax(-place).cwiseMax(place - Vector2d(camera_.width - 1, camera_.height - 1));
    }
    if (beyond.x() > kMost * camera_.width || beyond.y() > kMost * camera_.height)
        throw std::invalid_argument("simulator parameter lens sees too wide to be drawn");
    const auto margin = [](double pixels) {
        return pixels > 0 ? static_cast<int>(std::ceil(pixels)) + 1 : 0;
    };
    const int x = margin(beyond.x()), y = margin(beyond.y());
    pinhole_.width += 2 * x, pinhole_.height += 2 * y;
    pinhole_.cx += x, pinhole_.cy += y;
    for (Vector2d& place : places_.pixels) place += Vector2d(x, y);
}

Vector2d Lens::ideal(int u, int v) const {
    if (is_pinhole()) return {u, v};
    return places_(u, v) - Vector2d(pinhole_.cx - camera_.cx, pinhole_.cy - camera_.cy);
}

View Lens::distorted(const World& world, const View& pinhole) const {
    View view;
    view.camera = camera_;
    view.world_from_camera = pinhole.world_from_camera;
    view.inverse_depth = Image<float>(camera_.width, camera_.height);
    view.rectangle = Image<std::int16_t>(camera_.width, camera_.height, -1);
    const bool special = !pinhole.mirror.empty();
    if (special) view.mirror = view.mirrored = view.pane = view.rectangle;
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
            at->second = inverse_depth_plane(eye.inverse(Eigen::Isometry) * plane(index), pinhole_);
        }
        return at->second;
    };
    for (int v = 0; v < view.camera.height; ++v) {
        for (int u = 0; u < view.camera.width; ++u) {
            const Vector2d& from = places_(u, v);
            if (!from.allFinite()) continue;
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
    LaneImage image(camera_.width, camera_.height);
    // Two lanes at a time have room for the weights, which add up to 65536.
    constexpr std::uint64_t kTwo = 0x0000ffff0000ffffu, kHalf = 0x0000800000008000u;
    for (int v = 0; v < image.height; ++v) {
        for (int u = 0; u < image.width; ++u) {
            const Vector2d& from = places_(u, v);
            if (!from.allFinite()) continue;
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

LensDistortion parse_lens(const std::string& text) {
    const auto refuse = [&]() {
        return std::invalid_argument("simulator parameter lens is \"" + text +
                                     "\", must be MODEL:COEFFICIENT,..., as brown:-0.3,0.1,0,0 or "
                                     "fisheye:0.01,0,0,0");
    };
    const std::size_t colon = text.find(':');
    const auto model = distortion_model(text.substr(0, colon));
    if (!model || colon == std::string::npos) throw refuse();
    LensDistortion lens{*model, {}};
    for (std::size_t from = colon; from != std::string::npos; from = text.find(',', from + 1)) {
        const std::string number = text.substr(from + 1, text.find(',', from + 1) - from - 1);
        std::size_t used = 0;
        try {
            lens.coefficients.push_back(std::stod(number, &used));
        } catch (const std::exception&) {
            throw refuse();
        }
        if (used != number.size()) throw refuse();
    }
    return lens;
}

}  // namespace planemap::simulator
