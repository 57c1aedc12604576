// SPDX-License-Identifier: BSD-3-Clause
// Cells side by side, and regions made of them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "segmentation/cell_kernels.hpp"
#include "segmentation/merging.hpp"
#include "segmentation/point_sums.hpp"

namespace planemap::segmentation {

/// A grid of cells, row-major. Refers to the cells.
struct CellMap {
    int columns = 0, rows = 0;
    double cell_x = 0;  ///< width of a cell in normalised coordinates
    DepthNoise noise;   ///< of the sensor
    std::span<const Cell> cells;

    /// Steps to a cell's four neighbours: right, down, left, up.
    std::array<int, 4> neighbour_steps() const { return {1, columns, -1, -columns}; }
};

/// Of the angle between two cells' normals.
inline float cosine(const Cell& a, const Cell& b) {
    return a.nx * b.nx + a.ny * b.ny + a.nz * b.nz;
}

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

/// Regions of whole cells.
struct CellRegions {
    std::vector<std::uint16_t> label_of_cell;  ///< 0: none, i + 1: of regions[i]
    std::vector<MergeRegion> regions;          ///< without cells: of no meaning any more

    MergeRegion& at(std::uint16_t label) { return regions[label - 1u]; }
    const MergeRegion& at(std::uint16_t label) const { return regions[label - 1u]; }
    /// Takes a region's cells from it.
    void remove(std::uint16_t label);
};

/// Makes targets of the regions' planes.
void make_targets(const CellRegions& cell_regions, std::vector<Target>& targets);

}  // namespace planemap::segmentation
