// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "core/sight.hpp"
#include "map/free_space.hpp"

namespace planemap::map {

/// A view of the map, and what of it bounds the room.
struct OccludingView {
    const Viewpoint* viewpoint;
    std::vector<int> planes;           ///< of each region that its sight shows: id of the map plane, -1: none
    std::vector<std::uint8_t> bounds;  ///< whether that is a floor, a ceiling or a wall
};

/// Rows and columns of blocks, the last ones included.
struct BlockRange {
    int x0 = 0, y0 = 0, x1 = -1, y1 = -1;

    bool holds(int x, int y) const { return x >= x0 && x <= x1 && y >= y0 && y <= y1; }
    int width() const { return x1 - x0 + 1; }
    int height() const { return y1 - y0 + 1; }
};

/// What views say of places of a plane that are not in its outline, block by block of a raster in it. They
/// are asked when somebody wants to know.
class HiddenBlocks {
  public:
    enum class Place : std::uint8_t {
        kUnasked,
        kUnknown,  ///< nobody looked there, or a floor, a ceiling or a wall is before it
        kHidden,   ///< something else stands before it in the views that looked there
        kOpen,     ///< a view saw past it
    };

    /// Blocks of a plane with the id, square and aligned to the origin of the raster, whose z is the plane's
    /// normal. `views`, the newest first, must outlive this; further off than `range_m` they see nothing.
    HiddenBlocks(const Pose& world_from_raster, int plane_id, const BlockRange& range, double block_m,
                 const std::vector<OccludingView>& views, double range_m);

    Place at(int x, int y);

  private:
    /// A view that may see a part of the plane; the raster's origin and axes in its camera.
    struct Asked {
        const OccludingView* view;
        Eigen::Vector3d origin, x, y, normal;
    };
    std::size_t tile_at(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles_across_) +
               static_cast<std::size_t>(x);
    }
    void add_to_tiles(const Asked& asked, const Pose& camera_from_raster);
    Place ask(const Eigen::Vector2d& middle, const std::vector<std::uint32_t>& views) const;

    int plane_id_;
    BlockRange range_;
    double block_m_, range_m_;
    PastRules past_;
    std::vector<Asked> asked_;
    int tiles_across_ = 0;
    std::vector<std::vector<std::uint32_t>> tiles_;  ///< which of them may see it
    std::vector<Place> places_;
};

}  // namespace planemap::map
