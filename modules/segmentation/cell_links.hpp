// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "segmentation/cell_regions.hpp"

namespace planemap::segmentation {

/// Which neighbouring cells continue each other's surface: their planes meet without a step.
class CellLinks {
  public:
    /// A step is larger than step_m metres and step_sigmas times the noise.
    void find(const CellMap& map, double step_m, double step_sigmas);

    /// Whether a cell's neighbour k (see CellMap::neighbour_steps) continues it.
    bool linked(int cell, int k) const { return (links_[cell] >> k & 1) != 0; }
    /// Whether any neighbour does.
    bool any(int cell) const { return links_[cell] != 0; }
    /// How many neighbours do.
    int count(int cell) const { return std::popcount(links_[cell]); }
    /// 1 - cosine of the angle to the linked neighbour that lies most unlike the cell; 0 without one.
    float turn(int cell) const { return turn_[cell]; }

  private:
    void link(const CellMap& map, int cell, int other, int k);

    float step_m_ = 0, step_sigmas_ = 0;
    std::vector<std::uint8_t> links_;  // bit k: neighbour k
    std::vector<float> turn_;
};

/// The order in which cells are tried as the seeds of regions.
class SeedOrder {
  public:
    /// Flat cells come first whose neighbours all continue them and lie the same way.
    void rank(const CellMap& map, const CellLinks& links);
    /// The planar cells, best first.
    const std::vector<int>& seeds() const { return seeds_; }

  private:
    std::vector<std::uint8_t> rank_;  // of each cell, 0: best
    std::vector<int> seeds_;
};

}  // namespace planemap::segmentation
