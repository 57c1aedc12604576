// SPDX-License-Identifier: BSD-3-Clause
#include "segmentation/pixel_labels.hpp"

#include <algorithm>
#include <span>

namespace planemap::segmentation {

namespace {

/// Cosine of the angle between surfaces that cannot be one.
constexpr float kSimilar = 0.5f;

}  // namespace

void PixelLabeller::label(CellGrid& grid, const std::vector<std::uint16_t>& label_of_cell,
                          const std::vector<InverseDepthPlane>& planes, const BorderBand& band) {
    candidates_.clear();
    targets_.clear();
    for (const InverseDepthPlane& plane : planes) {
        targets_.emplace_back(plane);
        candidates_.push_back(grid.candidate(plane, static_cast<std::uint16_t>(targets_.size())));
    }
    label_cells(grid, label_of_cell, band);
    spread(grid, label_of_cell, band);
}

bool PixelLabeller::offer(const CellGrid& grid, int cell, std::uint16_t label) {
    CellLabels& list = cell_labels_[cell];
    const auto end = list.label.begin() + list.size;
    if (list.size == list.label.size() || std::find(list.label.begin(), end, label) != end) return false;
    // A stripe of a surface that lies otherwise is not part of the plane that cuts it.
    const Cell& fitted = grid.cells()[cell];
    if (fitted.planar() && targets_[label - 1].cosine(fitted) < std::min(fitted.cos_limit, kSimilar))
        return false;
    list.label[list.size] = label;
    list.pixels[list.size++] = 0;
    return true;
}

void PixelLabeller::label_cell(CellGrid& grid, CellGrid::Place place, CellLabels& list,
                               const BorderBand& band) {
    if (list.size == 1) {
        grid.label(place, band, std::span(candidates_).subspan(list.label[0] - 1, 1), list.pixels.data());
        return;
    }
    std::array<Candidate, kMaxCandidates> candidates;
    for (std::size_t k = 0; k < list.size; ++k) candidates[k] = candidates_[list.label[k] - 1];
    grid.label(place, band, std::span(candidates).first(list.size), list.pixels.data());
}

void PixelLabeller::label_cells(CellGrid& grid, const std::vector<std::uint16_t>& labels,
                                const BorderBand& band) {
    // A cell of a region keeps to that region, and offers its label to the eight cells around it.
    const int columns = grid.columns(), rows = grid.rows();
    cell_labels_.resize(static_cast<std::size_t>(grid.size()));
    waits_.assign(cell_labels_.size(), 0);
    changed_.clear();
    for (int y = 0, i = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x, ++i) {
            CellLabels& list = cell_labels_[i];
            list.size = 0;
            if (labels[i] != 0) {
                list.size = 1;
                list.label[0] = labels[i];
                grid.label({x, y}, band, {&candidates_[labels[i] - 1], 1}, list.pixels.data());
                continue;
            }
            const int left = x > 0 ? -1 : 0, right = x + 1 < columns ? 1 : 0;
            for (int down = y > 0 ? -1 : 0; down <= (y + 1 < rows ? 1 : 0); ++down) {
                const std::uint16_t* row = &labels[i + down * columns];
                for (int k = left; k <= right; ++k) {
                    if (row[k] != 0) offer(grid, i, row[k]);
                }
            }
            if (list.size > 0) {
                changed_.push_back(i);
                label_cell(grid, {x, y}, list, band);
            } else {
                grid.fill({x, y}, 0);
            }
        }
    }
}

void PixelLabeller::spread(CellGrid& grid, const std::vector<std::uint16_t>& labels, const BorderBand& band) {
    // A cell without region where enough pixels took a label offers it on to its four neighbours.
    const int columns = grid.columns(), rows = grid.rows();
    const auto offer_on = [&](int cell, std::uint16_t label) {
        if (labels[cell] != 0 || !offer(grid, cell, label) || waits_[cell] != 0) return;
        waits_[cell] = 1;
        next_changed_.push_back(cell);
    };
    constexpr int kRounds = 32;
    constexpr int kEnough = kCellPx * kCellPx / 10;
    for (int round = 1; round < kRounds && !changed_.empty(); ++round) {
        next_changed_.clear();
        for (const int i : changed_) {
            const auto [x, y] = grid.place(i);
            const CellLabels& list = cell_labels_[i];
            for (std::size_t k = 0; k < list.size; ++k) {
                if (list.pixels[k] < kEnough) continue;
                if (x > 0) offer_on(i - 1, list.label[k]);
                if (x + 1 < columns) offer_on(i + 1, list.label[k]);
                if (y > 0) offer_on(i - columns, list.label[k]);
                if (y + 1 < rows) offer_on(i + columns, list.label[k]);
            }
        }
        changed_.swap(next_changed_);
        for (const int i : changed_) {
            label_cell(grid, grid.place(i), cell_labels_[i], band);
            waits_[i] = 0;
        }
    }
}

}  // namespace planemap::segmentation
