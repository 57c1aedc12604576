// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/camera.hpp"
#include "core/keyframe.hpp"
#include "core/option_list.hpp"
#include "core/plane_map.hpp"
#include "core/replacement.hpp"
#include "map/intersections.hpp"
#include "map/surface.hpp"

namespace planemap {

/// Options of PlaneMapper; options_of() says what each is.
struct MapOptions {
    double merge_angle_deg = 10;
    double merge_distance_m = 0.05;
    double merge_gap_m = 0.5;

    double pose_sigma_m = 0.02;
    double agreement_m = 0.01;

    double outline_cell_m = 0.025;
    double outline_tolerance_m = 0.04;
    double outline_min_ring_m2 = 0.01;
    double see_through_m = 0.05;

    double adjacency_gap_m = 0.15;
    double adjacency_angle_deg = 15;
    double adjacency_length_m = 0.25;

    double min_area_m2 = 0.05;
    double min_single_m2 = 0.25;
    int min_keyframes = 1;

    double moved_m = 0.002;
    double moved_deg = 0.05;
    double max_extent_m = 200;
    int fold_after = 0;
    int threads = 2;

    /// Fixed: the evidence that a cell of an outline needs; a far view gives 1, a near one up to 4.
    static constexpr int outline_min_hits = 1;

    /// Throws std::invalid_argument that names every bad field.
    void validate() const;
};

/// Refers to `options`, which must outlive it.
OptionList options_of(MapOptions& options);

/// What a mapper left out, by the reason.
struct MapLosses {
    std::size_t regions_refused = 0;   ///< not valid, without a plane, or larger or farther than can be seen
    std::size_t regions_too_many = 0;  ///< of one keyframe, after the 256th
    std::size_t regions_too_far = 0;   ///< more than 100 km from the world's origin
    std::size_t planes_refused = 0;    ///< of start_from()
    std::size_t poses_refused = 0;     ///< of trajectories: no pose, or more than 100 km away
    std::size_t keyframes_unplaced = 0;   ///< that waited for a pose while 4096 newer ones came
    std::size_t keyframes_too_late = 0;   ///< that came again after they were folded
    std::size_t keyframes_far_ahead = 0;  ///< with an id more than 10,000 after the largest one
    std::size_t keyframes_of_others = 0;  ///< with the id of one in the map, and another time
};

/// Builds the map of planes from keyframes and their poses (paper section 2.3).
///
/// A keyframe's regions enter the map when both the keyframe and a pose for it are known, whichever comes
/// first; regions are kept in the camera frame, so that the map can be rebuilt exactly when poses change.
/// While keyframes arrive, each region joins the plane it fits best by the merging rules, and planes that
/// have come to satisfy the rules are merged. A rebuild takes the regions of all keyframes in an order of
/// their own, the weightiest first, so that the map after settle() or a correction does not depend on the
/// order in which keyframes came, nor on what the poses were before.
///
/// Merged moments are exact. The plane itself is the fit to them in which each view is weighted by
/// pose_sigma^2 / (pose_sigma^2 + sigma(z)^2), z being its mean depth, and less the less it agrees with the
/// plane so far: what merges by the rules but lies some centimetres off does not pull the plane along. Its
/// shape counts, for each cell, views (a near one up to four times) and how often the cell was looked
/// through.
class PlaneMapper {
  public:
    /// Throws std::invalid_argument for bad options.
    explicit PlaneMapper(MapOptions options = {});

    /// Starts from a finished map, in its world frame: its planes keep their ids and grow on. Call it first.
    /// Planes that are larger than max_extent_m, or further out than 100 km, count in rejected(). The shapes
    /// of a very large map go on in coarser cells, the largest first, so that its rasters take 128 MB (a
    /// rebuild holds them three times); such planes count in coarsened().
    void start_from(const PlaneMap& map);

    /// Takes a keyframe; it waits if no trajectory has named its pose yet. Regions that are invalid
    /// (is_valid(PlanarRegion)), whose moments determine no plane, that reach further than 25 m or
    /// max_extent_m / 2 from their middle, and those after the 256th are counted in rejected() and left out.
    /// A keyframe with a known id replaces the earlier one.
    void add(const Keyframe& keyframe);
    /// Takes a keyframe with its pose; an invalid pose is ignored and the keyframe waits.
    void add(const Keyframe& keyframe, const Pose& world_from_camera);

    /// Takes new poses: waiting keyframes named in it enter the map, and if earlier ones moved, the map is
    /// rebuilt. Invalid poses are ignored. Keyframes that no trajectory named keep their pose. One that the
    /// last trajectory named and this one does not was replaced by others of its place (replacements()): what
    /// it saw goes over to the nearest eight of those, see hand_over().
    void update(const KeyframeTrajectory& trajectory);

    /// Brings the map into the form that does not depend on the order of arrival; for the end of a run, or a
    /// pause. Does nothing if nothing came since the last rebuild.
    void settle();

    /// The map after the last call.
    const PlaneMap& map() const { return map_; }
    /// Bytes of the map itself: all that map() holds, by capacity, without the keyframes kept for rebuilding
    /// and without the rasters of the outlines.
    std::size_t memory_bytes() const { return planemap::memory_bytes(map_); }
    /// Bytes of what is kept to go on mapping: keyframe regions and rasters, by capacity, roughly.
    std::size_t working_bytes() const;

