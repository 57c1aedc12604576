// SPDX-License-Identifier: BSD-3-Clause
// The pixel loops of the cell-based method: everything that touches raw depth. A cell is a square of 4 to 32
// pixels; cells at the right and bottom edges may hang over the image, where no pixel is valid.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/camera.hpp"
#include "core/image.hpp"
#include "core/moments.hpp"
#include "segmentation/inverse_depth.hpp"

namespace planemap {

/// How far a pixel may lie from the plane it is given to: max(thickness_m, thickness_sigmas sigma(z)).
struct BorderBand {
    double thickness_m = 0;
    double thickness_sigmas = 0;
    DepthNoise noise;
};

/// A plane that pixels of a cell may belong to.
struct Candidate {
    std::uint16_t label = 0;
    InverseDepthPlane plane;
};

/// A depth image cut into cells. Refers to the image: valid while that lives.
class CellGrid {
  public:
    static constexpr std::size_t kMaxCandidates = 8;

    /// Cuts an image; the side of a cell is rounded to a multiple of 4 within 4 to 32 pixels.
    void reset(const DepthImage& depth, const CameraInfo& camera, double cell_px);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    int size() const { return columns_ * rows_; }
    int cell_px() const { return cell_px_; }

    /// Unweighted sums over the valid pixels of a cell.
    InverseDepthSums inverse_depth_sums(int cell) const;

    /// Gives each valid pixel of a cell the label of the nearest candidate within the band, or 0, and counts
    /// the pixels of each candidate. Candidates after the first kMaxCandidates are not looked at.
    std::array<int, kMaxCandidates> label(int cell, std::span<const Candidate> candidates,
                                          const BorderBand& band, Image<std::uint16_t>& labels) const;

    /// Sums over the pixels of a cell that carry the candidate's label; only valid pixels may carry one. The
    /// pixels should lie near the candidate's plane: sums are taken about it to keep their digits.
    InverseDepthSums inverse_depth_sums(int cell, const Image<std::uint16_t>& labels,
                                        const Candidate& candidate) const;
    /// Moments of the points of these pixels, metres.
    Moments moments(int cell, const Image<std::uint16_t>& labels, const Candidate& candidate) const;

  private:
    struct Patch {
        alignas(16) std::array<std::uint16_t, 32 * 32> pixels;
    };
    /// Rows of a cell, cell_px() pixels each.
    struct Rows {
        const std::uint16_t* first;
        std::ptrdiff_t stride;
    };
    struct Place {
        int u, v, width, height;  // first pixel, and number of pixels within the image
    };
    Place place(int cell) const;
    /// Inverse depth of a plane at the centre of a cell, kept within what a reading can be.
    double inverse_depth_at(int cell, const InverseDepthPlane& plane) const;
    /// The cell in the image itself where it is whole, else copied to `patch` and padded with zeros.
    Rows rows_of(const Image<std::uint16_t>& image, int cell, Patch& patch) const;

    const DepthImage* depth_ = nullptr;
    PinholeCamera camera_;
    double units_per_metre_ = 0;
    std::uint16_t low_ = 1, high_ = 0;  // valid readings, inclusive
    int cell_px_ = 4, columns_ = 0, rows_ = 0;
};

}  // namespace planemap
