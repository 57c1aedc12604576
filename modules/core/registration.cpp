// SPDX-License-Identifier: BSD-3-Clause
#include "core/registration.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "core/footprints.hpp"
#include "core/inverse_depth.hpp"
#include "core/registration_kernels.hpp"
#include "core/reprojection.hpp"

namespace planemap {

namespace {

constexpr double kAsFine = 1.02;   // longest step of a reading, colour pixels, that leaves no pixel out
constexpr double kUpright = 0.05;  // and the furthest that it may go sideways
constexpr double kAnyTurn = 0.7;   // a step this short leaves no pixel out however the images are turned
constexpr double kMany = 1.5;      // readings a colour pixel that are averaged
constexpr float kSameSigmas = 5;   // of inverse depth, between readings of one surface

/// Where the readings of one row land on the colour image.
struct Row {
    std::vector<float> x, y, z;  ///< see LandedRow

    explicit Row(int width) : x(static_cast<std::size_t>(width)), y(x), z(x) {}
    LandedRow landed() { return {x.data(), y.data(), z.data()}; }
};

/// Carries readings to single colour pixels: right where a footprint is no larger than a pixel.
class Splat {
  public:
    Splat(const DepthImage& depth, const CameraInfo& camera, const Reprojection& reprojection)
        : depth_(depth),
          width_(camera.color.width),
          height_(camera.color.height),
          m_(reprojection.m.cast<float>()),
          t_((reprojection.t * camera.depth_units_per_metre).cast<float>()) {}

    void project(int v, Row& row) const {
        const Eigen::Vector3f along = m_.col(0), base = m_.col(1) * static_cast<float>(v) + m_.col(2);
        kernels_.project({depth_.row(v),
                          depth_.width,
                          {along.x(), along.y(), along.z()},
                          {base.x(), base.y(), base.z()},
                          {t_.x(), t_.y(), t_.z()},
                          static_cast<float>(width_),
                          static_cast<float>(height_)},
                         row.landed());
    }
    /// For each reading of a projected row its pixel and its depth; 0 where it landed nowhere.
    void address(Row& row, std::vector<int>& index, std::vector<std::uint16_t>& depth) const {
        kernels_.address(row.landed(), depth_.width, width_, index.data(), depth.data());
    }

  private:
    const RegistrationKernels& kernels_ = best_registration_kernels();
    const DepthImage& depth_;
    int width_, height_;
    Eigen::Matrix3f m_;
    Eigen::Vector3f t_;  ///< raw units
};

void take_nearest(const Splat& splat, const DepthImage& depth, DepthImage& registered) {
    Row row(depth.width);
    std::vector<int> index(row.x.size());
    std::vector<std::uint16_t> value(row.x.size());
    std::uint16_t* const pixels = registered.pixels.data();
    for (int v = 0; v < depth.height; ++v) {
        splat.project(v, row);
        splat.address(row, index, value);
        for (std::size_t u = 0; u < index.size(); ++u) {
            // Without a branch: no reading, 0, wraps to the farthest of all, and where the nearer is what was
            // there, that is stored again.
            std::uint16_t& target = pixels[index[u]];
            const auto before = static_cast<std::uint16_t>(target - 1),
                       now = static_cast<std::uint16_t>(value[u] - 1);
            target = static_cast<std::uint16_t>(std::min(before, now) + 1);
        }
    }
}

/// The mean of the readings that land in a pixel and lie on the nearest surface there. Each says what its
/// surface's depth is at the pixel's centre, so that a slope inside a pixel is not taken for two surfaces.
class MeanOfNearest {
  public:
    MeanOfNearest(const DepthImage& depth, const CameraInfo& camera, const Reprojection& reprojection,
                  const Eigen::Matrix2d& steps)
        : splat_(depth, camera, reprojection),
          noise_(camera),
          units_(static_cast<float>(camera.depth_units_per_metre)),
          // Over a colour pixel: what is smaller is averaged away in any case.
          slopes_(depth, camera.depth_units_per_metre, std::max(1, readings_a_pixel(steps))),
          depth_from_color_(steps.inverse().cast<float>()),
          width_(depth.width),
          height_(depth.height),
          index_(depth.pixels.size(), -1),
          value_(depth.pixels.size()) {}

