// SPDX-License-Identifier: BSD-3-Clause
// A scene of flat pieces as a depth camera and a colour camera of another resolution see it, for tests of
// registration.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/plane.hpp"
#include "core/image.hpp"
#include "core/random_values.hpp"

namespace planemap::test {

/// A rectangle in the depth camera's frame, cut from a plane by limits of x and y.
struct Piece {
    Plane plane;
    Eigen::Vector2d low{-100, -100}, high{100, 100};
};

struct Hit {
    int piece = -1;  ///< -1: none
    double z = 0;    ///< in the depth camera's frame
};

class Scene {
  public:
    explicit Scene(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {}

    static Scene of(const Plane& plane) { return Scene(std::vector<Piece>{{plane}}); }

    /// A wall that slants, a floor, a box's front and a post before them.
    static Scene room(double slant) {
        const Eigen::Vector3d n = Eigen::Vector3d(std::sin(slant), 0, -std::cos(slant));
        return Scene({{{n, -n.dot(Eigen::Vector3d(0, 0, 2.6))}},
                      {{{0, -1, 0}, 0.7}},
                      {{{0, 0, -1}, 1.3}, {-0.5, -0.2}, {0.1, 0.7}},
                      {{{0, 0, -1}, 1.0}, {0.3, -0.6}, {0.36, 0.7}}});
    }

    /// The nearest piece along a ray; `from` in the depth camera's frame.
    Hit look(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) const {
        Hit nearest;
        double best = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            const Piece& piece = pieces_[i];
            const double along = piece.plane.normal.dot(ray);
            if (!(along < 0)) continue;
            const double s = -piece.plane.signed_distance(from) / along;
            const Eigen::Vector3d p = from + s * ray;
            const bool inside = (p.head<2>().array() >= piece.low.array()).all() &&
                                (p.head<2>().array() <= piece.high.array()).all();
            if (s > 0 && s < best && inside) best = s, nearest = {static_cast<int>(i), p.z()};
        }
        return nearest;
    }
    const Plane& plane(int piece) const { return pieces_[static_cast<std::size_t>(piece)].plane; }

  private:
    std::vector<Piece> pieces_;
};

/// A depth camera and a colour camera whose focal lengths are 1 / ratio times the depth camera's.
inline CameraInfo two_cameras(double ratio_x, double ratio_y, Random& random, double baseline = 0.03,
                              double turn = 0.02) {
    CameraInfo info;
    info.registered = false;
    info.depth = {200, 150, 180, 182, 101.3, 73.2};
    const double fx = info.depth.fx / ratio_x, fy = info.depth.fy / ratio_y;
    info.color = {std::max(20, static_cast<int>(170 / ratio_x)),
                  std::max(20, static_cast<int>(150 / ratio_y)),
                  fx,
                  fy,
                  0,
                  0};
    info.color.cx = 0.5 * (info.color.width - 1) + random.uniform(-2, 2);
    info.color.cy = 0.5 * (info.color.height - 1) + random.uniform(-2, 2);
    info.depth_units_per_metre = 5000;
    Twist twist;
    twist << random.uniform(0.5, 1) * baseline, random.uniform(-0.3, 0.3) * baseline,
        random.uniform(-0.2, 0.2) * baseline, random.vector(turn);
    info.color_from_depth = pose_from_twist(twist);
    return info;
}

struct Sensed {
    DepthImage depth;
    Image<std::int8_t> piece;  ///< -1: no reading
};

/// What the depth camera reads, with `noise` times its noise.
inline Sensed sense(const Scene& scene, const CameraInfo& info, double noise, Random& random) {
    Sensed sensed{DepthImage(info.depth.width, info.depth.height), {info.depth.width, info.depth.height, -1}};
    for (int v = 0; v < info.depth.height; ++v) {
        for (int u = 0; u < info.depth.width; ++u) {
            const Hit hit = scene.look(Eigen::Vector3d::Zero(), info.depth.unproject(u, v, 1));
            if (hit.piece < 0 || hit.z > info.depth_max_m) continue;
            const double z = hit.z + random.normal(noise * info.noise.sigma(hit.z));
            sensed.depth(u, v) = static_cast<std::uint16_t>(std::lround(z * info.depth_units_per_metre));
            sensed.piece(u, v) = static_cast<std::int8_t>(hit.piece);
        }
    }
    return sensed;
}

/// Which piece each pixel of the colour camera sees; -1: none.
inline Image<std::int8_t> pieces_in_color(const Scene& scene, const CameraInfo& info) {
    const Pose depth_from_color = info.color_from_depth.inverse();
    Image<std::int8_t> pieces(info.color.width, info.color.height, -1);
    for (int y = 0; y < pieces.height; ++y) {
        for (int x = 0; x < pieces.width; ++x) {
            const Eigen::Vector3d ray = depth_from_color.linear() * info.color.unproject(x, y, 1);
            pieces(x, y) = static_cast<std::int8_t>(scene.look(depth_from_color.translation(), ray).piece);
        }
    }
    return pieces;
}

/// How a registered image compares with the scene.
struct Registered {
    int inside = 0;  ///< colour pixels that see the inside of a surface which the depth camera sees there too
    int holes = 0;   ///< of these, without depth
    int beyond = 0;  ///< filled pixels without a reading of such a depth within one footprint
    int wrong = 0;   ///< pixels inside whose depth is more than 5 sigma off
    double rms = 0;  ///< of the depth inside, in sigmas of a reading
    double mean = 0;  ///< in sigmas: negative is too near
};

/// What of a registered image agrees with the scene, pixel by pixel.
class Comparison {
  public:
    Comparison(const Scene& scene, const CameraInfo& info, const Sensed& sensed)
        : scene_(scene),
          info_(info),
          sensed_(sensed),
          depth_from_color_(info.color_from_depth.inverse()),
          reach_u_(1.01 + 0.51 * info.depth.fx / info.color.fx),
          reach_v_(1.01 + 0.51 * info.depth.fy / info.color.fy),
          pieces_(pieces_in_color(scene, info)) {}

