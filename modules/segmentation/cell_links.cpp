// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/cell_links.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace planemap::segmentation {

inline void CellLinks::link(const CellMap& map, int i, int j, int k) {
    const Cell &cell = map.cells[i], &other = map.cells[j];
    if (!other.planar()) return;
    // Both planes halfway between the cells' means.
    const float dx = other.x - cell.x, dy = other.y - cell.y;
    const float step = cell.w - other.w + 0.5f * ((cell.a + other.a) * dx + (cell.b + other.b) * dy);
    // As a distance along the normal, |step| z / steepness. The nearer to frontal of the two decides: at a
    // grazing angle a step looks small along the normal.
    const float limit = std::max(step_m_, step_sigmas_ * std::max(cell.sigma, other.sigma));
    if (!(std::abs(step) * std::max(cell.per_steepness, other.per_steepness) <=
          limit * std::min(cell.w, other.w)))
        return;
    links_[i] |= static_cast<std::uint8_t>(1 << k);
    links_[j] |= static_cast<std::uint8_t>(4 << k);
    const float turn = 1 - cosine(cell, other);
    turn_[i] = std::max(turn_[i], turn);
    turn_[j] = std::max(turn_[j], turn);
}

void CellLinks::find(const CellMap& map, double step_m, double step_sigmas) {
    step_m_ = static_cast<float>(step_m);
    step_sigmas_ = static_cast<float>(step_sigmas);
    links_.assign(map.cells.size(), 0);
    turn_.assign(map.cells.size(), 0);
    for (int y = 0, i = 0; y < map.rows; ++y) {
        for (int x = 0; x < map.columns; ++x, ++i) {
            if (!map.cells[i].planar()) continue;
            if (x + 1 < map.columns) link(map, i, i + 1, 0);
            if (y + 1 < map.rows) link(map, i, i + map.columns, 1);
        }
    }
}

void SeedOrder::rank(const CellMap& map, const CellLinks& links) {
    constexpr int kRanks = 64;
    constexpr float kRanksPerPoint = 16;
    std::array<int, kRanks + 1> count{};
    rank_.resize(map.cells.size());
    for (int i = 0; i < static_cast<int>(map.cells.size()); ++i) {
        const Cell& cell = map.cells[i];
        rank_[i] = kRanks;
        if (!cell.planar()) continue;
        const float sigma_w = cell.sigma * cell.w * cell.w;
        const auto missing = static_cast<float>(4 - links.count(i));
        const float points =
            cell.mse / (sigma_w * sigma_w) + links.turn(i) / (1 - cell.cos_limit) + 0.5f * missing;
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

}  // namespace planemap::segmentation
