// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/keyframe.hpp"
#include "core/look.hpp"
#include "core/plane_map.hpp"
#include "core/seen_space.hpp"
#include "core/surfaces.hpp"
#include "map/derived_map.hpp"
#include "map/keyframe_store.hpp"
#include "map/map_losses.hpp"
#include "map/map_work.hpp"
#include "map/options.hpp"
#include "map/planes.hpp"
#include "map/seen_through.hpp"
#include "map/told_up.hpp"

namespace planemap::map {

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
/// shape counts, for each cell, views (a near one up to four times) and keyframes that saw past it.
///
/// Who owns what: keyframes and poses KeyframeStore, estimates of the planes and their ids Planes, the map
/// that is derived from them DerivedMap. This class says when they do what.
class PlaneMapper {
  public:
    /// Throws std::invalid_argument for bad options. Mappers that may become one (absorb()) are given the
    /// same `ids` and `told`.
    explicit PlaneMapper(const MapOptions& options = {}, PlaneIds ids = {},
                         std::shared_ptr<ToldUp> told = std::make_shared<ToldUp>());

    /// Starts from a finished map, in its world frame: its planes keep their ids and grow on. Call it first.
    /// Planes that are larger than max_extent_m, or further out than 100 km, count as lost. The shapes
    /// of a very large map go on in coarser cells, the largest first, so that its rasters take 128 MB (a
    /// rebuild holds them twice); such planes count in MapWork. What was seen to be empty stays so.
    void start_from(const PlaneMap& map, const SeenSpace& seen = {});

    /// Takes a keyframe; it waits if no trajectory has named its pose yet. Regions that are invalid
    /// (is_valid(PlanarRegion)), whose moments determine no plane, that reach further than 25 m or
    /// max_extent_m / 2 from their middle, and those after the 256th are counted in losses() and left out.
    /// A keyframe with a known id replaces the earlier one.
    void add(const Keyframe& keyframe);
    /// Takes a keyframe with its pose; an invalid pose is ignored and the keyframe waits.
    void add(const Keyframe& keyframe, const Pose& world_from_camera);

    /// Takes a look: what it saw, and saw past, is evidence of a time after its keyframe. One whose keyframe
    /// did not come is counted and ignored. Returns whether the map changed by it.
    bool add(const Look& look);
    /// Whether the look's keyframe is one of its own, or went over to one.
    bool knows(const Look& look) { return keyframes_.knows(look); }

    /// Takes new poses: waiting keyframes named in it enter the map, and if earlier ones moved, the map is
    /// rebuilt. Invalid poses are ignored. Keyframes that no trajectory named keep their pose. One that the
    /// last trajectory named and this one does not was replaced by others of its place (replacements()): what
    /// it saw goes over to the nearest eight of those, see hand_over().
    void update(const KeyframeTrajectory& trajectory);

    /// Takes over the keyframes of another mapper, of which a trajectory now says that they hang together
    /// with this one's: the next update(), with that trajectory, makes one map of both. Its planes keep their
    /// ids.
    void absorb(PlaneMapper&& other);

    /// How the camera is mounted on a robot that stands level on average; says which way is up.
    void hear_mount(const Pose& body_from_camera) { told_->hear_mount(body_from_camera); }
    /// What an accelerometer read, before the keyframe of its time comes.
    void hear(const Acceleration& reading) { told_->hear(reading); }
    /// Where map().up is from, or why it is not known: a clause.
    const std::string& why_up() const { return derived_.why_up(); }

    /// Gives planes the ids that they had for another mapper with the same keyframes and poses, by what that
    /// says in surfaces().
    void restore_ids(const Surfaces& surfaces);

    /// Brings the map into the form that does not depend on the order of arrival; for the end of a run, or a
    /// pause. Does nothing if nothing came since the last rebuild.
    void settle();

    /// The map after the last call.
    const PlaneMap& map() const { return derived_.map(); }
    /// Bytes of the map itself: all that map() holds, by capacity, without the keyframes kept for rebuilding
    /// and without the rasters of the outlines.
    std::size_t memory_bytes() const { return planemap::memory_bytes(map()); }
    /// Bytes of what is kept to go on mapping: keyframe regions and rasters, by capacity, roughly.
    std::size_t working_bytes() const;
    /// Of these what keyframes take, which only corrections of their poses need.
    std::size_t keyframe_bytes() const { return keyframes_.memory_bytes(); }

    /// Space that keyframes and looks saw to be empty, see SeenThrough; also those that were folded, and
    /// what the map to start from knew. It is found when asked for, which takes milliseconds a keyframe
    /// (docs/map.md). `goes_on` is asked before each of them: when it says no, space that only others saw is
    /// left unknown. Empty: all of them.
    SeenSpace seen_space(const std::function<bool()>& goes_on = {}) const;

    /// What map() is derived from, with the exact moments of all points, world frame; of a plane of
    /// start_from() those of points spread evenly over it.
    const std::vector<PlaneEstimate>& estimates() const { return planes_.estimates(); }
    /// Which planes the regions of the keyframes in the map are part of, as of the last rebuild or since.
    Surfaces surfaces() const;
    /// Ids of the keyframes that saw each plane, ascending, by the plane's id.
    std::map<int, std::vector<int>> sightings() const { return keyframes_.sightings(); }
    /// Keyframes that have no pose yet: at most 4096, then the oldest is dropped.
    std::size_t waiting() const { return keyframes_.waiting(); }
    const MapLosses& losses() const { return losses_; }
    bool has_keyframe(int id) const { return keyframes_.keyframes().contains(id); }
    /// Keyframes that are kept.
    std::size_t keyframes() const { return keyframes_.keyframes().size(); }
    const MapWork& work() const { return work_; }
    /// True if so many planes meet one another that map() does not hold all points where three do.
    bool left_out_corners() const { return derived_.left_out_points(); }

  private:
    void place(int keyframe_id);
    void fold();
    void hand_over_replaced(const KeyframeTrajectory& trajectory);
    void rebuild();
    void infer();
    void refresh() { derived_.refresh(planes_.estimates(), keyframes_.poses(), *told_); }

    MapOptions options_;
    KeyframeStore keyframes_;
    Planes planes_;
    DerivedMap derived_;
    SeenThrough seen_before_;  ///< of what keyframes_ does not hold any more
    std::shared_ptr<ToldUp> told_;
    MapLosses losses_;
    MapWork work_;
    bool settled_ = true;    ///< nothing came since the last rebuild
    bool absorbed_ = false;  ///< another mapper's keyframes, which are in no plane yet
};

}  // namespace planemap::map
