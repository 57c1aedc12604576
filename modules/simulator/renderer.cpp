// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/renderer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace planemap::simulator {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double kNear = 0.05;  // metres

/// The corners of a rectangle in the camera frame, cut off at the near plane: up to five points.
struct Polygon {
    std::array<Vector3d, 6> points;
    int count = 0;
    void add(const Vector3d& p) { points[static_cast<std::size_t>(count++)] = p; }
};

Polygon clipped(const std::array<Vector3d, 4>& corners_camera) {
    Polygon polygon;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vector3d &a = corners_camera[i], &b = corners_camera[(i + 1) % 4];
        if (a.z() >= kNear) polygon.add(a);
        if ((a.z() >= kNear) != (b.z() >= kNear)) {
            polygon.add(a + (kNear - a.z()) / (b.z() - a.z()) * (b - a));
        }
    }
    return polygon;
}

/// For each row of an image the columns that a convex polygon covers.
struct Spans {
    int top = 0, bottom = -1;  ///< rows, inclusive
    std::vector<double> left, right;
};

void scan(const Polygon& polygon, const PinholeCamera& camera, Spans& spans) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    std::array<Vector2d, 6> pixels;
    const auto count = static_cast<std::size_t>(polygon.count);
    for (std::size_t i = 0; i < count; ++i) {
        pixels[i] = camera.project(polygon.points[i]);
        low = std::min(low, pixels[i].y());
        high = std::max(high, pixels[i].y());
    }
    const auto row_of = [&](double v) { return static_cast<int>(std::clamp(v, -1.0, camera.height * 1.0)); };
    spans.top = std::max(0, row_of(std::ceil(low)));
    spans.bottom = std::min(camera.height - 1, row_of(std::floor(high)));
    std::fill(spans.left.begin(), spans.left.end(), std::numeric_limits<double>::infinity());
    std::fill(spans.right.begin(), spans.right.end(), -std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < count; ++i) {
        Vector2d a = pixels[i], b = pixels[(i + 1) % count];
        if (a.y() > b.y()) std::swap(a, b);
        const int from = std::max(spans.top, row_of(std::ceil(a.y())));
        const int to = std::min(spans.bottom, row_of(std::floor(b.y())));
        const double height = b.y() - a.y(), slope = height > 0 ? (b.x() - a.x()) / height : 0;
        for (int v = from; v <= to; ++v) {
            const double x = height > 0 ? a.x() + (v - a.y()) * slope : b.x();
            const auto row = static_cast<std::size_t>(v);
            spans.left[row] = std::min({spans.left[row], x, height > 0 ? x : a.x()});
            spans.right[row] = std::max({spans.right[row], x, height > 0 ? x : a.x()});
        }
    }
}

/// Keeps the nearer of what is there and the plane, over the columns [from, to] of one row.
void draw_row(float* inverse_depth, std::int16_t* rectangle, int from, int to, float row_value, float slope,
              std::int16_t index) {
    for (int u = from; u <= to; ++u) {
        const float value = row_value + slope * static_cast<float>(u);
        const bool nearer = value >= inverse_depth[u];
        inverse_depth[u] = nearer ? value : inverse_depth[u];
        rectangle[u] = nearer ? index : rectangle[u];
    }
}

}  // namespace

Vector3d inverse_depth_plane(const Plane& plane_camera, const PinholeCamera& camera) {
    // n . (z ray) + d = 0 with ray = ((u - cx) / fx, (v - cy) / fy, 1).
    const Vector3d row = -plane_camera.normal / plane_camera.d;
    return {row.x() / camera.fx, row.y() / camera.fy,
            row.z() - row.x() * camera.cx / camera.fx - row.y() * camera.cy / camera.fy};
}

Pose mirrored_camera(const Plane& mirror, const Pose& world_from_camera) {
    Pose reflection = Pose::Identity();
    reflection.linear() -= 2 * mirror.normal * mirror.normal.transpose();
    reflection.translation() = -2 * mirror.d * mirror.normal;
    return reflection * world_from_camera;
}

namespace {

/// A camera's way of seeing rectangles: a real one, or its image in a mirror (improper: right is left).
class Projector {
  public:
    Projector(const World& world, const PinholeCamera& camera, const Pose& world_from_camera)
        : world_(world), camera_(camera), camera_from_world_(world_from_camera.inverse(Eigen::Isometry)) {
        spans_.left.resize(static_cast<std::size_t>(camera.height));
        spans_.right.resize(static_cast<std::size_t>(camera.height));
    }

