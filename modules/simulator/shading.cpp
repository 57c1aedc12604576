// SPDX-License-Identifier: BSD-3-Clause
// The colours of a view.
#include <algorithm>
#include <cmath>

#include "simulator/renderer.hpp"

namespace planemap::simulator {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Four channels of 8 bits spread to lanes of 16.
std::uint64_t lanes(std::uint32_t texel) {
    return (texel & 0x00ff00ffu) | static_cast<std::uint64_t>(texel & 0xff00ff00u) << 24;
}

constexpr std::uint64_t kLaneBytes = 0x00ff00ff00ff00ffu;

/// a + (b - a) fraction / 256, a lane at a time.
std::uint64_t mixed(std::uint64_t a, std::uint64_t b, std::uint64_t fraction) {
    return ((a * (256 - fraction) + b * fraction) >> 8) & kLaneBytes;
}

/// Bilinear sample of one level (at least 2x2) at texture coordinates in [0, 1].
std::uint64_t sample(const Image<std::uint32_t>& level, float s, float t) {
    const auto width = static_cast<float>(level.width), height = static_cast<float>(level.height);
    const float x = std::min(std::max(s * width - 0.5f, 0.0f), width - 1.001f);
    const float y = std::min(std::max(t * height - 0.5f, 0.0f), height - 1.001f);
    const int u = static_cast<int>(x), v = static_cast<int>(y);
    const int fx = static_cast<int>((x - static_cast<float>(u)) * 256);
    const int fy = static_cast<int>((y - static_cast<float>(v)) * 256);
    const int both = fx * fy >> 8;
    const std::uint32_t *top = level.row(v) + u, *bottom = top + level.width;
    const auto weighted = [](std::uint32_t texel, int weight) {
        return lanes(texel) * static_cast<std::uint32_t>(weight);
    };
    // The weights add up to 256, so no lane overflows.
    const std::uint64_t sum = weighted(top[0], 256 - fx - fy + both) + weighted(top[1], fx - both) +
                              weighted(bottom[0], fy - both) + weighted(bottom[1], both);
    return (sum >> 8) & kLaneBytes;
}

/// Light that falls on a point, as an image stores it: 1 is a well-lit surface.
double light_at(const World& world, const Vector3d& point, const Vector3d& normal) {
    constexpr double kAmbient = 0.45, kGamma = 0.45;
    double light = kAmbient;
    for (const Lamp& lamp : world.lamps) {
        const Vector3d towards = lamp.position - point;
        const double squared = towards.squaredNorm();
        light += lamp.power * std::max(0.0, normal.dot(towards)) / (std::sqrt(squared) * (squared + 0.7));
    }
    return std::pow(light, kGamma);
}

/// A rectangle as one view sees it: texture coordinates are z (s_row . ray) + s_0, ray = (x, y, 1).
struct Shader {
    const World& world;
    const View& view;
    Pose world_from_camera;  // the view's, or its image in a mirror
    const Rectangle& rectangle;
    const Texture& texture;
    Vector3d normal, s_row, t_row, plane;
    double s_0, t_0;

    Shader(const World& w, const View& v, const Pose& world_from_eye, const Rectangle& r)
        : world(w),
          view(v),
          world_from_camera(world_from_eye),
          rectangle(r),
          texture(*w.textures[static_cast<std::size_t>(r.texture)]),
          normal(w.surfaces[static_cast<std::size_t>(r.surface)].plane.normal) {
        const Matrix3d rotation = world_from_camera.linear();
        const Vector3d offset = world_from_camera.translation() - (r.centre - r.half_u - r.half_v);
        const Vector3d s_axis =
            (r.texture_to.x() - r.texture_from.x()) * 0.5 / r.half_u.squaredNorm() * r.half_u;
        const Vector3d t_axis =
            (r.texture_to.y() - r.texture_from.y()) * 0.5 / r.half_v.squaredNorm() * r.half_v;
        s_row = per_pixel(rotation.transpose() * s_axis);
        t_row = per_pixel(rotation.transpose() * t_axis);
        s_0 = r.texture_from.x() + s_axis.dot(offset);
        t_0 = r.texture_from.y() + t_axis.dot(offset);
        const Plane& world_plane = w.surfaces[static_cast<std::size_t>(r.surface)].plane;
        plane = inverse_depth_plane(world_from_camera.inverse(Eigen::Isometry) * world_plane, v.camera);
    }

    /// Of a row vector over rays, the row vector over pixels (u, v, 1).
    Vector3d per_pixel(const Vector3d& row) const {
        const PinholeCamera& c = view.camera;
        return {row.x() / c.fx, row.y() / c.fy, row.z() - row.x() * c.cx / c.fx - row.y() * c.cy / c.fy};
    }

