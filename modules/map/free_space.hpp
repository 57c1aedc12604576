// SPDX-License-Identifier: BSD-3-Clause
// Free-space carving: a keyframe that sees a region beyond a plane says that the plane is not there.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera.hpp"
#include "core/geometry/bitmap.hpp"
#include "core/sight.hpp"
#include "map/plane_estimate.hpp"
#include "map/stored_keyframe.hpp"

namespace planemap::map {

/// A keyframe of the map, or a look, as a camera: where it stands and which planes it sees. It must outlive
/// this.
struct Viewpoint {
    const StoredKeyframe* keyframe;
    Pose camera_from_world;
    std::vector<Plane> planes;  ///< of its regions, camera frame

    /// Precondition: the keyframe has a pose.
    explicit Viewpoint(const StoredKeyframe& seen);

    SeenRegions seen() const { return {keyframe->sight, planes}; }
};

/// Cells of a plane that looks saw.
struct SeenCells {
    std::int64_t utime = 0;  ///< of the last look
    int looks = 1;
    Bitmap cells;
    const StoredKeyframe* view = nullptr;  ///< that saw it; none: it went
};

/// Weighs looks that saw the cells of planes against looks that saw past them.
class FreeSpace {
  public:
    /// A region beyond a cell by more than margin_m, two sigma of the sensor's noise and one per cent of the
    /// range is a miss of the cell.
    explicit FreeSpace(double margin_m) { rules_.margin_m = margin_m; }

    /// `looks` more looks of a viewpoint, after all others.
    void carve(std::vector<PlaneEstimate>& planes, const Viewpoint& viewpoint, int looks) const;
    /// What viewpoints saw past before, the newest first, in blocks of a plane's grid (row after row) that
    /// were not looked at then.
    void carve_before(PlaneEstimate& plane, const std::vector<Viewpoint>& viewpoints,
                      std::vector<EvidenceBlock>& blocks) const;
    /// All that was seen of a plane and past it (support is in its grid already), going back in time: `seen`
    /// and `viewpoints` with the newest first; where both are of one time, the cells were seen last. What the
    /// grid holds was before. A place that many viewpoints saw is asked of the newest ones: so the work
    /// grows with the building.
    void look_back(PlaneEstimate& plane, const std::vector<SeenCells>& seen,
                   const std::vector<Viewpoint>& viewpoints) const;

  private:
    /// Where on a plane's grid a viewpoint's image may fall.
    struct Footprint {
        Pose camera_from_grid;
        Eigen::Vector2d low, high;
    };
    /// The cells of a plane that the regions of a view cover which are part of it.
    static std::vector<Bitmap> own_cells(PlaneEstimate& plane, const StoredKeyframe& view);
    static std::optional<Footprint> footprint_of(const PlaneEstimate& plane, const Viewpoint& viewpoint);
    /// f(block) for those that the viewpoint sees past; what it sees (`own`), and what lies close beside
    /// that, it does not see past.
    template <typename F>
    void for_each_past(const PlaneEstimate& plane, const Viewpoint& viewpoint, const Footprint& footprint,
                       const std::vector<const Bitmap*>& own, std::vector<EvidenceBlock>& blocks,
                       const F& f) const;

    PastRules rules_;
};

}  // namespace planemap::map
