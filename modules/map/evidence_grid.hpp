// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/outline.hpp"
#include "core/pose.hpp"

namespace planemap {

/// How a plane's shape is read off its evidence.
struct OutlineOptions {
    int min_views = 1;          ///< cells seen in fewer keyframes' regions are not part of the shape
    double min_ring_m2 = 0.01;  ///< smaller parts and smaller holes are left out
    double tolerance_m = 0.03;  ///< no traced vertex is further than this from the simplified outline
};

/// Where a plane has been seen: a raster in the plane that counts, cell by cell, how many regions covered it.
/// The union of regions is exact up to the cell size however many there are, so it grows with the plane's
/// extent and not with the number of views. Cells are aligned to the origin of the grid's frame.
class EvidenceGrid {
  public:
    EvidenceGrid() = default;
    /// An empty grid; x and y of the frame lie in the plane, z is its normal.
    EvidenceGrid(const Pose& world_from_grid, double cell_m)
        : world_from_grid_(world_from_grid), cell_m_(cell_m) {}

    const Pose& world_from_grid() const { return world_from_grid_; }
    bool empty() const { return views_.empty(); }
    std::size_t cell_count() const { return views_.size(); }

    /// Counts one view of every cell whose centre lies inside the rings (even-odd rule; metres in the grid's
    /// x, y).
    void add(const Outline& outline_grid);
    /// Adds another grid's views, resampled to this one's cells.
    void add(const EvidenceGrid& other);

    /// Views of the cell that holds a point (metres in the grid's x, y).
    int views(const Eigen::Vector2d& p_grid) const;
    /// The shape, metres in the grid's x and y; its rings do not cross.
    Outline outline(const OutlineOptions& options) const;

  private:
    struct Cells {
        int x0, y0, x1, y1;  ///< half-open range of cells
    };

    /// The cells that can hold the points.
    Cells cells_around(std::span<const Eigen::Vector2d> points) const;
    void grow(const Cells& needed);
    std::uint8_t* row(int y) { return views_.data() + static_cast<std::ptrdiff_t>(y - y0_) * width_ - x0_; }

    Pose world_from_grid_ = Pose::Identity();
    double cell_m_ = 0.025;
    int x0_ = 0, y0_ = 0, width_ = 0, height_ = 0;  ///< cells stored
    std::vector<std::uint8_t> views_;               ///< row-major, saturating
};

/// True when two edges of the rings cross at inner points of both. Touching is not crossing.
bool rings_cross(const Outline& outline);

}  // namespace planemap
