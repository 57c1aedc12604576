// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "segmentation/cell_kernels.hpp"

namespace planemap::segmentation {

/// What the sensor says of the rules: its geometry, units, range and noise. The rest is the caller's.
CellRules sensor_rules(const CameraInfo& camera);

/// A depth image cut into cells of 8 x 8 pixels, row by row. An image whose sides are no multiple of a cell
/// is padded with invalid readings.
class CellGrid {
  public:
    explicit CellGrid(const CellKernels& kernels) : kernels_(&kernels) {}

    /// Cuts an image; what its labels are is open until all its cells are labelled or filled. `depth` must
    /// live as long as the grid is used.
    void reset(const DepthImage& depth, const CellRules& rules);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    int size() const { return columns_ * rows_; }

    /// Fits each cell to its valid pixels. Afterwards cells() and sums() hold the result.
    void fit();
    const std::vector<Cell>& cells() const { return cells_; }
    /// Unweighted sums over the valid pixels of each cell.
    const std::vector<PointSums>& sums() const { return sums_; }

    /// A cell's column and row.
    struct Place {
        int x, y;
    };
    Place place(int cell) const { return {cell % columns_, cell / columns_}; }

    /// A plane as label() takes it.
    Candidate candidate(const InverseDepthPlane& plane, std::uint16_t label) const;
    /// The reading that a plane gives in the middle of a cell, kept within what a reading can be.
    std::uint16_t depth_at(Place cell, const Candidate& candidate) const;

    /// See CellKernels::label.
    void label(Place cell, const BorderBand& band, std::span<const Candidate> candidates,
               std::uint8_t* pixels);

    /// Gives all of a cell's pixels a label.
    void fill(Place cell, std::uint16_t label);

    /// A cell's pixels that carry a label.
    struct Part {
        Place cell{};
        std::uint16_t label = 0;
        std::uint16_t reference = 1;  ///< a reading near theirs
    };
    /// Sums over the points of up to eight parts.
    void sum(std::span<const Part> parts, PointSums* sums) const;

    /// Gives the pixels of a cell new labels: `new_label[old]`.
    void rename(Place cell, std::span<const std::uint16_t> new_label);
    /// Hands over the labels, of the image's size; takes the buffers of `out` for the next image.
    void take_labels(Image<std::uint16_t>& out);

  private:
    const CellKernels* kernels_;
    CellRules rules_;
    const DepthImage* depth_ = nullptr;  // the image, or padded_
    DepthImage padded_;
    Image<std::uint16_t> labels_;  // of the padded size
    int width_ = 0, height_ = 0;   // of the image
    int columns_ = 0, rows_ = 0;
    std::vector<Cell> cells_;
    std::vector<PointSums> sums_;
};

}  // namespace planemap::segmentation
