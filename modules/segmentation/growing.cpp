// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/growing.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace planemap {

namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr std::uint16_t kMaxRegions = 4096;

/// Steps to the four neighbours in the order of the link bits: right, down, left, up.
std::array<int, 4> neighbour_steps(const CellMap& map) {
    return {1, map.columns, -1, -map.columns};
}

/// The sums of a cell's points as its fit tells them, weighted by 1 / variance of inverse depth, times
/// `sign`. A cell is one cache line, its own sums would be two more.
PointSums weighted_sums(const Cell& cell, double sign = 1) {
    const double x = static_cast<double>(cell.x), y = static_cast<double>(cell.y),
                 w = static_cast<double>(cell.w);
    const double a = static_cast<double>(cell.a), b = static_cast<double>(cell.b);
    const double xx = static_cast<double>(cell.xx), yy = static_cast<double>(cell.yy);
    const double sigma_w = static_cast<double>(cell.sigma) * w * w;
    const double k = sign * static_cast<double>(cell.pixels) / (sigma_w * sigma_w);
    PointSums sums;
    sums.zz = k;
    sums.xz = k * x;
    sums.yz = k * y;
    sums.xx = k * (xx + x * x);
    sums.xy = k * x * y;
    sums.yy = k * (yy + y * y);
    sums.z = k * w;
    sums.x = k * (a * xx + x * w);
    sums.y = k * (b * yy + y * w);
    sums.n = k * (static_cast<double>(cell.mse) + a * a * xx + b * b * yy + w * w);
    return sums;
}

float cosine(const Cell& a, const Cell& b) {
    return a.nx * b.nx + a.ny * b.ny + a.nz * b.nz;
}

}  // namespace

RegionGrower::RegionGrower(const CellOptions& options) : options_(options) {}

void RegionGrower::grow(const CellMap& map, double min_pixels) {
    label_of_cell_.assign(map.cells.size(), 0);
    tried_.assign(map.cells.size(), 0);
    regions_.clear();
    find_links(map);
    rank_seeds(map);
    for (const int seed : seeds_) grow_from(map, seed, 0.4 * min_pixels);
    settle_borders(map);
    merge(map);
    drop_thin(map);
    drop_curved(map);
    keep_large(0.4 * min_pixels);
}

void RegionGrower::find_links(const CellMap& map) {
    links_.assign(map.cells.size(), 0);
    turn_.assign(map.cells.size(), 0);
    const auto step_m = static_cast<float>(options_.step_m),
               sigmas = static_cast<float>(options_.step_sigmas);
    const auto link = [&](int i, int j, int bit) {
        const Cell &cell = map.cells[i], &other = map.cells[j];
        if (!other.planar()) return;
        // Both planes halfway between the cells' means.
        const float dx = other.x - cell.x, dy = other.y - cell.y;
        const float step = cell.w - other.w + 0.5f * ((cell.a + other.a) * dx + (cell.b + other.b) * dy);
        // As a distance along the normal, |step| z / steepness. The nearer to frontal of the two decides: at
        // a grazing angle a step looks small along the normal.
        const float limit = std::max(step_m, sigmas * std::max(cell.sigma, other.sigma));
        if (!(std::abs(step) * std::max(cell.per_steepness, other.per_steepness) <=
              limit * std::min(cell.w, other.w)))
            return;
        links_[i] |= static_cast<std::uint8_t>(1 << bit);
        links_[j] |= static_cast<std::uint8_t>(4 << bit);
        const float turn = 1 - cosine(cell, other);
        turn_[i] = std::max(turn_[i], turn);
        turn_[j] = std::max(turn_[j], turn);
    };
    for (int y = 0, i = 0; y < map.rows; ++y) {
        for (int x = 0; x < map.columns; ++x, ++i) {
            if (!map.cells[i].planar()) continue;
            if (x + 1 < map.columns) link(i, i + 1, 0);
            if (y + 1 < map.rows) link(i, i + map.columns, 1);
        }
    }
}