    /// Exact moments of a plane's points, world frame; zero for an unknown id, and of a plane of start_from()
    /// those of points spread evenly over it.
    Moments moments(int plane_id) const;
    /// Ids of the keyframes that saw each plane, ascending, by the plane's id.
    std::map<int, std::vector<int>> sightings() const;
    /// Keyframes that have no pose yet: at most 4096, then the oldest is dropped.
    std::size_t waiting() const;
    std::size_t dropped() const { return losses_.keyframes_unplaced; }
    /// Regions and planes left out so far.
    std::size_t rejected() const {
        return losses_.regions_refused + losses_.regions_too_many + losses_.planes_refused;
    }
    const MapLosses& losses() const { return losses_; }
    /// Keyframes that are kept, and those whose regions went over to others.
    std::size_t keyframes() const { return keyframes_.size(); }
    std::size_t replaced() const { return replaced_; }
    /// Planes of start_from() whose shape goes on in cells coarser than outline_cell_m.
    std::size_t coarsened() const { return coarsened_; }
    /// True if so many planes meet one another that map() does not hold all points where three do.
    bool left_out_corners() const { return left_out_corners_; }
    /// Keyframes whose regions were folded into the planes (MapOptions::fold_after).
    std::size_t folded() const { return folded_; }
    /// How often the whole map was rebuilt.
    std::size_t rebuilds() const { return rebuilds_; }

  private:
    /// A keyframe in the map as one looks through its eyes.
    struct View {
        const StoredKeyframe* keyframe;
        Pose camera_from_world;
        std::vector<Plane> planes;  ///< of its regions, camera frame

        explicit View(const StoredKeyframe& seen);
    };
    /// Where on a surface's grid a view may fall.
    struct Footprint {
        Pose camera_from_grid;
        Eigen::Vector2d low, high;
    };
    /// A region on its way into a surface's shape.
    struct DrawnRegion {
        const StoredKeyframe* keyframe;
        std::size_t region;
        Pose world_from_box;
    };
    bool is_usable(const PlanarRegion& region) const;
    double weight(const StoredRegion& region, const DepthNoise& noise) const;
    Reliability reliability(const StoredRegion& region, const DepthNoise& noise) const;
    int strength(const StoredRegion& region, const DepthNoise& noise) const;
    void drop_waiting();
    void place(int keyframe_id);
    std::size_t join(SurfaceSet& set, const PlacedRegion& placed, const StoredRegion& region,
                     const StoredKeyframe& keyframe);
    Surface surface_of(int id, const PlacedRegion& placed, const StoredRegion& region,
                       const StoredKeyframe& keyframe);
    void take_in(Surface& surface, const PlacedRegion& placed, const StoredRegion& region,
                 const StoredKeyframe& keyframe);
    void draw(Surface& surface, const PlacedRegion& placed, const StoredRegion& region,
              const StoredKeyframe& keyframe, int keyframe_id);
    void integrate(int keyframe_id);
    void look_through(Surface& surface, const View& view, std::vector<EvidenceGrid::Block>& blocks) const;
    void look_through(Surface& surface, const std::vector<View>& views) const;
    std::optional<Footprint> footprint_of(const Surface& surface, const View& view) const;
    void doubt(Surface& surface, const View& view, const Footprint& footprint,
               const std::vector<EvidenceGrid::Block>& blocks) const;
    void merge(const std::vector<std::size_t>& grown);
    int resolved(int plane_id) const;
    void fold();
    void replace(const std::vector<Replacement>& gone);
    std::vector<StoredKeyframe*> heirs_of(const StoredKeyframe& gone);
    void unite_fixed(const std::vector<int>& ids);
    void rebuild();
    void redraw(Surface& surface, const std::vector<DrawnRegion>& regions, const std::vector<View>& views);
    void keep_ids(const std::map<int, std::vector<int>>& planes_before, int first_new_id);
    void count_keyframes();
    void refresh();
    bool derive(Surface& surface, std::optional<MapPlane>& plane) const;
    void name();
    template <typename IsChanged>
    void add_corners(const AdjacencyRules& rules, IsChanged is_changed);
    void refresh_intersections(const std::vector<int>& changed_ids);

    MapOptions options_;
    std::map<int, Pose> poses_;                ///< world_from_camera of all keyframes named so far
    std::vector<KeyframePose> named_;          ///< by the last trajectory
    int newest_id_ = -1;                       ///< the largest id of a keyframe so far
    std::map<int, StoredKeyframe> keyframes_;  ///< by id
    std::vector<Surface> fixed_;               ///< planes that no keyframe can move any more
    SurfaceSet set_;
    std::map<int, int> merged_into_;    ///< plane ids that went up in another one
    std::map<int, PlaneShape> shapes_;  ///< of map_'s planes
    int next_id_ = 0;
    int folded_up_to_ = std::numeric_limits<int>::min();  ///< keyframes up to this id are folded
    PlaneMap map_;
    FlatPolygon polygon_;  ///< scratch
    MapLosses losses_;
    bool left_out_corners_ = false;
    std::size_t coarsened_ = 0, folded_ = 0, replaced_ = 0, rebuilds_ = 0;
    bool settled_ = true;
};

}  // namespace planemap
