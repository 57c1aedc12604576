// SPDX-License-Identifier: BSD-3-Clause
// From planar cells to planar regions of whole cells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "segmentation/cells.hpp"
#include "segmentation/inverse_depth.hpp"

namespace planemap {

/// One square of the depth image and the plane fitted to it.
struct Cell {
    InverseDepthFit fit;
    InverseDepthSums sums;   ///< of its pixels, weighted by 1 / variance of inverse depth
    double pixels = 0;       ///< valid ones
    double z = 0;            ///< mean depth, metres
    double sigma = 0;        ///< of depth at z, metres
    double angle_error = 0;  ///< of the fitted normal, radians
    bool planar = false;     ///< enough pixels, within the sensor's noise of a plane
};

/// A grid of cells, row-major.
struct CellMap {
    int columns = 0, rows = 0;
    double cell_x = 0;  ///< width of a cell in normalised coordinates
    DepthNoise noise;   ///< of the sensor
    std::vector<Cell> cells;
};

/// Grows regions of cells that share a plane.
class RegionGrower {
  public:
    explicit RegionGrower(const CellOptions& options);

    /// Finds regions of at least `min_pixels` pixels. Afterwards label_of_cell() holds 0 for none or
    /// i + 1 for planes()[i].
    void grow(const CellMap& map, double min_pixels);

    const std::vector<std::uint16_t>& label_of_cell() const { return label_of_cell_; }
    const std::vector<InverseDepthPlane>& planes() const { return planes_; }

  private:
    struct Region {
        InverseDepthSums sums;
        InverseDepthFit fit;
        double pixels = 0;
        int cells = 0;
        std::uint16_t merged_into = 0;  // label, 0: none
    };

    /// Two regions that lie side by side somewhere.
    struct Touch {
        std::uint16_t a = 0, b = 0;  // labels, a < b
        int linked = 0;              // pairs of linked cells
        int side_by_side = 0;        // pairs of neighbouring cells
        double cost = -1;            // of merging them: < 1 is good, negative: not known
    };

    /// How a region departs from its plane.
    struct Bend {
        double turn = 0;       // of the normal from end to end, radians
        double rise = 0;       // of the middle over the ends, metres
        double explained = 0;  // share of the cells' squared distances that it accounts for
    };
    /// Edges of a region's cells that lead out of it.
    struct Border {
        int length = 0, smooth = 0;
    };

    void find_links(const CellMap& map);
    void rank_seeds(const CellMap& map);
    void grow_from(const CellMap& map, int seed, double min_pixels);
    void settle_borders(const CellMap& map);
    void merge_regions(const CellMap& map);
    void drop_thin(const CellMap& map);
    void drop_curved(const CellMap& map);
    void remove(std::uint16_t label);
    void find_smooth_borders(const CellMap& map);
    void keep_large(double min_pixels);

    bool accepts(const InverseDepthPlane& plane, const Cell& cell) const;
    double merge_cost(const Touch& touch, const CellMap& map) const;
    Bend bend_of(const CellMap& map, std::uint16_t label) const;
    bool is_curved(const CellMap& map, std::uint16_t label) const;
    void find_touching(const CellMap& map);
    void gather_touching();
    void resum(const CellMap& map);
    std::uint16_t root(std::uint16_t label) const;

    CellOptions options_;
    std::vector<std::uint8_t> links_;  // bit k: neighbour k (right, down, left, up) continues the surface
    std::vector<InverseDepthSums> block_sums_;
    std::vector<int> seeds_, queue_;
    std::vector<std::pair<float, int>> ranking_;
    std::vector<std::uint16_t> label_of_cell_;
    std::vector<Region> regions_;
    std::vector<Touch> touching_;
    std::vector<Border> borders_;
    std::vector<int> squares_;  // two by two cells, of each region
    std::vector<InverseDepthPlane> planes_;
};

}  // namespace planemap