    /// Takes the pixel at x, y with the depth z that the image has there, metres; 0: none.
    void add(int x, int y, double z) {
        const Eigen::Vector3d ray = info_.color.unproject(x, y, 1);
        if (pieces_(x, y) >= 0 && is_alone(x, y)) add_inside(pieces_(x, y), ray, z);
        if (z > 0) result_.beyond += !has_reading(depth_from_color_ * (z * ray).eval());
    }
    Registered result() const {
        Registered result = result_;
        const int filled = std::max(1, result.inside - result.holes);
        result.rms = std::sqrt(squares_ / filled);
        result.mean = sum_ / filled;
        return result;
    }

  private:
    /// Of the readings around a pixel of the depth image, how many `holds` is true of, and whether of all.
    template <typename Holds>
    std::pair<int, bool> around(const Eigen::Vector2d& pixel, const Holds& holds) const {
        int count = 0;
        bool all = true;
        for (int v = static_cast<int>(std::ceil(pixel.y() - reach_v_)); v <= pixel.y() + reach_v_; ++v) {
            for (int u = static_cast<int>(std::ceil(pixel.x() - reach_u_)); u <= pixel.x() + reach_u_; ++u) {
                if (sensed_.piece.contains(u, v) && holds(u, v))
                    ++count;
                else
                    all = false;
            }
        }
        return {count, all};
    }
    /// The pixel and all within a footprint of it see one surface.
    bool is_alone(int x, int y) const {
        const int near_x = static_cast<int>(std::ceil(info_.color.fx / info_.depth.fx)) + 1;
        const int near_y = static_cast<int>(std::ceil(info_.color.fy / info_.depth.fy)) + 1;
        for (int j = y - near_y; j <= y + near_y; ++j) {
            for (int i = x - near_x; i <= x + near_x; ++i)
                if (pieces_.contains(i, j) && pieces_(i, j) != pieces_(x, y)) return false;
        }
        return true;
    }
    /// A pixel that sees the inside of a surface, if the depth camera sees that there too.
    void add_inside(int piece, const Eigen::Vector3d& ray, double z) {
        const Plane& plane = scene_.plane(piece);
        const double s = -plane.signed_distance(depth_from_color_.translation()) /
                         plane.normal.dot(depth_from_color_.linear() * ray);
        const Eigen::Vector2d seen = info_.depth.project(depth_from_color_ * (s * ray).eval());
        if (!around(seen, [&](int u, int v) { return sensed_.piece(u, v) == piece; }).second) return;
        ++result_.inside;
        if (z <= 0) {
            ++result_.holes;
            return;
        }
        const double off = (z - s) / (info_.noise.sigma(s) + 1 / info_.depth_units_per_metre);
        result_.wrong += std::abs(off) > 5;
        squares_ += off * off;
        sum_ += off;
    }
    /// Whether the depth camera has a reading of such a depth around a point of its frame: within the noise,
    /// and what its surface changes by over the footprint.
    bool has_reading(const Eigen::Vector3d& p) const {
        const auto is_such = [&](int u, int v) {
            if (sensed_.piece(u, v) < 0) return false;
            const Hit there = scene_.look(Eigen::Vector3d::Zero(), info_.depth.unproject(u, v, 1));
            const Plane& plane = scene_.plane(there.piece);
            const Eigen::Vector2d pixel = info_.depth.project(p);
            const Eigen::Vector3d towards = info_.depth.unproject(pixel.x(), pixel.y(), 1);
            const double on_plane = -plane.d / plane.normal.dot(towards);
            return std::abs(p.z() - on_plane) <= 6 * info_.noise.sigma(p.z()) + 0.002;
        };
        return around(info_.depth.project(p), is_such).first > 0;
    }

    const Scene& scene_;
    const CameraInfo& info_;
    const Sensed& sensed_;
    Pose depth_from_color_;
    double reach_u_, reach_v_;  ///< of a pixel's footprint in the depth image, pixels
    Image<std::int8_t> pieces_;
    Registered result_;
    double squares_ = 0, sum_ = 0;
};

inline Registered compare(const Scene& scene, const CameraInfo& info, const Sensed& sensed,
                          const DepthImage& registered) {
    Comparison comparison(scene, info, sensed);
    for (int y = 0; y < registered.height; ++y)
        for (int x = 0; x < registered.width; ++x) comparison.add(x, y, info.metres(registered(x, y)));
    return comparison.result();
}

}  // namespace planemap::test
