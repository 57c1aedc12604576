// SPDX-License-Identifier: BSD-3-Clause
// Grids of cells that lie exactly on planes, for the tests of growing.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "segmentation/cell_regions.hpp"

namespace planemap::segmentation {

inline constexpr double kCell = 0.02;  // side, normalised coordinates
inline constexpr double kPixels = 100;

/// A map with its cells.
struct OwnedMap {
    std::vector<Cell> cells;
    int columns = 0, rows = 0;

    CellMap map() const { return {columns, rows, kCell, DepthNoise{}, cells}; }
};

/// A map whose cell (column, row) lies exactly on the plane that `plane_of` names; one with steepness 0 is
/// not planar.
inline OwnedMap make_map(int columns, int rows, const std::function<InverseDepthPlane(int, int)>& plane_of) {
    OwnedMap owned;
    owned.columns = columns;
    owned.rows = rows;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            Cell& cell = owned.cells.emplace_back();
            PointSums sums;
            const InverseDepthPlane plane = plane_of(x, y);
            if (plane.steepness() == 0) continue;
            for (const double dx : {-0.3, 0.3}) {
                for (const double dy : {-0.3, 0.3}) {
                    const double px = kCell * (x - 0.5 * columns + dx), py = kCell * (y - 0.5 * rows + dy);
                    const double Z = 1 / plane.at(px, py), X = px * Z, Y = py * Z, k = kPixels / 4;
                    sums.add(k, {1, X, Y, Z, X * X, X * Y, X * Z, Y * Y, Y * Z, Z * Z});
                }
            }
            const InverseDepthFit fit = sums.fit();
            const Eigen::Vector3f normal = -fit.plane.plane().normal.cast<float>();
            cell.x = static_cast<float>(fit.x);
            cell.y = static_cast<float>(fit.y);
            cell.w = static_cast<float>(fit.w);
            cell.sigma = static_cast<float>(DepthNoise{}.sigma(1 / fit.w));
            cell.reach = std::max(0.01f, 1.5f * cell.sigma) * cell.w;
            cell.nx = normal.x();
            cell.ny = normal.y();
            cell.nz = normal.z();
            cell.cos_limit = std::cos(0.3f);
            cell.a = static_cast<float>(fit.plane.a);
            cell.b = static_cast<float>(fit.plane.b);
            cell.xx = static_cast<float>(fit.xx);
            cell.yy = static_cast<float>(fit.yy);
            cell.pixels = static_cast<float>(kPixels);
            cell.per_steepness = static_cast<float>(1 / fit.plane.steepness());
        }
    }
    return owned;
}

/// Regions of cells named by `label_of` (0: none), with the planes that their cells lie on.
inline CellRegions make_regions(const OwnedMap& owned, const std::function<int(int, int)>& label_of) {
    CellRegions result;
    for (int y = 0; y < owned.rows; ++y)
        for (int x = 0; x < owned.columns; ++x)
            result.label_of_cell.push_back(static_cast<std::uint16_t>(label_of(x, y)));
    for (std::size_t i = 0; i < owned.cells.size(); ++i) {
        const std::uint16_t label = result.label_of_cell[i];
        if (label == 0) continue;
        if (result.regions.size() < label) result.regions.resize(label);
        MergeRegion& region = result.at(label);
        const double x = static_cast<double>(owned.cells[i].x), y = static_cast<double>(owned.cells[i].y),
                     Z = 1 / static_cast<double>(owned.cells[i].w), X = x * Z, Y = y * Z;
        region.sums.add(kPixels, {1, X, Y, Z, X * X, X * Y, X * Z, Y * Y, Y * Z, Z * Z});
        region.pixels += kPixels;
        ++region.cells;
    }
    for (MergeRegion& region : result.regions) region.fit = region.sums.fit();
    return result;
}

}  // namespace planemap::segmentation
