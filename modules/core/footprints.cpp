// SPDX-License-Identifier: BSD-3-Clause
#include "core/footprints.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/inverse_depth.hpp"
#include "core/rounding.hpp"

namespace planemap {

namespace {

/// A point of a surface on the colour image.
struct ColorPoint {
    float x = 0, y = 0;  ///< pixels; NaN: behind the camera
    float w = 0;         ///< inverse depth, 1/metres
};

class Footprints {
  public:
    Footprints(const DepthImage& depth, const CameraInfo& camera, const Reprojection& reprojection,
               DepthImage& out)
        : units_(static_cast<float>(camera.depth_units_per_metre)),
          m_(reprojection.m.cast<float>()),
          t_(reprojection.t.cast<float>()),
          depth_(depth, camera.depth_units_per_metre),
          border_(depth_.border),
          joints_(depth_, camera),
          out_(out),
          last_x_(static_cast<float>(out.width - 1)),
          last_y_(static_cast<float>(out.height - 1)) {
        drop_lone_slopes();
        const Eigen::Matrix2d steps = reprojection.steps(camera.color);
        longest_ = static_cast<float>(kMostStretched * (steps.col(0).norm() + steps.col(1).norm()));
    }

    void fill() {
        const int end = depth_.value.height - border_;
        Shared above(depth_.value.width), below(depth_.value.width);
        share(border_, above);
        for (int v = border_; v < end; ++v) {
            share(v + 1, below);
            fill_row(v, above, below);
            std::swap(above, below);
        }
    }

  private:
    /// A footprint may be this many times as long as a far surface's: beyond, the colour camera would be at a
    /// quarter of the distance, and a hostile transform could make each reading fill the whole image.
    static constexpr double kMostStretched = 4;

    /// The corners between two rows of readings, at the upper left of pixel u; full where all four readings
    /// around the corner lie on one surface.
    struct Shared {
        std::vector<std::uint8_t> full;
        std::vector<float> w, x, y;  ///< on the colour image

        explicit Shared(int width) : full(static_cast<std::size_t>(width)), w(full.size()), x(w), y(w) {}
        ColorPoint at(int u) const {
            const auto i = static_cast<std::size_t>(u);
            return {x[i], y[i], w[i]};
        }
    };

    void drop_lone_slopes();
    void share(int v, Shared& row) const;
    void fill_row(int v, const Shared& above, const Shared& below);
    float corner_value(int u, int v, int du, int dv) const;
    ColorPoint corner(int u, int v, int du, int dv) const;
    void fill_quad(const std::array<ColorPoint, 4>& corners);
    void put(int x, int y, float w);

    /// Neighbours on one surface, to the right or left and below or above.
    bool joined_u(int u, int v, int du) const { return joints_.right(du > 0 ? u : u - 1, v) != 0; }
    bool joined_v(int u, int v, int dv) const { return joints_.below(u, dv > 0 ? v : v - 1) != 0; }

    /// m_ (x, y, 1), summed in one order on every machine: Eigen's own differs where vectors hold two floats.
    Eigen::Vector3f direction(float x, float y) const {
        const auto row = [&](int i) { return m_(i, 0) * x + (m_(i, 1) * y + m_(i, 2)); };
        return {row(0), row(1), row(2)};
    }

