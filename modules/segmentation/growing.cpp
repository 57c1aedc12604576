// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/growing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/angle.hpp"

namespace planemap::segmentation {

namespace {

constexpr std::uint16_t kMaxRegions = 4096;

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

}  // namespace

RegionGrower::RegionGrower(const CellOptions& options)
    : options_(options), curved_(radians(options.bend_deg), radians(options.grow_angle_deg)) {}

void RegionGrower::grow(const CellMap& map, double min_pixels) {
    result_.label_of_cell.assign(map.cells.size(), 0);
    result_.regions.clear();
    tried_.assign(map.cells.size(), 0);
    links_.find(map, options_.step_m, options_.step_sigmas);
    seed_order_.rank(map, links_);
    for (const int seed : seed_order_.seeds()) grow_from(map, seed, 0.4 * min_pixels);
    settle_borders(map);
    merge(map);
    thin_.remove(map, links_, {options_.thickness_m, options_.thickness_sigmas, map.noise}, result_);
    curved_.remove(map, links_, result_);
    keep_large(0.4 * min_pixels);
}

InverseDepthFit RegionGrower::fit_around(const CellMap& map, int cell) const {
    const std::array<int, 4> steps = map.neighbour_steps();
    PointSums sums;
    sums += weighted_sums(map.cells[cell]);
    for (int k = 0; k < 4; ++k) {
        if (!links_.linked(cell, k)) continue;
        const int j = cell + steps[k];
        sums += weighted_sums(map.cells[j]);
    }
    return sums.fit();
}

void RegionGrower::grow_from(const CellMap& map, int seed, double min_pixels) {
    if (result_.label_of_cell[seed] != 0 || tried_[seed] != 0 || result_.regions.size() >= kMaxRegions)
        return;
    const auto label = static_cast<std::uint16_t>(result_.regions.size() + 1);
    const std::array<int, 4> steps = map.neighbour_steps();
    MergeRegion region;
    region.fit = fit_around(map, seed);
    if (!region.fit.valid) return;
    Target target(region.fit.plane);
    if (!target.accepts(map.cells[seed])) return;

    const auto add = [&](int i) {
        result_.label_of_cell[i] = label;
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
                if (links_.linked(i, k) && result_.label_of_cell[j] == 0 && target.accepts(map.cells[j]))
                    add(j);
            }
            if (region.cells < next_fit) continue;
            refit();
            next_fit = region.cells + 1 + region.cells / 8;
        }
        if (region.cells >= kFirstFit) refit();
    }
    if (region.pixels < min_pixels || !region.fit.valid) {
        for (const int i : queue_) result_.label_of_cell[i] = 0, tried_[i] = 1;
        return;
    }
    refit();
    result_.regions.push_back(region);
}

void RegionGrower::settle_borders(const CellMap& map) {
    // Early regions took cells that a later one fits better. Planes change when all cells have been asked.
    const std::array<int, 4> steps = map.neighbour_steps();
    make_targets(result_, targets_);
    for (int i = 0; i < static_cast<int>(map.cells.size()); ++i) {
        if (!links_.any(i)) continue;
        const std::uint16_t label = result_.label_of_cell[i];
        float best = -1;
        std::uint16_t best_label = label;
        for (int k = 0; k < 4; ++k) {
            if (!links_.linked(i, k)) continue;
            const std::uint16_t other = result_.label_of_cell[i + steps[k]];
            if (other == 0 || other == label) continue;
            const Cell& cell = map.cells[i];
            if (best < 0) best = label == 0 ? 1e30f : targets_[label - 1].mse_to(cell);
            const float mse = targets_[other - 1].mse_to(cell);
            if (mse < best && targets_[other - 1].accepts(cell)) best = mse, best_label = other;
        }
        if (best_label == label) continue;
        if (label != 0) move(map, i, label, -1);
        move(map, i, best_label, 1);
        result_.label_of_cell[i] = best_label;
    }
    for (MergeRegion& region : result_.regions) region.fit = region.sums.fit();
}

void RegionGrower::move(const CellMap& map, int cell, std::uint16_t label, int sign) {
    MergeRegion& region = result_.at(label);
    region.sums += weighted_sums(map.cells[cell], sign);
    region.pixels += sign * static_cast<double>(map.cells[cell].pixels);
    region.cells += sign;
}

void RegionGrower::merge(const CellMap& map) {
    find_touching(map, links_, result_, touching_);
    merge_regions(
        {options_.merge_m, options_.merge_sigmas, radians(options_.merge_angle_deg), map.cell_x, map.noise},
        result_.regions, touching_, merged_);
    for (std::uint16_t& label : result_.label_of_cell) {
        if (label != 0) label = merged_.find(label);
    }
}

void RegionGrower::keep_large(double min_pixels) {
    // Largest first, as most will be when their pixels are known.
    order_.clear();
    for (int r = 0; r < static_cast<int>(result_.regions.size()); ++r) {
        if (result_.regions[r].pixels >= min_pixels && result_.regions[r].fit.valid) order_.push_back(r);
    }
    std::sort(order_.begin(), order_.end(), [&](int a, int b) {
        return std::pair(-result_.regions[a].pixels, a) < std::pair(-result_.regions[b].pixels, b);
    });
    planes_.clear();
    new_label_.assign(result_.regions.size() + 1, 0);
    for (const int r : order_) {
        planes_.push_back(result_.regions[r].fit.plane);
        new_label_[r + 1] = static_cast<std::uint16_t>(planes_.size());
    }
    for (std::uint16_t& label : result_.label_of_cell) label = new_label_[label];
}

}  // namespace planemap::segmentation
