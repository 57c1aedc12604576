// SPDX-License-Identifier: BSD-3-Clause
// What the ways of measuring depth have in common; part of the sensor model.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"
#include "core/rounding.hpp"
#include "simulator/sensor_model.hpp"

namespace planemap::simulator {

/// Depth to units; 0 outside the range.
class RawScale {
  public:
    explicit RawScale(const DepthSensorOptions& options)
        : units_(static_cast<float>(options.units_per_metre)),
          min_(static_cast<float>(options.min_m)),
          max_(static_cast<float>(std::min(options.max_m, 65534 / options.units_per_metre))) {}
    std::uint16_t operator()(float z) const {
        return z >= min_ && z <= max_ ? nearest_whole<std::uint16_t>(z * units_) : std::uint16_t{0};
    }

  private:
    float units_, min_, max_;
};

/// What of a row the projector, or the other imager of a pair, does not reach: the light that would go there
/// ends on something nearer.
class Occlusion {
  public:
    Occlusion(const PinholeCamera& camera, double baseline_m)
        : width_(camera.width),
          disparity_at_1m_(static_cast<float>(camera.fx * baseline_m)),
          nearest_(2 * static_cast<std::size_t>(camera.width) + 2) {}

    /// Notes, per column of the projector (with a margin), the nearest surface of a row.
    void light_up(const float* inverse_depth) {
        std::fill(nearest_.begin(), nearest_.end(), 0.0f);
        for (int u = 0; u < width_; ++u) {
            const std::size_t column = column_of(u, inverse_depth[u]);
            nearest_[column] = std::max(nearest_[column], inverse_depth[u]);
            nearest_[column + 1] = std::max(nearest_[column + 1], inverse_depth[u]);
        }
    }
    bool hides(int u, float inverse) const {
        constexpr float kNearer = 1.04f, kMargin = 0.01f;
        return nearest_[column_of(u, inverse)] > kNearer * inverse + kMargin;
    }

  private:
    std::size_t column_of(int u, float inverse) const {
        const float x = static_cast<float>(u + width_) - disparity_at_1m_ * inverse;
        return static_cast<std::size_t>(std::clamp(x, 0.0f, static_cast<float>(2 * width_)));
    }

    int width_;
    float disparity_at_1m_;
    std::vector<float> nearest_;
};

/// Readings at grazing angles are lost, in patches.
class Grazing {
  public:
    Grazing(const World& world, const View& view, const DepthSensorOptions& options, std::uint64_t seed)
        : view_(view),
          seed_(seed),
          cos_from_(static_cast<float>(std::cos(radians(options.grazing_from_deg)))),
          cos_to_(static_cast<float>(std::cos(radians(options.grazing_to_deg)))) {
        const Pose camera_from_world = view.world_from_camera.inverse();
        for (const Rectangle& rectangle : world.rectangles) {
            const Plane plane =
                camera_from_world * world.surfaces[static_cast<std::size_t>(rectangle.surface)].plane;
            distance_of_.push_back(static_cast<float>(plane.d));
        }
    }

    /// `bits` are the pixel's random ones. What a mirror shows is not lost.
    bool loses(int u, int v, float inverse, std::uint64_t bits) const {
        const int rectangle = view_.rectangle(u, v);
        if (rectangle < 0) return false;
        const PinholeCamera& c = view_.camera;
        const float x = (static_cast<float>(u) - static_cast<float>(c.cx)) / static_cast<float>(c.fx);
        const float y = (static_cast<float>(v) - static_cast<float>(c.cy)) / static_cast<float>(c.fy);
        const float distance = distance_of_[static_cast<std::size_t>(rectangle)] * inverse;
        const float squared_length = x * x + y * y + 1;
        if (distance * distance >= cos_from_ * cos_from_ * squared_length) return false;
        const float cosine = distance / std::sqrt(squared_length);
        const float lost = (cos_from_ - cosine) / (cos_from_ - cos_to_);
        const double patch =
            uniform(mix(seed_ + 1, static_cast<std::uint64_t>(v / 4), static_cast<std::uint64_t>(u / 4)));
        return 0.5 * (patch + uniform(mix(bits))) < lost;
    }

  private:
    const View& view_;
    std::uint64_t seed_;
    float cos_from_, cos_to_;
    std::vector<float> distance_of_;  // from the camera to each rectangle's plane
};

/// Depth of a view by time of flight, stereo or lidar; see DepthSensorOptions::principle.
DepthImage sense_otherwise(const World& world, const View& view, const DepthSensorOptions& options,
                           const GaussianTable& gaussian, std::uint64_t seed);

}  // namespace planemap::simulator
