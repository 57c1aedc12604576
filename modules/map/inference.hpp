// SPDX-License-Identifier: BSD-3-Clause
// Floors, ceilings and walls go on behind what stands before them.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/geometry/bitmap.hpp"
#include "core/plane_map.hpp"
#include "map/bound_shapes.hpp"
#include "map/edges.hpp"
#include "map/free_space.hpp"
#include "map/hidden_blocks.hpp"

namespace planemap::map {

/// The part of a plane that is inferred, on a raster of its own in the plane.
struct InferredCells {
    Pose world_from_raster = Pose::Identity();  ///< z is the plane's normal
    double cell_m = 0.025;
    Bitmap cells;
    std::vector<MeetingLine> lines;  ///< at which it ends, in the raster's x and y
};

/// A part of a plane in the x and y of a frame whose z is the normal.
struct PlanePart {
    Pose world_from_frame = Pose::Identity();
    Outline outline;
};

/// Infers the hidden parts of the planes that bound rooms. From the edge of its outline a plane is followed
/// along the axes of its room (level and up; of level planes, those of the largest wall), as long as what
/// stands before it hides it. It goes on so far if its outline begins again there, or if it comes to the line
/// where it meets another of these planes, and that one is seen at this place or, hidden as well, followed
/// away from the line, comes to its own outline. So what nobody looked at, and what somebody looked through,
/// is left out, and nothing goes on beyond a line where planes meet. One object for one time.
class Inference {
  public:
    /// `views`, the newest first, must outlive it. `told` has by id what was inferred from views that are
    /// gone: it counts as hidden where no view knows better.
    Inference(const PlaneMap& map, const std::vector<Viewpoint>& views, const std::map<int, PlanePart>& told,
              double cell_m);

    /// By id, of planes that have such a part.
    std::map<int, InferredCells> infer();

  private:
    struct Cell {
        int x, y;
    };
    /// Where a plane's way behind things ends.
    enum class End { kNowhere, kLine, kSeen };
    /// What is found of a shape.
    struct Hidden {
        HiddenBlocks blocks;
        Bitmap told, inferred;
        std::map<std::size_t, std::pair<double, double>> ends;  ///< from, to, along the line of each `before`
    };

    void take_views(const PlaneMap& map, const std::vector<Viewpoint>& views);
    void follow(std::size_t shape, int dx, int dy);
    End walk(std::size_t shape, Eigen::Vector2d p, const Eigen::Vector2d& step, bool to_lines,
             std::vector<Cell>& path);
    std::optional<End> end_between(std::size_t shape, const Eigen::Vector2d& p, const Eigen::Vector2d& next,
                                   bool to_lines);
    bool comes_to_seen(std::size_t shape, const Eigen::Vector3d& p_world, const Eigen::Vector3d& away);
    InferredCells result(std::size_t shape);

    double cell_m_;
    std::vector<BoundShape> shapes_;
    std::vector<OccludingView> views_;
    std::vector<Hidden> hidden_;  ///< of each shape
};

}  // namespace planemap::map