    void take(DepthImage& registered) {
        std::vector<float> nearest(registered.pixels.size(), 0);
        Row row(width_);
        for (int v = 0; v < height_; ++v) {
            splat_.project(v, row);
            land(v, row, registered.width);
            for (std::size_t i = first_of(v); i < first_of(v + 1); ++i) {
                if (index_[i] < 0) continue;
                float& w = nearest[static_cast<std::size_t>(index_[i])];
                w = std::max(w, value_[i]);
            }
        }
        std::vector<float> sum(nearest.size(), 0), count(nearest.size(), 0);
        for (float& w : nearest) w -= kSameSigmas * noise_.sigma(w);
        for (std::size_t i = 0; i < index_.size(); ++i) {
            if (index_[i] < 0) continue;
            const auto pixel = static_cast<std::size_t>(index_[i]);
            if (value_[i] < nearest[pixel]) continue;
            sum[pixel] += value_[i];
            count[pixel] += 1;
        }
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const float z = units_ * count[i] / std::max(sum[i], 1e-30f) + 0.5f;
            registered.pixels[i] =
                static_cast<std::uint16_t>(count[i] > 0 ? std::clamp(z, 1.0f, 65534.0f) : 0);
        }
    }

  private:
    static int readings_a_pixel(const Eigen::Matrix2d& steps) {
        return static_cast<int>(std::lround(1 / std::max(steps.col(0).norm(), steps.col(1).norm())));
    }
    std::size_t first_of(int v) const {
        return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_);
    }
    void land(int v, const Row& row, int color_width);

    Splat splat_;
    InverseDepthNoise noise_;
    float units_;
    InverseDepth slopes_;
    Eigen::Matrix2f depth_from_color_;  ///< steps of pixels
    int width_, height_;
    std::vector<int> index_;    ///< colour pixel of each reading, or -1
    std::vector<float> value_;  ///< inverse depth at the pixel's centre, 1/metres
};

void MeanOfNearest::land(int v, const Row& row, int color_width) {
    const int border = slopes_.border;
    const float *const x = row.x.data(), *const y = row.y.data(), *const z = row.z.data();
    const float *const w = slopes_.value.row(v + border) + border,
                       *const along_u = slopes_.along_u.row(v + border) + border,
                       *const along_v = slopes_.along_v.row(v + border) + border;
    int* const index = index_.data() + first_of(v);
    float* const value = value_.data() + first_of(v);
    const float xx = depth_from_color_(0, 0), xy = depth_from_color_(0, 1), yx = depth_from_color_(1, 0),
                yy = depth_from_color_(1, 1), units = units_;
    for (int u = 0; u < width_; ++u) {
        const bool lands = z[u] > 0;
        const int column = static_cast<int>(lands ? x[u] : 0), line = static_cast<int>(lands ? y[u] : 0);
        const float dx = static_cast<float>(column) + 0.5f - x[u],
                    dy = static_cast<float>(line) + 0.5f - y[u];
        const float more = (along_u[u] * (xx * dx + xy * dy) + along_v[u] * (yx * dx + yy * dy)) / w[u];
        index[u] = lands ? line * color_width + column : -1;
        value[u] = units / z[u] * std::min(std::max(1 + more, 0.5f), 2.0f);
    }
}

/// Fills pixels that no reading landed on, or only one behind, although a reading's footprint holds their
/// centre: surfaces that the cameras' distance stretches crack between readings.
class Cracks {
  public:
    Cracks(const DepthImage& depth, const CameraInfo& camera, const Reprojection& reprojection)
        : depth_(depth),
          units_(static_cast<float>(camera.depth_units_per_metre)),
          noise_(camera),
          back_(reprojection.m.inverse().cast<float>()),
          z_row_(reprojection.m.row(2).transpose().cast<float>()),
          reprojection_t_(reprojection.t.cast<float>()) {}

    void fill(DepthImage& registered) {
        for (int y = 1; y + 1 < registered.height; ++y) {
            suspect(registered, y);
            for (const int x : suspects_) close(x, y, registered);
        }
    }

  private:
    struct Place {
        int u, v;
        float reading, in_color;  ///< inverse depth for either camera; 0: none
    };
    float inverse(std::uint16_t raw) const {
        return is_valid_depth(raw) ? units_ / static_cast<float>(raw) : 0;
    }
    std::optional<Place> seen_by(int x, int y, float w) const;
    void suspect(const DepthImage& registered, int y);
    void close(int x, int y, DepthImage& registered) const;

    const DepthImage& depth_;
    float units_;
    InverseDepthNoise noise_;
    Eigen::Matrix3f back_;
    Eigen::Vector3f z_row_, reprojection_t_;
    std::vector<std::uint8_t> marks_;
    std::vector<int> suspects_;
};