    float units_;
    Eigen::Matrix3f m_;
    Eigen::Vector3f t_;
    InverseDepth depth_;
    int border_;
    Joints joints_;
    DepthImage& out_;
    float last_x_, last_y_, longest_ = 0;
};

/// A reading between two surfaces (half of it saw each) has the slope of the jump: it lies on none.
void Footprints::drop_lone_slopes() {
    for (int v = border_; v < depth_.value.height - border_; ++v) {
        const std::uint8_t *right = joints_.right.row(v), *above = joints_.below.row(v - 1),
                           *below = joints_.below.row(v);
        float *along_u = depth_.along_u.row(v), *along_v = depth_.along_v.row(v);
        for (int u = border_; u < depth_.value.width - border_; ++u) {
            along_u[u] = (right[u - 1] | right[u]) != 0 ? along_u[u] : 0;
            along_v[u] = (above[u] | below[u]) != 0 ? along_v[u] : 0;
        }
    }
}

void Footprints::share(int v, Shared& row) const {
    const float *up = depth_.value.row(v - 1), *down = depth_.value.row(v);
    const std::uint8_t *up_right = joints_.right.row(v - 1), *down_right = joints_.right.row(v),
                       *up_below = joints_.below.row(v - 1);
    const float mx = m_(0, 0), my = m_(1, 0), mz = m_(2, 0), tx = t_.x(), ty = t_.y(), tz = t_.z();
    const Eigen::Vector3f first =
        direction(-0.5f - static_cast<float>(border_), static_cast<float>(v - border_) - 0.5f);
    const float first_x = first.x(), first_y = first.y(), first_z = first.z();
    const int end = depth_.value.width - border_ + 1;
    float *const w = row.w.data(), *const x = row.x.data(), *const y = row.y.data();
    std::uint8_t* const full = row.full.data();
    // Without a branch, for the compiler to take several corners at a time.
    for (int u = border_; u < end; ++u)
        full[u] = up_right[u - 1] + down_right[u - 1] + up_below[u - 1] + up_below[u] >= 3;
    for (int u = border_; u < end; ++u) {
        const float column = static_cast<float>(u);
        const float value = 0.25f * (up[u - 1] + up[u] + down[u - 1] + down[u]);
        const float qz = first_z + mz * column + tz * value;
        const float inverse = 1 / (qz > 0 ? qz : std::numeric_limits<float>::quiet_NaN());
        x[u] = (first_x + mx * column + tx * value) * inverse;
        y[u] = (first_y + my * column + ty * value) * inverse;
        w[u] = value * inverse;
    }
}

/// The inverse depth of a reading's footprint at its corner (du, dv), each -1 or 1: what the readings around
/// the corner that lie on its surface say there. The same for all of them.
float Footprints::corner_value(int u, int v, int du, int dv) const {
    float sum = 0;
    int count = 0;
    // Half a step from each reading towards the corner.
    const auto add = [&](int at_u, int at_v, int toward_u, int toward_v) {
        sum += depth_.value(at_u, at_v) + 0.5f * static_cast<float>(toward_u) * depth_.along_u(at_u, at_v) +
               0.5f * static_cast<float>(toward_v) * depth_.along_v(at_u, at_v);
        ++count;
    };
    const bool beside = joined_u(u, v, du), over = joined_v(u, v, dv);
    add(u, v, du, dv);
    if (beside) add(u + du, v, -du, dv);
    if (over) add(u, v + dv, du, -dv);
    if ((beside && joined_v(u + du, v, dv)) || (over && joined_u(u, v + dv, du)))
        add(u + du, v + dv, -du, -dv);
    const float here = depth_.value(u, v);
    return std::clamp(sum / static_cast<float>(count), 0.5f * here, 2 * here);
}

ColorPoint Footprints::corner(int u, int v, int du, int dv) const {
    const float w = corner_value(u, v, du, dv);
    const Eigen::Vector3f q = direction(static_cast<float>(u - border_) + 0.5f * static_cast<float>(du),
                                        static_cast<float>(v - border_) + 0.5f * static_cast<float>(dv)) +
                              t_ * w;
    const float inverse = 1 / (q.z() > 0 ? q.z() : std::numeric_limits<float>::quiet_NaN());
    return {q.x() * inverse, q.y() * inverse, w * inverse};
}

void Footprints::fill_row(int v, const Shared& above, const Shared& below) {
    const float* values = depth_.value.row(v);
    for (int u = border_; u < depth_.value.width - border_; ++u) {
        if (!(values[u] > 0)) continue;
        const auto i = static_cast<std::size_t>(u);
        fill_quad({above.full[i] ? above.at(u) : corner(u, v, -1, -1),
                   above.full[i + 1] ? above.at(u + 1) : corner(u, v, 1, -1),
                   below.full[i + 1] ? below.at(u + 1) : corner(u, v, 1, 1),
                   below.full[i] ? below.at(u) : corner(u, v, -1, 1)});
    }
}

void Footprints::put(int x, int y, float w) {
    const float z = units_ / w;
    if (!(z >= 0.5f && z < 65534.5f)) return;
    const auto raw = nearest_whole<std::uint16_t>(z);
    std::uint16_t& target = out_(x, y);
    // A reading of 0, none, wraps to the farthest of all.
    if (static_cast<std::uint16_t>(target - 1) >= raw) target = raw;
}

void Footprints::fill_quad(const std::array<ColorPoint, 4>& c) {
    const float low_x = std::min(std::min(c[0].x, c[1].x), std::min(c[2].x, c[3].x));
    const float high_x = std::max(std::max(c[0].x, c[1].x), std::max(c[2].x, c[3].x));
    const float low_y = std::min(std::min(c[0].y, c[1].y), std::min(c[2].y, c[3].y));
    const float high_y = std::max(std::max(c[0].y, c[1].y), std::max(c[2].y, c[3].y));
    if (!(high_x >= 0 && high_y >= 0 && low_x <= last_x_ && low_y <= last_y_)) return;
    // The diagonals give the plane of inverse depth, and the side that the colour camera sees.
    const float ax = c[2].x - c[0].x, ay = c[2].y - c[0].y, bx = c[3].x - c[1].x, by = c[3].y - c[1].y;
    const float area2 = ax * by - ay * bx;
    if (!(area2 > 0)) return;  // seen from behind, or a corner is behind the camera
    const float x0 = 0.25f * (c[0].x + c[1].x + c[2].x + c[3].x),
                y0 = 0.25f * (c[0].y + c[1].y + c[2].y + c[3].y);
    const float w0 = 0.25f * (c[0].w + c[1].w + c[2].w + c[3].w);
    if (high_x - low_x > longest_ || high_y - low_y > longest_) {
        if (x0 >= 0 && y0 >= 0 && x0 <= last_x_ && y0 <= last_y_)
            put(nearest_whole<int>(x0), nearest_whole<int>(y0), w0);
        return;
    }
    const float aw = (c[2].w - c[0].w) / area2, bw = (c[3].w - c[1].w) / area2;
    const float w_x = aw * by - bw * ay, w_y = bw * ax - aw * bx;
    std::array<float, 4> per_dy, dx;
    for (std::size_t i = 0; i < 4; ++i) {
        const ColorPoint& next = c[(i + 1) % 4];
        const float dy = next.y - c[i].y;
        per_dy[i] = 1 / (dy != 0 ? dy : 1e-20f);
        dx[i] = next.x - c[i].x;
    }
    const int from_y = static_cast<int>(std::ceil(std::max(low_y, 0.0f))),
              to_y = static_cast<int>(std::min(high_y, last_y_));
    for (int y = from_y; y <= to_y; ++y) {
        // An edge that goes down bounds the row at the right, one that goes up at the left. A pixel centre on
        // the edge between two footprints is in both.
        constexpr float kOnEdge = 1e-3f;
        const auto py = static_cast<float>(y);
        float left = std::max(low_x, 0.0f), right = std::min(high_x, last_x_);
        for (std::size_t i = 0; i < 4; ++i) {
            const float bound = c[i].x + (dx[i] * (py - c[i].y) + kOnEdge) * per_dy[i];
            left = per_dy[i] < 0 ? std::max(left, bound) : left;
            right = per_dy[i] > 0 ? std::min(right, bound) : right;
        }
        if (!(left <= right)) continue;
        const float row_w = w0 + w_y * (py - y0) - w_x * x0;
        for (int x = static_cast<int>(std::ceil(left)); x <= static_cast<int>(right); ++x)
            put(x, y, row_w + w_x * static_cast<float>(x));
    }
}

/// Part of a depth image: columns u0 to before u1, rows v0 to before v1.
struct Window {
    int u0, v0, u1, v1;
};

/// The part that the colour camera can see. A colour pixel sees points from infinity to the nearest reading,
/// which lie on a line of the depth image; all of them lie between those of the image's four corners.
Window seen_part(const DepthImage& depth, const CameraInfo& camera, const Reprojection& reprojection) {
    constexpr double kMargin = 4;  // slopes look two pixels around
    const Window all{0, 0, depth.width, depth.height};
    std::uint16_t nearest = 65535;
    for (const std::uint16_t raw : depth.pixels)
        nearest = std::min(nearest, static_cast<std::uint16_t>(raw == 0 ? 65535 : raw));
    Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
    for (const double w : {0.0, camera.depth_units_per_metre / nearest}) {
        Eigen::Matrix3d color_from_depth = reprojection.m;  // of pixels, at inverse depth w
        color_from_depth.col(2) += reprojection.t * w;
        const Eigen::Matrix3d back = color_from_depth.inverse();
        for (const double x : {-0.5, camera.color.width - 0.5}) {
            for (const double y : {-0.5, camera.color.height - 0.5}) {
                const Eigen::Vector3d p = back * Eigen::Vector3d(x, y, 1);
                if (!(p.z() > 1e-3 && p.allFinite())) return all;
                low = low.min(p.head<2>().array() / p.z());
                high = high.max(p.head<2>().array() / p.z());
            }
        }
    }
    const auto within = [](double value, int size) {
        return static_cast<int>(std::clamp(value, 0.0, double(size)));
    };
    const Window seen{within(low.x() - kMargin, depth.width), within(low.y() - kMargin, depth.height),
                      within(high.x() + kMargin + 1, depth.width),
                      within(high.y() + kMargin + 1, depth.height)};
    return seen.u0 < seen.u1 && seen.v0 < seen.v1 ? seen : all;
}

DepthImage cut(const DepthImage& depth, const Window& window) {
    DepthImage part(window.u1 - window.u0, window.v1 - window.v0);
    for (int v = 0; v < part.height; ++v)
        std::copy_n(depth.row(v + window.v0) + window.u0, part.width, part.row(v));
    return part;
}

}  // namespace

void fill_footprints(const DepthImage& depth, const CameraInfo& camera, const Reprojection& reprojection,
                     DepthImage& registered) {
    const Window window = seen_part(depth, camera, reprojection);
    Reprojection of_part = reprojection;
    of_part.m.col(2) += reprojection.m.col(0) * window.u0 + reprojection.m.col(1) * window.v0;
    Footprints(cut(depth, window), camera, of_part, registered).fill();
}

}  // namespace planemap
