// SPDX-License-Identifier: BSD-3-Clause
// From planar cells to planar regions of whole cells.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "segmentation/cell_kernels.hpp"
#include "segmentation/cells.hpp"
#include "segmentation/merging.hpp"
#include "segmentation/point_sums.hpp"

namespace planemap::segmentation {

/// A grid of cells, row-major. Refers to the cells.
struct CellMap {
    int columns = 0, rows = 0;
    double cell_x = 0;  ///< width of a cell in normalised coordinates
    DepthNoise noise;   ///< of the sensor
    std::span<const Cell> cells;
};

/// A region's plane as cells are held against it.
struct Target {
    float a, b, c, steepness, nx, ny, nz;

    explicit Target(const InverseDepthPlane& plane)
        : a(static_cast<float>(plane.a)),
          b(static_cast<float>(plane.b)),
          c(static_cast<float>(plane.c)),
          steepness(static_cast<float>(plane.steepness())),
          nx(a / steepness),
          ny(b / steepness),
          nz(c / steepness) {}

    bool accepts(const Cell& cell) const {
        const float offset = cell.w - (a * cell.x + b * cell.y + c);
        return std::abs(offset) <= cell.reach * steepness && cosine(cell) >= cell.cos_limit;
    }
    /// Of the angle to the cell's normal.
    float cosine(const Cell& cell) const { return nx * cell.nx + ny * cell.ny + nz * cell.nz; }
    /// Mean squared residual of w of the cell's pixels.
    float mse_to(const Cell& cell) const {
        const float offset = cell.w - (a * cell.x + b * cell.y + c), da = cell.a - a, db = cell.b - b;
        return cell.mse + offset * offset + da * da * cell.xx + db * db * cell.yy;
    }
};

/// Grows regions of cells that share a plane.
class RegionGrower {
  public:
    explicit RegionGrower(const CellOptions& options);

    /// Finds regions of at least `min_pixels` pixels. Afterwards label_of_cell() holds 0 for none or
    /// i + 1 for planes()[i].
    void grow(const CellMap& map, double min_pixels);

    const std::vector<std::uint16_t>& label_of_cell() const { return label_of_cell_; }
    const std::vector<InverseDepthPlane>& planes() const { return planes_; }

  private:
    /// How a region departs from its plane.
    struct Bend {
        double turn = 0;       // of the normal from end to end, radians
        double rise = 0;       // of the middle over the ends, metres
        double explained = 0;  // share of the cells' squared distances that it accounts for
    };
    /// Edges of a region's cells that lead out of it.
    struct Border {
        int length = 0, smooth = 0;
    };

    void find_links(const CellMap& map);
    void rank_seeds(const CellMap& map);
    InverseDepthFit fit_around(const CellMap& map, int cell) const;
    void grow_from(const CellMap& map, int seed, double min_pixels);
    void settle_borders(const CellMap& map);
    void merge(const CellMap& map);
    void drop_thin(const CellMap& map);
    void drop_curved(const CellMap& map);
    void remove(std::uint16_t label);
    void gather_members();
    void find_smooth_borders(const CellMap& map);
    void keep_large(double min_pixels);

    Bend bend_of(const CellMap& map, std::uint16_t label) const;
    bool is_curved(const CellMap& map, std::uint16_t label) const;
    void find_touching(const CellMap& map);
    /// Adds a cell to a region, or takes it away: sign 1 or -1.
    void move(const CellMap& map, int cell, std::uint16_t label, int sign);

    CellOptions options_;
    std::vector<std::uint8_t> links_;  // bit k: neighbour k (right, down, left, up) continues the surface
    std::vector<float> turn_;          // 1 - cosine to the linked neighbour that lies most unlike the cell
    std::vector<std::uint8_t> rank_;   // of each cell as a seed, 0: best
    std::vector<int> seeds_, queue_;
    std::vector<std::uint8_t> tried_;  // cells of a seed that came to nothing
    std::vector<std::uint16_t> label_of_cell_;
    std::vector<MergeRegion> regions_;
    std::vector<Target> targets_;  // of the regions
    TouchList touching_;
    std::vector<Border> borders_;
    std::vector<int> squares_;          // two by two cells, of each region
    std::vector<int> members_, first_;  // cells by region; where each region's begin
    std::vector<int> order_;
    std::vector<std::uint16_t> new_label_;
    std::vector<InverseDepthPlane> planes_;
};

}  // namespace planemap::segmentation
