// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/region.hpp"
#include "map/evidence_grid.hpp"

namespace planemap::map {

/// Which way regions lie, seen from the camera: a coarse image of them, to tell what is seen past.
class Sight {
  public:
    static constexpr int kWidth = 32, kHeight = 24;  ///< cells
    static constexpr std::uint8_t kNone = 255;

    /// From the outlines of the regions, camera frame; the first 255 count. A cell holds a region that covers
    /// all of it, the nearest where several do.
    explicit Sight(const std::vector<PlanarRegion>& regions);
    Sight() = default;

    /// The region that fills the cell a point is seen in, or kNone. Camera frame.
    std::uint8_t region_at(const Eigen::Vector3d& p_camera) const {
        if (!(p_camera.z() > 0.05)) return kNone;
        const double x = (p_camera.x() / p_camera.z() - low_.x()) * per_cell_.x();
        const double y = (p_camera.y() / p_camera.z() - low_.y()) * per_cell_.y();
        if (!(x >= 0 && y >= 0 && x < kWidth && y < kHeight)) return kNone;
        return cells_[cell_at(static_cast<int>(x), static_cast<int>(y))];
    }
    /// The directions it covers: x / z and y / z in the camera.
    const Eigen::Vector2d& low() const { return low_; }
    Eigen::Vector2d high() const {
        return low_ + Eigen::Vector2d(kWidth / per_cell_.x(), kHeight / per_cell_.y());
    }

    /// Distance from the camera to the farthest of it, metres.
    double reach() const { return reach_; }

  private:
    static constexpr std::size_t kCells = std::size_t{kWidth} * kHeight;
    static std::size_t cell_at(int x, int y) {
        return static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
    }

    using Directions = std::vector<FlatPolygon>;  ///< outlines as x / z and y / z
    Directions directions_of(const std::vector<PlanarRegion>& regions);
    void fill(std::uint8_t region, const Plane& plane, const FlatPolygon& directions,
              std::array<double, kCells>& nearest);

    double reach_ = 0;
    Eigen::Vector2d low_ = Eigen::Vector2d::Zero(), per_cell_ = Eigen::Vector2d::Ones();
    std::array<std::uint8_t, kCells> cells_ = [] {
        std::array<std::uint8_t, kCells> none{};
        none.fill(kNone);
        return none;
    }();
};

}  // namespace planemap::map