void RegionGrower::rank_seeds(const CellMap& map) {
    // Flat cells come first whose neighbours all continue them and lie the same way.
    constexpr int kRanks = 64;
    constexpr float kRanksPerPoint = 16;
    std::array<int, kRanks + 1> count{};
    rank_.resize(map.cells.size());
    for (int i = 0; i < static_cast<int>(map.cells.size()); ++i) {
        const Cell& cell = map.cells[i];
        rank_[i] = kRanks;
        if (!cell.planar()) continue;
        const float sigma_w = cell.sigma * cell.w * cell.w;
        const auto missing = static_cast<float>(4 - std::popcount(links_[i]));
        const float points =
            cell.mse / (sigma_w * sigma_w) + turn_[i] / (1 - cell.cos_limit) + 0.5f * missing;
        // Without noise, or with limits of no angle, points are 0 / 0 or below 0.
        constexpr float kLast = kRanks - 1;
        const float rank = kRanksPerPoint * points;
        rank_[i] = static_cast<std::uint8_t>(rank < kLast ? std::max(rank, 0.0f) : kLast);
        ++count[rank_[i] + 1];
    }
    for (int k = 0; k < kRanks; ++k) count[k + 1] += count[k];
    seeds_.resize(count[kRanks]);
    for (int i = 0; i < static_cast<int>(map.cells.size()); ++i) {
        if (rank_[i] < kRanks) seeds_[count[rank_[i]]++] = i;
    }
}

InverseDepthFit RegionGrower::fit_around(const CellMap& map, int cell) const {
    const std::array<int, 4> steps = neighbour_steps(map);
    PointSums sums;
    sums += weighted_sums(map.cells[cell]);
    for (int k = 0; k < 4; ++k) {
        if ((links_[cell] >> k & 1) == 0) continue;
        const int j = cell + steps[k];
        sums += weighted_sums(map.cells[j]);
    }
    return sums.fit();
}

void RegionGrower::grow_from(const CellMap& map, int seed, double min_pixels) {
    if (label_of_cell_[seed] != 0 || tried_[seed] != 0 || regions_.size() >= kMaxRegions) return;
    const auto label = static_cast<std::uint16_t>(regions_.size() + 1);
    const std::array<int, 4> steps = neighbour_steps(map);
    MergeRegion region;
    region.fit = fit_around(map, seed);
    if (!region.fit.valid) return;
    Target target(region.fit.plane);
    if (!target.accepts(map.cells[seed])) return;

    const auto add = [&](int i) {
        label_of_cell_[i] = label;
        region.sums += weighted_sums(map.cells[i]);
        region.pixels += static_cast<double>(map.cells[i].pixels);
        ++region.cells;
        queue_.push_back(i);
    };
    const auto refit = [&] {
        region.fit = region.sums.fit();
        if (region.fit.valid) target = Target(region.fit.plane);
    };
    constexpr int kFirstFit = 5;  // cells; before that the seed's block is the better plane
    int next_fit = kFirstFit;
    queue_.clear();
    add(seed);
    // The second pass looks again at what the plane of the first cells did not accept.
    for (int pass = 0; pass < 2; ++pass) {
        for (std::size_t next = 0; next < queue_.size(); ++next) {
            const int i = queue_[next];
            for (int k = 0; k < 4; ++k) {
                const int j = i + steps[k];
                if ((links_[i] >> k & 1) != 0 && label_of_cell_[j] == 0 && target.accepts(map.cells[j]))
                    add(j);
            }
            if (region.cells < next_fit) continue;
            refit();
            next_fit = region.cells + 1 + region.cells / 8;
        }
        if (region.cells >= kFirstFit) refit();
    }
    if (region.pixels < min_pixels || !region.fit.valid) {
        for (const int i : queue_) label_of_cell_[i] = 0, tried_[i] = 1;
        return;
    }
    refit();
    regions_.push_back(region);
}

void RegionGrower::settle_borders(const CellMap& map) {
    // Early regions took cells that a later one fits better. Planes change when all cells have been asked.
    const std::array<int, 4> steps = neighbour_steps(map);
    targets_.clear();
    for (const MergeRegion& region : regions_) targets_.emplace_back(region.fit.plane);
    for (int i = 0; i < static_cast<int>(map.cells.size()); ++i) {
        const std::uint8_t links = links_[i];
        if (links == 0) continue;
        const std::uint16_t label = label_of_cell_[i];
        float best = -1;
        std::uint16_t best_label = label;
        for (int k = 0; k < 4; ++k) {
            if ((links >> k & 1) == 0) continue;
            const std::uint16_t other = label_of_cell_[i + steps[k]];
            if (other == 0 || other == label) continue;
            const Cell& cell = map.cells[i];
            if (best < 0) best = label == 0 ? 1e30f : targets_[label - 1].mse_to(cell);
            const float mse = targets_[other - 1].mse_to(cell);
            if (mse < best && targets_[other - 1].accepts(cell)) best = mse, best_label = other;
        }
        if (best_label == label) continue;
        if (label != 0) move(map, i, label, -1);
        move(map, i, best_label, 1);
        label_of_cell_[i] = best_label;
    }
    for (MergeRegion& region : regions_) region.fit = region.sums.fit();
}

