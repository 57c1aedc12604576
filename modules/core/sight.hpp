// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/flat_polygon.hpp"
#include "core/geometry/plane.hpp"
#include "core/region.hpp"

namespace planemap {

/// Which way regions lie, seen from the camera: a coarse image of them, to tell what is seen past.
class Sight {
  public:
    static constexpr int kWidth = 32, kHeight = 24;  ///< cells
    static constexpr std::uint8_t kNone = 255;

    /// From the outlines of the regions, camera frame; the first 255 count. A cell of which regions cover all
    /// four corners holds the nearest of these: nothing there is nearer.
    explicit Sight(const std::vector<PlanarRegion>& regions);
    Sight() = default;

    /// The region that is seen, or what is nearest, in the cell of a point, or kNone. Camera frame.
    std::uint8_t region_at(const Eigen::Vector3d& p_camera) const {
        if (!(p_camera.z() > 0.05)) return kNone;
        const double x = (p_camera.x() / p_camera.z() - low_.x()) * per_cell_.x();
        const double y = (p_camera.y() / p_camera.z() - low_.y()) * per_cell_.y();
        if (!(x >= 0 && y >= 0 && x < kWidth && y < kHeight)) return kNone;
        return cells_[cell_at(static_cast<int>(x), static_cast<int>(y))];
    }
    /// The region that fills a cell as a whole, or kNone, and the direction of its middle, z = 1.
    std::uint8_t region_in(int x, int y) const {
        return whole_[cell_at(x, y)] ? cells_[cell_at(x, y)] : kNone;
    }
    Eigen::Vector3d direction_of(int x, int y) const {
        return {low_.x() + (x + 0.5) / per_cell_.x(), low_.y() + (y + 0.5) / per_cell_.y(), 1};
    }
    /// The directions it covers: x / z and y / z in the camera.
    const Eigen::Vector2d& low() const { return low_; }
    Eigen::Vector2d high() const {
        return low_ + Eigen::Vector2d(kWidth / per_cell_.x(), kHeight / per_cell_.y());
    }

    /// False for a ball (camera frame) that is behind the camera or beside what it covers.
    bool may_hold(const Eigen::Vector3d& center_camera, double radius) const;

    /// Distance from the camera to the farthest of it, metres.
    double reach() const { return reach_; }

  private:
    static constexpr std::size_t kCells = std::size_t{kWidth} * kHeight;
    static std::size_t cell_at(int x, int y) {
        return static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
    }

    using Directions = std::vector<FlatPolygon>;  ///< outlines as x / z and y / z
    Directions directions_of(const std::vector<PlanarRegion>& regions);
    struct Filling;
    void fill(std::uint8_t region, const Plane& plane, const FlatPolygon& directions, Filling& filling);

    double reach_ = 0;
    Eigen::Vector2d low_ = Eigen::Vector2d::Zero(), per_cell_ = Eigen::Vector2d::Ones();
    std::array<std::uint8_t, kCells> cells_ = [] {
        std::array<std::uint8_t, kCells> none{};
        none.fill(kNone);
        return none;
    }();
    std::bitset<kCells> whole_;  ///< one region covers the cell
};

/// When a camera sees past a point: what it sees there lies farther by more than poses and depth err.
struct PastRules {
    double margin_m = 0.05;  ///< of poses, across the surface
    double sigmas = 2;       ///< of the sensor's noise
    double range_bias = kRangeBias;
    double grazing = 0.12;  ///< sine to a surface: flatter rays say nothing of it

    /// Whether what is seen at a depth lies behind a point of a surface; nothing where the ray is too flat.
    std::optional<bool> is_past(const Eigen::Vector3d& p_camera, const Eigen::Vector3d& normal_camera,
                                double seen_depth, const DepthNoise& noise) const {
        const double sine = std::abs(normal_camera.dot(p_camera)) / p_camera.norm();
        if (sine < grazing) return std::nullopt;
        const double error = sigmas * noise.sigma(seen_depth) + range_bias * seen_depth;
        return (seen_depth - p_camera.z() - error) * sine > margin_m;
    }
};

/// What one depth frame saw, camera frame. It refers to both.
struct SeenRegions {
    const Sight& sight;
    std::span<const Plane> planes;  ///< of the regions

    /// Depth of the region that is seen where the point is, along the ray through it.
    std::optional<double> depth_behind(const Eigen::Vector3d& p_camera) const {
        const std::uint8_t region = sight.region_at(p_camera);
        if (region == Sight::kNone) return std::nullopt;
        const Plane& plane = planes[region];
        return -plane.d / plane.normal.dot(p_camera) * p_camera.z();
    }
};

/// Cells of what `one` saw that `other` sees past.
int count_seen_past(const SeenRegions& one, const SeenRegions& other, const Pose& other_from_one,
                    const PastRules& rules, const DepthNoise& noise);

/// Whether something came or went between two frames: one of them sees past what the other saw, in three
/// cells or more.
bool has_changed(const SeenRegions& one, const SeenRegions& other, const Pose& other_from_one,
                 const DepthNoise& noise);

}  // namespace planemap