    /// Calls row(v, from, to, row_value, slope) for each row that shows something of rectangle i, columns
    /// [from, to]; its inverse depth in column u is row_value + slope u.
    template <typename Row>
    void for_each_row(std::size_t i, const Row& row) {
        const Rectangle& rectangle = world_.rectangles[i];
        const Plane plane =
            camera_from_world_ * world_.surfaces[static_cast<std::size_t>(rectangle.surface)].plane;
        if (plane.d <= 1e-6) return;  // seen from behind, or edge on
        std::array<Vector3d, 4> corners = rectangle.corners();
        for (Vector3d& corner : corners) corner = camera_from_world_ * corner;
        const Polygon polygon = clipped(corners);
        if (polygon.count < 3) return;
        scan(polygon, camera_, spans_);
        const Vector3d inverse = inverse_depth_plane(plane, camera_);
        for (int v = spans_.top; v <= spans_.bottom; ++v) {
            const auto at = static_cast<std::size_t>(v);
            const double left = std::max(0.0, std::ceil(spans_.left[at]));
            const double right = std::min(camera_.width - 1.0, std::floor(spans_.right[at]));
            if (left > right) continue;
            row(v, static_cast<int>(left), static_cast<int>(right),
                static_cast<float>(inverse.y() * v + inverse.z()), static_cast<float>(inverse.x()));
        }
    }

  private:
    const World& world_;
    const PinholeCamera& camera_;
    Pose camera_from_world_;
    Spans spans_;
};

/// Notes the nearest pane before what is seen.
void draw_panes(const World& world, Projector& projector, View& view) {
    Image<float> nearest = view.inverse_depth;
    for (std::size_t i = 0; i < world.rectangles.size(); ++i) {
        const Rectangle& pane = world.rectangles[i];
        if (pane.absent || pane.material != Material::kGlass) continue;
        projector.for_each_row(i, [&](int v, int from, int to, float value, float slope) {
            draw_row(nearest.row(v), view.pane.row(v), from, to, value, slope, static_cast<std::int16_t>(i));
        });
    }
}

/// Puts what `mirror` shows where it is seen; only what is before it is mirrored.
void look_into(const World& world, std::int16_t mirror, View& view) {
    const Rectangle& glass = world.rectangles[static_cast<std::size_t>(mirror)];
    const Plane& plane = world.surfaces[static_cast<std::size_t>(glass.surface)].plane;
    const Image<float> at_mirror = view.inverse_depth;
    for (std::size_t k = 0; k < view.rectangle.pixels.size(); ++k) {
        if (view.rectangle.pixels[k] != mirror) continue;
        view.rectangle.pixels[k] = -1;
        view.inverse_depth.pixels[k] = 0;
        view.mirror.pixels[k] = mirror;
    }
    Projector projector(world, view.camera, mirrored_camera(plane, view.world_from_camera));
    for (std::size_t i = 0; i < world.rectangles.size(); ++i) {
        const Rectangle& rectangle = world.rectangles[i];
        if (rectangle.absent || rectangle.material == Material::kGlass ||
            i == static_cast<std::size_t>(mirror))
            continue;
        projector.for_each_row(i, [&](int v, int from, int to, float row_value, float slope) {
            float* nearest = view.inverse_depth.row(v);
            for (int u = from; u <= to; ++u) {
                const float value = row_value + slope * static_cast<float>(u);
                if (view.mirror(u, v) != mirror || value > at_mirror(u, v) || value < nearest[u]) continue;
                nearest[u] = value;
                view.mirrored(u, v) = static_cast<std::int16_t>(i);
            }
        });
    }
}

bool has(const World& world, Material material) {
    return std::any_of(world.rectangles.begin(), world.rectangles.end(),
                       [&](const Rectangle& r) { return r.material == material && !r.absent; });
}

}  // namespace

View render_view(const World& world, const PinholeCamera& camera, const Pose& world_from_camera) {
    View view;
    view.camera = camera;
    view.world_from_camera = world_from_camera;
    view.inverse_depth = Image<float>(camera.width, camera.height);
    view.rectangle = Image<std::int16_t>(camera.width, camera.height, -1);
    Projector projector(world, view.camera, world_from_camera);
    for (std::size_t i = 0; i < world.rectangles.size(); ++i) {
        if (world.rectangles[i].absent || world.rectangles[i].material == Material::kGlass) continue;
        projector.for_each_row(i, [&](int v, int from, int to, float value, float slope) {
            draw_row(view.inverse_depth.row(v), view.rectangle.row(v), from, to, value, slope,
                     static_cast<std::int16_t>(i));
        });
    }
    const bool mirrors = has(world, Material::kMirror), panes = has(world, Material::kGlass);
    if (!mirrors && !panes) return view;
    view.mirror = view.mirrored = view.pane = Image<std::int16_t>(camera.width, camera.height, -1);
    if (panes) draw_panes(world, projector, view);
    for (std::size_t i = 0; mirrors && i < world.rectangles.size(); ++i) {
        const Rectangle& rectangle = world.rectangles[i];
        if (rectangle.material == Material::kMirror && !rectangle.absent)
            look_into(world, static_cast<std::int16_t>(i), view);
    }
    return view;
}

}  // namespace planemap::simulator