void RegionGrower::move(const CellMap& map, int cell, std::uint16_t label, int sign) {
    MergeRegion& region = regions_[label - 1];
    region.sums += weighted_sums(map.cells[cell], sign);
    region.pixels += sign * static_cast<double>(map.cells[cell].pixels);
    region.cells += sign;
}

void RegionGrower::find_touching(const CellMap& map) {
    // Pairs of regions with cells side by side, or with up to kGap other cells between them.
    constexpr int kGap = 4;
    touching_.clear();
    const auto look = [&](int from, int steps, int stride, int link_bit) {
        const std::uint16_t a = label_of_cell_[from];
        for (int k = 1; k <= steps; ++k) {
            const std::uint16_t b = label_of_cell_[from + k * stride];
            if (b == a) return;
            if (b == 0) continue;
            const bool linked = k == 1 && (links_[from] >> link_bit & 1) != 0;
            touching_.add(a, b, linked, k == 1);
            return;
        }
    };
    for (int y = 0, i = 0; y < map.rows; ++y) {
        for (int x = 0; x < map.columns; ++x, ++i) {
            const std::uint16_t label = label_of_cell_[i];
            if (label == 0) continue;
            if (x + 1 < map.columns && label_of_cell_[i + 1] != label)
                look(i, std::min(kGap + 1, map.columns - 1 - x), 1, 0);
            if (y + 1 < map.rows && label_of_cell_[i + map.columns] != label)
                look(i, std::min(kGap + 1, map.rows - 1 - y), map.columns, 1);
        }
    }
}

void RegionGrower::merge(const CellMap& map) {
    find_touching(map);
    MergedLabels merged = merge_regions(
        {options_.merge_m, options_.merge_sigmas, options_.merge_angle_deg * kRadians, map.cell_x, map.noise},
        regions_, touching_);
    for (std::uint16_t& label : label_of_cell_) {
        if (label != 0) label = merged.find(label);
    }
}

void RegionGrower::gather_members() {
    first_.assign(regions_.size() + 2, 0);
    for (const std::uint16_t label : label_of_cell_) ++first_[label + 1];
    for (std::size_t r = 1; r < first_.size(); ++r) first_[r] += first_[r - 1];
    members_.resize(label_of_cell_.size());
    for (int i = 0; i < static_cast<int>(label_of_cell_.size()); ++i)
        members_[first_[label_of_cell_[i]]++] = i;
    for (std::size_t r = first_.size() - 1; r > 0; --r) first_[r] = first_[r - 1];
    first_[0] = 0;
}

