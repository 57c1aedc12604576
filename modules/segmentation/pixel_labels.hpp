// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "segmentation/cell_grid.hpp"
#include "segmentation/cell_regions.hpp"

namespace planemap::segmentation {

/// The labels that may occur in a cell, and how many of its pixels carry them.
struct CellLabels {
    std::uint8_t size = 0;
    std::array<std::uint8_t, kMaxCandidates> pixels{};
    std::array<std::uint16_t, kMaxCandidates> label{};
};

/// Brings regions of whole cells to borders that are sharp to the pixel.
class PixelLabeller {
  public:
    /// Labels the grid's pixels. A cell of a region keeps to it; others take pixel by pixel what lies within
    /// the band of a region near by. `label_of_cell` holds 0 for none or i + 1 for planes[i].
    void label(CellGrid& grid, const std::vector<std::uint16_t>& label_of_cell,
               const std::vector<InverseDepthPlane>& planes, const BorderBand& band);

    /// Of each cell, since the last label().
    const std::vector<CellLabels>& cell_labels() const { return cell_labels_; }
    /// Of each region.
    const std::vector<Candidate>& candidates() const { return candidates_; }

  private:
    void label_cells(CellGrid& grid, const std::vector<std::uint16_t>& label_of_cell, const BorderBand& band);
    void label_cell(CellGrid& grid, CellGrid::Place place, CellLabels& list, const BorderBand& band);
    void spread(CellGrid& grid, const std::vector<std::uint16_t>& label_of_cell, const BorderBand& band);
    bool offer(const CellGrid& grid, int cell, std::uint16_t label);

    std::vector<CellLabels> cell_labels_;
    std::vector<Candidate> candidates_;  // of each region
    std::vector<Target> targets_;        // of each region
    std::vector<int> changed_, next_changed_;
    std::vector<std::uint8_t> waits_;  // cells in next_changed_
};

}  // namespace planemap::segmentation
