// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <vector>

#include "core/keyframe.hpp"
#include "core/look.hpp"
#include "map/look_intake.hpp"
#include "map/map_losses.hpp"
#include "map/region_intake.hpp"
#include "map/stored_keyframe.hpp"

namespace planemap::map {

/// Whether no keyframe of this id can be: more than 10,000 would lie between it and the newest (-1: none
/// yet).
constexpr bool is_far_ahead(int id, int newest_id) {
    constexpr std::int64_t kMostMissed = 10000;
    return newest_id >= 0 && id - std::int64_t{newest_id} > kMostMissed;
}

/// The keyframes that the map is made of, and all poses that are known, whichever comes first. A keyframe is
/// in the map once it has StoredKeyframe::world_from_camera; until then it waits for its pose.
class KeyframeStore {
  public:
    /// Regions that reach further than max_extent_m / 2 from their middle are refused.
    explicit KeyframeStore(double max_extent_m) : intake_(max_extent_m), looks_(max_extent_m) {}

    enum class Arrival {
        kRefused,
        kNew,  ///< it is not in the map yet
    };
    /// Takes what the map needs of a keyframe, its largest regions first. Counts what it refuses, one that
    /// came before, too: who sends it again has nothing new to say.
    Arrival add(const Keyframe& keyframe, MapLosses& losses);
    /// See LookIntake.
    Looked add(const Look& look, MapLosses& losses) { return looks_.add(look, keyframes_, losses); }
    /// Whether the look's keyframe is in the store, or one that took its place.
    bool knows(const Look& look) { return looks_.knows(look, keyframes_); }
    /// Takes the pose of one keyframe; one that is none, or too far out, is ignored.
    void set_pose(int id, const Pose& world_from_camera);

    /// How far keyframes of the map are from where new poses put them.
    struct Motion {
        bool any = false;
        bool of_note = false;  ///< beyond the limits
    };
    struct MotionLimits {
        double distance_m = 0, angle_rad = 0;
    };
    /// Takes the poses of a trajectory; keyframes of the map stay where they are in it until place() is
    /// called.
    Motion update(const std::vector<KeyframePose>& named, const MotionLimits& limits, MapLosses& losses);

    /// Keyframes of the map that the trajectory before named and this one does not (replacements()) leave it;
    /// returns them. As long as there are others in the map to take over: else they stay. Call it before
    /// update().
    std::vector<StoredKeyframe> take_replaced(const std::vector<KeyframePose>& named);
    /// Looks of a keyframe that went are looks from near this one, at their poses now, from here on.
    void redirect_looks(const StoredKeyframe& gone, const StoredKeyframe& heir) {
        looks_.redirect(gone, heir);
    }
    /// The keyframes in the map nearest to a pose (a radian counts as a metre), the nearest first.
    std::vector<StoredKeyframe*> nearest(const Pose& world_from_camera, std::size_t count);

    /// Puts a keyframe of the store where its pose says; nullptr if that is not known.
    StoredKeyframe* place(int id);
    /// The same for all of them.
    void place_all();
    bool is_waiting(int id) const;
    std::size_t waiting() const;
    /// Lets the oldest waiting ones go until at most `most` wait; returns how many went.
    std::size_t drop_waiting(std::size_t most);

    /// Takes all that another store has: keyframes, where they were and are, and what is known of those that
    /// went. Precondition: no id is in both.
    void absorb(KeyframeStore&& other);

    /// Lets the oldest keyframe go for good: it and those before it are refused from now on.
    void retire_oldest();

    std::map<int, StoredKeyframe>& keyframes() { return keyframes_; }
    const std::map<int, StoredKeyframe>& keyframes() const { return keyframes_; }
    /// Of all keyframes named so far, in the store or not; world_from_camera by id.
    const std::map<int, Pose>& poses() const { return poses_; }
    /// Ids of the keyframes that saw each plane, ascending, by the plane's id.
    std::map<int, std::vector<int>> sightings() const;
    /// Bytes of all that is kept, on the heap.
    std::size_t memory_bytes() const;

  private:
    RegionIntake intake_;
    std::map<int, StoredKeyframe> keyframes_;  ///< by id
    std::map<int, Pose> poses_;
    std::vector<KeyframePose> named_;  ///< by the last trajectory
    LookIntake looks_;
    int newest_id_ = -1;                                   ///< the largest id of a keyframe so far
    int retired_up_to_ = std::numeric_limits<int>::min();  ///< keyframes up to this id are gone for good
};

}  // namespace planemap::map