RegionGrower::Bend RegionGrower::bend_of(const CellMap& map, std::uint16_t label) const {
    // Fits a quadratic to the distances from the plane of so many cells at most. Coordinates in the plane are
    // divided by z, so that the equations are well scaled.
    constexpr int kCells = 100;
    const MergeRegion& region = regions_[label - 1];
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

bool RegionGrower::is_curved(const CellMap& map, std::uint16_t label) const {
    const Bend bend = bend_of(map, label);
    // Bent by more than the noise; or flat as far as it goes, but the surface goes on around it.
    constexpr int kFewestCells = 8;  // for the bend to mean something
    constexpr double kSmoothShare = 0.4;
    const MergeRegion& region = regions_[label - 1u];
    const bool measured = region.cells >= kFewestCells;
    const bool bent = bend.turn > options_.bend_deg * kRadians &&
                      bend.rise > map.noise.sigma(1 / region.fit.w) && bend.explained > 0.5;
    const bool smooth = borders_[label - 1u].smooth > kSmoothShare * borders_[label - 1u].length;
    return (measured && bent) || smooth;
}

void RegionGrower::find_smooth_borders(const CellMap& map) {
    // Where a flat piece of a curved surface ends, the surface goes on without a step or a crease, but turned
    // too far. Counted where the cells' normals are sure enough to tell.
    borders_.assign(regions_.size(), Border{});
    const double limit = options_.grow_angle_deg * kRadians;
    const auto similar = static_cast<float>(std::cos(limit)),
               turned = static_cast<float>(std::cos(0.5 * limit));
    const auto surest =
        static_cast<float>(std::tan(limit) * map.cell_x);  // error of a normal: sigma w / cell_x
    const std::array<int, 4> steps = neighbour_steps(map);
    targets_.clear();
    for (const MergeRegion& region : regions_) targets_.emplace_back(region.fit.plane);
    for (int y = 0, i = 0; y < map.rows; ++y) {
        for (int x = 0; x < map.columns; ++x, ++i) {
            const std::uint16_t label = label_of_cell_[i];
            if (label == 0) continue;
            const std::array<bool, 4> exists{x + 1 < map.columns, y + 1 < map.rows, x > 0, y > 0};
            for (int k = 0; k < 4; ++k) {
                const int j = i + steps[k];
                if (!exists[k] || label_of_cell_[j] == label) continue;
                Border& border = borders_[label - 1];
                ++border.length;
                if ((links_[i] >> k & 1) == 0) continue;
                const Cell& other = map.cells[j];
                if (other.sigma * other.w > surest) continue;
                const Target& target = targets_[label - 1];
                if (target.cosine(other) < turned && cosine(map.cells[i], other) > similar) ++border.smooth;
            }
        }
    }
}

void RegionGrower::remove(std::uint16_t label) {
    std::replace(label_of_cell_.begin(), label_of_cell_.end(), label, std::uint16_t{0});
    regions_[label - 1u] = MergeRegion{};
}

void RegionGrower::drop_thin(const CellMap& map) {
    // A chain of single cells beside a region whose band holds it is that region's noise along a border or a
    // seam; its pixels go to that region. Chains are told by how few squares of two by two cells they have.
    constexpr int kCellsPerSquare = 16;
    squares_.assign(regions_.size(), 0);
    for (int y = 0; y + 1 < map.rows; ++y) {
        const std::uint16_t *row = label_of_cell_.data() + static_cast<std::ptrdiff_t>(y) * map.columns,
                            *below = row + map.columns;
        for (int x = 0; x + 1 < map.columns; ++x) {
            if (row[x] != 0 && row[x] == row[x + 1] && row[x] == below[x] && row[x] == below[x + 1])
                ++squares_[row[x] - 1u];
        }
    }
    const auto is_thin = [&](std::uint16_t label) {
        return squares_[label - 1u] * kCellsPerSquare < regions_[label - 1u].cells;
    };
    find_touching(map);
    MergedLabels separate(regions_.size() + 1);  // cells have the labels of what was merged
    touching_.gather(separate);
    for (const Touch& touch : touching_.entries()) {
        const bool first = is_thin(touch.a) && regions_[touch.a - 1u].cells < regions_[touch.b - 1u].cells;
        if (!first && !is_thin(touch.b)) continue;
        const std::uint16_t thin = first ? touch.a : touch.b, other = first ? touch.b : touch.a;
        const MergeRegion &strip = regions_[thin - 1u], &beside = regions_[other - 1u];
        if (strip.cells == 0 || beside.cells < strip.cells) continue;
        const double z = 1 / strip.fit.w;
        const double band = std::max(options_.thickness_m, options_.thickness_sigmas * map.noise.sigma(z));
        const double rms = std::sqrt(strip.fit.mse_to(beside.fit.plane));
        if (distance_of(rms, z, beside.fit.plane) < 0.5 * band) remove(thin);
    }
}

void RegionGrower::drop_curved(const CellMap& map) {
    find_smooth_borders(map);
    gather_members();
    for (std::size_t r = 0; r < regions_.size(); ++r) {
        const auto label = static_cast<std::uint16_t>(r + 1);
        if (regions_[r].cells == 0) continue;
        if (is_curved(map, label)) remove(label);
    }
}

void RegionGrower::keep_large(double min_pixels) {
    // Largest first, as most will be when their pixels are known.
    order_.clear();
    for (int r = 0; r < static_cast<int>(regions_.size()); ++r) {
        if (regions_[r].pixels >= min_pixels && regions_[r].fit.valid) order_.push_back(r);
    }
    std::sort(order_.begin(), order_.end(), [&](int a, int b) {
        return std::pair(-regions_[a].pixels, a) < std::pair(-regions_[b].pixels, b);
    });
    planes_.clear();
    new_label_.assign(regions_.size() + 1, 0);
    for (const int r : order_) {
        planes_.push_back(regions_[r].fit.plane);
        new_label_[r + 1] = static_cast<std::uint16_t>(planes_.size());
    }
    for (std::uint16_t& label : label_of_cell_) label = new_label_[label];
}

}  // namespace planemap
