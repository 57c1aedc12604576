// SPDX-License-Identifier: BSD-3-Clause
// The loops of the cell-based method over pixels, eight at a time. A cell is a square of 8 x 8 pixels. The
// loops are compiled once for each instruction set and chosen when the program runs; all give the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/camera.hpp"
#include "segmentation/point_sums.hpp"

namespace planemap::segmentation {

inline constexpr int kCellPx = 8;

/// The plane fitted to a cell, and what the growing of regions asks of it at every step. Image coordinates
/// are normalised, w is inverse depth, 1/metre.
struct alignas(64) Cell {
    float x = 0, y = 0, w = 0;     ///< mean of its pixels, weighted by z^2
    float reach = -1;              ///< largest distance of the mean to a region's plane, as a difference of w
                                   ///< that counts at steepness 1; < 0: the cell is not planar
    float nx = 0, ny = 0, nz = 0;  ///< unit normal of its plane, away from the sensor: (a, b, c) normalised
    float cos_limit = 2;           ///< least cosine of the angle to a region's normal
    float a = 0, b = 0;            ///< slope of its plane
    float mse = 0;                 ///< mean squared residual of w
    float xx = 0, yy = 0;          ///< variance of its pixels' x and y; their covariance is next to nothing
    float pixels = 0;              ///< valid ones
    float sigma = 0;               ///< of depth at 1/w, metres
    float per_steepness = 0;       ///< 1 / steepness of its plane: its distance to the sensor, metres

    bool planar() const { return reach >= 0; }
};

/// How cells are fitted and judged; see CellOptions.
struct CellRules {
    PinholeCamera camera;
    double units_per_metre = 1000;
    std::uint16_t low = 1, high = 0;  ///< valid readings, inclusive
    DepthNoise noise;
    double min_pixels = 0;  ///< valid ones of a planar cell
    double planarity_sigmas = 0, lateral_px = 0;
    double grow_m = 0, grow_sigmas = 0, grow_angle_rad = 0;
};

/// Eight cells side by side, and where they lie.
struct CellGroup {
    const std::uint16_t* depth = nullptr;  ///< of the first cell's first pixel
    std::ptrdiff_t stride = 0;             ///< pixels from row to row
    int u = 0, v = 0;                      ///< first pixel
};

/// How far a pixel may lie from the plane it is given to: max(thickness_m, thickness_sigmas sigma(z)), with z
/// the plane's depth in the middle of the cell.
struct BorderBand {
    double thickness_m = 0;
    double thickness_sigmas = 0;
    DepthNoise noise;
};

/// A plane that pixels may belong to. A pixel's point lies |d - line raw| from it, with line = start +
/// right u + down v in metres per raw unit.
struct Candidate {
    double start = 0, right = 0, down = 0;
    double d = 0;  ///< distance of the plane to the sensor, metres
    std::uint16_t label = 0;
};

/// At most this many candidates a cell.
inline constexpr std::size_t kMaxCandidates = 8;

/// A cell whose pixels are to be labelled.
struct CellPixels {
    const std::uint16_t* depth = nullptr;
    std::uint16_t* labels = nullptr;
    std::ptrdiff_t stride = 0;  ///< of both, pixels
    int u = 0, v = 0;           ///< first pixel
};

/// The pixels of a cell that carry a label; only valid readings may.
struct LabelledPixels {
    const std::uint16_t* depth = nullptr;
    const std::uint16_t* labels = nullptr;
    std::ptrdiff_t stride = 0;  ///< of both, pixels
    int u = 0, v = 0;           ///< first pixel
    std::uint16_t label = 0;
    std::uint16_t reference = 1;  ///< a reading near those of the set: sums are taken about it to keep their
                                  ///< digits
};

/// One instruction set's loops.
struct CellKernels {
    const char* name;

    /// Fits eight cells to their valid pixels; `sums` are theirs, unweighted.
    void (*fit)(const CellRules& rules, const CellGroup& group, Cell* cells, PointSums* sums);

    /// Gives each valid pixel of a cell the label of the nearest of `count` candidates within the band, or 0,
    /// and counts the pixels of each. Precondition: count <= kMaxCandidates.
    void (*label)(const CellRules& rules, const BorderBand& band, const CellPixels& cell,
                  const Candidate* candidates, std::size_t count, std::uint8_t* pixels);

    /// Sums over the points of eight sets.
    void (*sum)(const CellRules& rules, const LabelledPixels* sets, PointSums* sums);
};

/// Plain C++ without vector types, for any machine.
const CellKernels& portable_cell_kernels();
/// The instruction set that the project is compiled for.
const CellKernels& baseline_cell_kernels();
/// AVX2, or null where the machine or the build has none.
const CellKernels* avx2_cell_kernels();
/// The fastest that this machine runs.
const CellKernels& best_cell_kernels();

}  // namespace planemap::segmentation
