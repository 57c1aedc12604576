// SPDX-License-Identifier: BSD-3-Clause
#include "bench_segmentation/local_normals.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::bench {

namespace {

constexpr int kReach = 8;  // the window is 2 kReach + 1 pixels wide
constexpr double kLeastReadings = 145;
constexpr double kSigmas = 2;

/// Sums over the readings of one column within the window's rows; w = 1/z, v = row.
struct Column {
    double n = 0, v = 0, vv = 0, w = 0, vw = 0, ww = 0;

    void add(double row, double inverse_depth, double sign) {
        n += sign;
        v += sign * row;
        vv += sign * row * row;
        w += sign * inverse_depth;
        vw += sign * row * inverse_depth;
        ww += sign * inverse_depth * inverse_depth;
    }
};

/// Sums over the readings of a window; u = column.
struct Window {
    double n = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0, w = 0, uw = 0, vw = 0, ww = 0;

    void add(const Column& c, double column, double sign) {
        n += sign * c.n;
        u += sign * column * c.n;
        v += sign * c.v;
        uu += sign * column * column * c.n;
        uv += sign * column * c.v;
        vv += sign * c.vv;
        w += sign * c.w;
        uw += sign * column * c.w;
        vw += sign * c.vw;
        ww += sign * c.ww;
    }

    /// The normal of the plane 1/z = a u + b v + c through the readings, or zero, see local_normals().
    Eigen::Vector3f normal(const PinholeCamera& camera) const {
        if (n < kLeastReadings) return Eigen::Vector3f::Zero();
        const double mu = u / n, mv = v / n, mw = w / n;
        const double suu = uu - n * mu * mu, suv = uv - n * mu * mv, svv = vv - n * mv * mv;
        const double suw = uw - n * mu * mw, svw = vw - n * mv * mw, sww = ww - n * mw * mw;
        const double determinant = suu * svv - suv * suv;
        if (!(determinant > 1e-3 * n * n)) return Eigen::Vector3f::Zero();
        const double a = (suw * svv - svw * suv) / determinant, b = (svw * suu - suw * suv) / determinant;
        const double z = 1 / mw;
        const double rms = z * z * std::sqrt(std::max(0.0, sww - a * suw - b * svw) / n);
        if (rms > kSigmas * DepthNoise{}.sigma(z)) return Eigen::Vector3f::Zero();
        const double at_axis = mw + a * (camera.cx - mu) + b * (camera.cy - mv);
        return -Eigen::Vector3d(a * camera.fx, b * camera.fy, at_axis).normalized().cast<float>();
    }
};

/// Adds the trusted readings of a row to the columns, or takes them off; rows beyond the image have none.
void add_row(const Image<float>& inverse_depth, int row, double sign, std::vector<Column>& columns) {
    if (row < 0 || row >= inverse_depth.height) return;
    const float* w = inverse_depth.row(row);
    for (std::size_t u = 0; u < columns.size(); ++u) {
        if (w[u] > 0) columns[u].add(row, w[u], sign);
    }
}

}  // namespace

Image<Eigen::Vector3f> local_normals(const DepthImage& depth, const CameraInfo& camera) {
    Image<float> inverse_depth(depth.width, depth.height);
    for_each_reading(depth, camera,
                     [&](int u, int v, double z) { inverse_depth(u, v) = static_cast<float>(1 / z); });
    Image<Eigen::Vector3f> normals(depth.width, depth.height, Eigen::Vector3f::Zero());
    std::vector<Column> columns(static_cast<std::size_t>(depth.width));
    for (int v = 0; v < kReach; ++v) add_row(inverse_depth, v, 1, columns);
    for (int v = 0; v < depth.height; ++v) {
        add_row(inverse_depth, v + kReach, 1, columns);
        add_row(inverse_depth, v - kReach - 1, -1, columns);
        Window window;
        const auto add_column = [&](int u, double sign) {
            if (u >= 0 && u < depth.width) window.add(columns[static_cast<std::size_t>(u)], u, sign);
        };
        for (int u = 0; u < kReach; ++u) add_column(u, 1);
        for (int u = 0; u < depth.width; ++u) {
            add_column(u + kReach, 1);
            add_column(u - kReach - 1, -1);
            if (inverse_depth(u, v) > 0) normals(u, v) = window.normal(camera.depth);
        }
    }
    return normals;
}

}  // namespace planemap::bench
