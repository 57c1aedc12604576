// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/curvature.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/box.hpp"

namespace planemap::segmentation {

void CurvedRegions::remove(const CellMap& map, const CellLinks& links, CellRegions& cell_regions) {
    find_smooth_borders(map, links, cell_regions);
    gather_members(cell_regions);
    for (std::size_t r = 0; r < cell_regions.regions.size(); ++r) {
        const auto label = static_cast<std::uint16_t>(r + 1);
        const MergeRegion& region = cell_regions.regions[r];
        if (region.cells > 0 && is_curved(map, region, label)) cell_regions.remove(label);
    }
}

void CurvedRegions::gather_members(const CellRegions& cell_regions) {
    const std::vector<std::uint16_t>& label_of_cell = cell_regions.label_of_cell;
    first_.assign(cell_regions.regions.size() + 2, 0);
    for (const std::uint16_t label : label_of_cell) ++first_[label + 1];
    for (std::size_t r = 1; r < first_.size(); ++r) first_[r] += first_[r - 1];
    members_.resize(label_of_cell.size());
    for (int i = 0; i < static_cast<int>(label_of_cell.size()); ++i) members_[first_[label_of_cell[i]]++] = i;
    for (std::size_t r = first_.size() - 1; r > 0; --r) first_[r] = first_[r - 1];
    first_[0] = 0;
}

CurvedRegions::Bend CurvedRegions::bend_of(const CellMap& map, const MergeRegion& region,
                                           std::uint16_t label) const {
    // Fits a quadratic to the distances from the plane of so many cells at most. Coordinates in the plane are
    // divided by z, so that the equations are well scaled.
    constexpr int kCells = 100;
    const Plane plane = region.fit.plane.plane();
    const double z = 1 / region.fit.w;
    const Eigen::Vector3d centre = Eigen::Vector3d(region.fit.x, region.fit.y, 1) * z;
    const Eigen::Matrix3d axes = plane_axes(plane.normal, Eigen::Vector3d::UnitX());
    using Vector6d = Eigen::Matrix<double, 6, 1>;
    Matrix6d normal_matrix = Matrix6d::Zero();
    Vector6d right = Vector6d::Zero();
    Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
    double total = 0, squares = 0;
    const int begin = first_[label], end = first_[label + 1], step = std::max(1, (end - begin) / kCells);
    for (int member = begin; member < end; member += step) {
        const Cell& cell = map.cells[members_[member]];
        const Eigen::Vector3d p =
            Eigen::Vector3f(cell.x, cell.y, 1).cast<double>() / static_cast<double>(cell.w);
        const Eigen::Vector3d q = (axes.transpose() * (p - centre)) / z;
        const double e = plane.signed_distance(p);
        const double weight = static_cast<double>(cell.pixels / (cell.sigma * cell.sigma));
        const Vector6d terms{1, q.x(), q.y(), q.x() * q.x(), q.x() * q.y(), q.y() * q.y()};
        normal_matrix += weight * terms * terms.transpose();
        right += weight * e * terms;
        spread += weight * q.head<2>() * q.head<2>().transpose();
        total += weight;
        squares += weight * e * e;
    }
    const Vector6d fit = normal_matrix.ldlt().solve(right);
    if (!fit.allFinite() || !(squares > 0)) return {};
    Eigen::Matrix2d hessian;
    hessian << 2 * fit[3], fit[4], fit[4], 2 * fit[5];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal(hessian);
    Bend bend;
    for (int k = 0; k < 2; ++k) {
        const Eigen::Vector2d along = principal.eigenvectors().col(k);
        const double length = std::sqrt(12 * along.dot(spread * along) / total);  // as of an even spread
        const double turn = std::abs(principal.eigenvalues()[k]) * length / z;
        if (turn > bend.turn) bend = {turn, turn * length * z / 8, right.dot(fit) / squares};
    }
    return bend;
}

bool CurvedRegions::is_curved(const CellMap& map, const MergeRegion& region, std::uint16_t label) const {
    const Bend bend = bend_of(map, region, label);
    // Bent by more than the noise; or flat as far as it goes, but the surface goes on around it.
    constexpr int kFewestCells = 8;  // for the bend to mean something
    constexpr double kSmoothShare = 0.4;
    const bool measured = region.cells >= kFewestCells;
    const bool bent =
        bend.turn > bend_rad_ && bend.rise > map.noise.sigma(1 / region.fit.w) && bend.explained > 0.5;
    const bool smooth = borders_[label - 1u].smooth > kSmoothShare * borders_[label - 1u].length;
    return (measured && bent) || smooth;
}

void CurvedRegions::find_smooth_borders(const CellMap& map, const CellLinks& links,
                                        const CellRegions& cell_regions) {
    // Where a flat piece of a curved surface ends, the surface goes on without a step or a crease, but turned
    // too far. Counted where the cells' normals are sure enough to tell.
    const std::vector<std::uint16_t>& label_of_cell = cell_regions.label_of_cell;
    borders_.assign(cell_regions.regions.size(), Border{});
    const double limit = grow_angle_rad_;
    const auto similar = static_cast<float>(std::cos(limit)),
               turned = static_cast<float>(std::cos(0.5 * limit));
    const auto surest =
        static_cast<float>(std::tan(limit) * map.cell_x);  // error of a normal: sigma w / cell_x
    const std::array<int, 4> steps = map.neighbour_steps();
    make_targets(cell_regions, targets_);
    for (int y = 0, i = 0; y < map.rows; ++y) {
        for (int x = 0; x < map.columns; ++x, ++i) {
            const std::uint16_t label = label_of_cell[i];
            if (label == 0) continue;
            const std::array<bool, 4> exists{x + 1 < map.columns, y + 1 < map.rows, x > 0, y > 0};
            for (int k = 0; k < 4; ++k) {
                const int j = i + steps[k];
                if (!exists[k] || label_of_cell[j] == label) continue;
                Border& border = borders_[label - 1];
                ++border.length;
                if (!links.linked(i, k)) continue;
                const Cell& other = map.cells[j];
                if (other.sigma * other.w > surest) continue;
                const Target& target = targets_[label - 1];
                if (target.cosine(other) < turned && cosine(map.cells[i], other) > similar) ++border.smooth;
            }
        }
    }
}

}  // namespace planemap::segmentation