/// Pixels of a row that lie behind both neighbours beside them, or above and below, or have no depth.
void Cracks::suspect(const DepthImage& registered, int y) {
    const int width = registered.width, padded = (width + 7) / 8 * 8;
    marks_.assign(static_cast<std::size_t>(padded), 0);
    const std::uint16_t *here = registered.row(y), *above = registered.row(y - 1),
                        *below = registered.row(y + 1);
    std::uint8_t* const marks = marks_.data();
    for (int x = 1; x < width - 1; ++x) {
        const auto lacks = [&](std::uint16_t a, std::uint16_t b) {
            const int farther = std::max(a, b), depth = here[x] == 0 ? 1 << 20 : here[x];
            return (a != 0) & (b != 0) & (depth > farther + (farther >> 5));
        };
        marks[x] = static_cast<std::uint8_t>(lacks(here[x - 1], here[x + 1]) | lacks(above[x], below[x]));
    }
    suspects_.clear();
    for (int x = 0; x < padded; x += 8) {
        std::uint64_t any;
        std::memcpy(&any, marks + x, sizeof any);
        if (any == 0) continue;
        for (int i = x; i < x + 8; ++i)
            if (marks[i] != 0) suspects_.push_back(i);
    }
}

/// Looks for a reading that has the pixel in its footprint, from the depths of the pixels around it.
void Cracks::close(int x, int y, DepthImage& registered) const {
    const float here = inverse(registered(x, y));
    float nearest = 0;
    for (const auto& [i, j] : {std::pair(x - 1, y), {x + 1, y}, {x, y - 1}, {x, y + 1}}) {
        const float guess = inverse(registered(i, j));
        if (guess <= 0) continue;
        const std::optional<Place> place = seen_by(x, y, guess);
        if (!place || place->reading <= 0) continue;
        const std::optional<Place> again = seen_by(x, y, place->in_color);
        if (again && again->u == place->u && again->v == place->v)
            nearest = std::max(nearest, place->in_color);
    }
    if (nearest <= 0 || nearest < here + kSameSigmas * noise_.sigma(nearest)) return;
    registered(x, y) = static_cast<std::uint16_t>(std::clamp(units_ / nearest + 0.5f, 1.0f, 65534.0f));
}

/// The reading whose pixel a point at colour pixel (x, y) and inverse depth w falls on.
std::optional<Cracks::Place> Cracks::seen_by(int x, int y, float w) const {
    // From q = m p + t w_depth with q.z = w_depth / w: p is m^-1 ((x, y, 1) - t w) but for its length.
    const Eigen::Vector3f p =
        back_ * (Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), 1) - reprojection_t_ * w);
    const float u = p.x() / p.z() + 0.5f, v = p.y() / p.z() + 0.5f;
    if (!(p.z() > 0 && u >= 0 && v >= 0 && u < static_cast<float>(depth_.width) &&
          v < static_cast<float>(depth_.height)))
        return std::nullopt;
    Place place{static_cast<int>(u), static_cast<int>(v), 0, 0};
    place.reading = inverse(depth_(place.u, place.v));
    const float q_z =
        z_row_.dot(Eigen::Vector3f(static_cast<float>(place.u), static_cast<float>(place.v), 1)) +
        reprojection_t_.z() * place.reading;
    if (!(q_z > 0)) return std::nullopt;
    place.in_color = place.reading / q_z;
    return place;
}

}  // namespace

DepthImage register_depth(const DepthImage& depth, const CameraInfo& camera) {
    if (camera.registered && camera.depth == camera.color) return depth;
    DepthImage registered(camera.color.width, camera.color.height);
    const Reprojection reprojection(camera);
    const Eigen::Matrix2d steps = reprojection.steps(camera.color);
    const double longest = std::max(steps.col(0).norm(), steps.col(1).norm());
    const double sideways = std::max(std::abs(steps(1, 0)), std::abs(steps(0, 1)));
    if (longest > kAnyTurn && (longest > kAsFine || sideways > kUpright)) {
        fill_footprints(depth, camera, reprojection, registered);
        return registered;
    }
    if (std::abs(steps.determinant()) * kMany > 1)
        take_nearest(Splat(depth, camera, reprojection), depth, registered);
    else
        MeanOfNearest(depth, camera, reprojection, steps).take(registered);
    Cracks(depth, camera, reprojection).fill(registered);
    return registered;
}

}  // namespace planemap