    /// Mip level (not rounded) where one texel covers about one pixel.
    double level_at(double u, double v) const {
        const Vector3d pixel(u, v, 1);
        const double z = 1 / plane.dot(pixel);
        // d(s)/du = z s_row.x - z^2 plane.x (s_row . pixel), and so on.
        const auto& base = texture.levels.front();
        const Vector2d ds = z * (s_row.head<2>() - z * s_row.dot(pixel) * plane.head<2>()) * base.width;
        const Vector2d dt = z * (t_row.head<2>() - z * t_row.dot(pixel) * plane.head<2>()) * base.height;
        return 0.5 * std::log2(0.5 * (ds.squaredNorm() + dt.squaredNorm()) + 1e-12);
    }

    double light(double u, double v) const {
        const double z = 1 / plane.dot(Vector3d(u, v, 1));
        return light_at(world, world_from_camera * view.camera.unproject(u, v, z), normal);
    }
};

/// Light and mip level change slowly: they are worked out at the ends of short blocks.
constexpr int kBlock = 16;

void shade_block(const Shader& shader, int v, int from, int to, double exposure, std::uint64_t* sum) {
    const float* inverse_depth = shader.view.inverse_depth.row(v);
    const auto row = [v](const Vector3d& r) { return static_cast<float>(r.y() * v + r.z()); };
    const float s_base = row(shader.s_row), t_base = row(shader.t_row);
    const auto s_step = static_cast<float>(shader.s_row.x()), t_step = static_cast<float>(shader.t_row.x());
    const auto s_0 = static_cast<float>(shader.s_0), t_0 = static_cast<float>(shader.t_0);

    const double last = static_cast<double>(shader.texture.levels.size()) - 1.001;
    const double level = std::clamp(shader.level_at(0.5 * (from + to), v), 0.0, last);
    const auto& fine = shader.texture.levels[static_cast<std::size_t>(level)];
    const auto& coarse = shader.texture.levels[static_cast<std::size_t>(level) + 1];
    const auto fraction = static_cast<std::uint64_t>((level - std::floor(level)) * 256);
    // Light in 1/65536; a texture shows its surface in full light.
    const auto fixed = [&](int u) {
        return static_cast<int>(65536 * std::clamp(shader.light(u, v) * exposure, 0.0, 1.0));
    };
    int gain = fixed(from);
    const int gain_step = (fixed(to) - gain) / std::max(1, to - from);
    for (int u = from; u <= to; ++u, gain += gain_step) {
        const float z = 1 / inverse_depth[u];
        const float s = (s_base + s_step * static_cast<float>(u)) * z + s_0;
        const float t = (t_base + t_step * static_cast<float>(u)) * z + t_0;
        std::uint64_t color = sample(fine, s, t);
        if (fraction != 0) color = mixed(color, sample(coarse, s, t), fraction);
        const auto factor = static_cast<std::uint64_t>(gain >> 8);
        sum[u] += ((color * factor + 0x0080008000800080u) >> 8) & kLaneBytes;
    }
}

/// Adds the colours of what one way of looking shows: what `seen` names, through the camera's own eyes
/// (`mirror` -1) or in that mirror.
void shade_seen(const World& world, const View& view, const Image<std::int16_t>& seen, std::int16_t mirror,
                double exposure, LaneImage& sum) {
    Pose world_from_camera = view.world_from_camera;
    if (mirror >= 0) {
        const Rectangle& glass = world.rectangles[static_cast<std::size_t>(mirror)];
        world_from_camera = mirrored_camera(world.surfaces[static_cast<std::size_t>(glass.surface)].plane,
                                            view.world_from_camera);
    }
    std::vector<Shader> shaders;
    shaders.reserve(world.rectangles.size());
    std::vector<int> shader_of(world.rectangles.size(), -1);
    for (int v = 0; v < view.camera.height; ++v) {
        const std::int16_t* rectangle = seen.row(v);
        const std::int16_t* in_mirror = mirror >= 0 ? view.mirror.row(v) : nullptr;
        for (int u = 0; u < view.camera.width;) {
            const std::int16_t index = rectangle[u];
            int end = u + 1;
            while (end < view.camera.width && end - u < kBlock && rectangle[end] == index &&
                   (in_mirror == nullptr || in_mirror[end] == in_mirror[u]))
                ++end;
            if (index >= 0 && (in_mirror == nullptr || in_mirror[u] == mirror)) {
                int& shader = shader_of[static_cast<std::size_t>(index)];
                if (shader < 0) {
                    shader = static_cast<int>(shaders.size());
                    shaders.emplace_back(world, view, world_from_camera,
                                         world.rectangles[static_cast<std::size_t>(index)]);
                }
                shade_block(shaders[static_cast<std::size_t>(shader)], v, u, end - 1, exposure, sum.row(v));
            }
            u = end;
        }
    }
}

}  // namespace

void shade(const World& world, const View& view, double exposure, LaneImage& sum) {
    constexpr double kMirrorGain = 0.9;
    shade_seen(world, view, view.rectangle, -1, exposure, sum);
    for (std::size_t i = 0; !view.mirror.empty() && i < world.rectangles.size(); ++i) {
        if (world.rectangles[i].material == Material::kMirror && !world.rectangles[i].absent)
            shade_seen(world, view, view.mirrored, static_cast<std::int16_t>(i), kMirrorGain * exposure, sum);
    }
}

}  // namespace planemap::simulator
