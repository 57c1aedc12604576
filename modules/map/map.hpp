// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/camera.hpp"
#include "core/keyframe.hpp"
#include "core/plane_map.hpp"
#include "map/evidence_grid.hpp"

namespace planemap {

struct MapOptions {
    double merge_angle_deg = 10;     ///< largest angle between merged regions (paper section 2.3)
    double merge_distance_m = 0.05;  ///< largest distance between their planes, where they are (section 2.3)
    double merge_gap_m = 0.5;        ///< largest gap between their boxes (section 2.3)

    DepthNoise noise;            ///< of the depth sensor: a far, noisy view weighs less in a plane's fit
    double pose_sigma_m = 0.01;  ///< error of keyframe poses; below it, less sensor noise gains no weight

    double outline_cell_m = 0.025;      ///< raster on which a plane's shape is collected
    double outline_tolerance_m = 0.03;  ///< simplification of the outline
    double outline_min_ring_m2 = 0.01;  ///< smaller parts and holes of an outline are left out
    int outline_min_views = 1;          ///< keyframe regions that must have covered a cell

    double adjacency_gap_m = 0.15;     ///< planes meet where both outlines come this near to the common line
    double adjacency_angle_deg = 15;   ///< flatter pairs get no intersection line
    double adjacency_length_m = 0.15;  ///< shorter intersection lines are left out

    double min_area_m2 = 0.05;  ///< smaller planes are kept, but are not in map()
    int min_keyframes = 1;      ///< planes seen by fewer keyframes are kept, but are not in map()

    double moved_m = 0.002;     ///< keyframes that moved less than this,
    double moved_deg = 0.05;    ///< and turned less than this, do not cause a rebuild
    double max_extent_m = 200;  ///< a plane does not grow longer than this

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Builds the map of planes from keyframes and their poses (paper section 2.3).
///
/// A keyframe's regions enter the map when both the keyframe and a pose for it are known, whichever comes
/// first; regions are kept in the camera frame, so that the map can be rebuilt exactly when poses change. The
/// map is always that of the known keyframes taken in ascending id, whatever the order of arrival. Within a
/// keyframe, regions enter by falling number of inliers. After each one, planes that satisfy the merging
/// rules are merged until no pair is left that does.
///
/// Merged moments are exact. The plane itself is the fit to them in which each view is weighted by
/// pose_sigma^2 / (pose_sigma^2 + sigma(z)^2), z being its mean depth.
class PlaneMapper {
  public:
    /// Throws std::invalid_argument for bad options.
    explicit PlaneMapper(MapOptions options = {});

    /// Takes a keyframe; it waits if no trajectory has named its pose yet. Regions that are invalid
    /// (is_valid(PlanarRegion)), whose moments determine no plane, or that are larger than max_extent_m are
    /// counted in rejected() and left out. A keyframe with a known id replaces the earlier one.
    void add(const Keyframe& keyframe);
    /// Takes a keyframe with its pose; an invalid pose is ignored and the keyframe waits.
    void add(const Keyframe& keyframe, const Pose& world_from_camera);

    /// Takes new poses: waiting keyframes named in it enter the map, and if earlier ones moved, the map is
    /// rebuilt. Keyframes it does not name keep their pose; invalid poses are ignored.
    void update(const KeyframeTrajectory& trajectory);

    /// The map after the last call.
    const PlaneMap& map() const { return map_; }
    /// Ids of the keyframes that saw each plane, ascending, by the plane's id.
    std::map<int, std::vector<int>> sightings() const;
    /// Bytes of the map itself: all that map() holds, by capacity, without the keyframes kept for rebuilding
    /// and without the rasters of the outlines.
    std::size_t memory_bytes() const;
    /// Bytes of what is kept to go on mapping: keyframe regions and rasters, by capacity, roughly.
    std::size_t working_bytes() const;

    /// Keyframes that have no pose yet.
    std::size_t waiting() const;
    /// Regions left out so far.
    std::size_t rejected() const { return rejected_; }
    /// How often the whole map was rebuilt.
    std::size_t rebuilds() const { return rebuilds_; }

  private:
    /// A keyframe as it is kept.
    struct Stored {
        std::int64_t utime = 0;
        std::vector<PlanarRegion> regions;      ///< camera frame, by falling number of inliers
        std::vector<int> planes;                ///< id each region went to; follow merged_into_ from there
        std::optional<Pose> world_from_camera;  ///< the pose it is in the map with
    };

    /// A region's outline on its way into a plane's shape.
    struct Patch {
        const PlanarRegion* region_camera;  ///< in keyframes_
        Pose world_from_camera;
    };

    /// A plane while it grows. World frame.
    struct Surface {
        int id = -1;
        Plane plane;
        Moments moments;                    ///< exact
        Moments weighted;                   ///< each view by its weight; the plane is their fit
        Eigen::Vector3d facing;             ///< weighted sum of the views' normals: which side was seen
        Box box;                            ///< bounds the hull
        std::vector<Eigen::Vector3d> hull;  ///< convex hull of all outlines
        EvidenceGrid grid;                  ///< the shape, as of the last refresh()
        std::vector<Patch> patches;         ///< to be drawn into the grid
        std::vector<int> keyframes;         ///< ids, ascending
        bool changed = true;                ///< since map_ was derived
    };

    bool is_usable(const PlanarRegion& region) const;
    double weight(const PlanarRegion& region_camera) const;
    std::optional<Surface> make_surface(const PlanarRegion& region_camera, const Pose& world_from_camera,
                                        int keyframe_id) const;
    void place(int keyframe_id);
    void integrate(int keyframe_id);
    int insert(Surface surface);
    std::optional<std::size_t> best_partner(std::size_t index) const;
    void absorb(Surface& into, Surface&& from) const;
    void refit(Surface& surface) const;
    void draw(Surface& surface) const;
    bool in_order(int keyframe_id) const;
    int resolved(int plane_id) const;
    void rebuild();
    void keep_ids(const std::map<int, std::vector<int>>& planes_before, int first_new_id);
    void refresh();
    MapPlane derive(const Surface& surface) const;
    void refresh_intersections(const std::vector<int>& changed_ids);

    MapOptions options_;
    std::map<int, Pose> poses_;        ///< world_from_camera of all keyframes named so far
    std::map<int, Stored> keyframes_;  ///< by id
    std::vector<Surface> surfaces_;
    std::map<int, int> merged_into_;  ///< plane ids that went up in another one
    int next_id_ = 0;
    PlaneMap map_;
    std::size_t rejected_ = 0, rebuilds_ = 0;
};

}  // namespace planemap
