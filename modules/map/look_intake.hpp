// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>

#include "core/look.hpp"
#include "map/heirs.hpp"
#include "map/map_losses.hpp"
#include "map/region_intake.hpp"
#include "map/stored_keyframe.hpp"

namespace planemap::map {

/// What became of a look: the keyframe's view that it is part of, and how many looks more saw that; none
/// where its keyframe is not known, or nothing is new in it.
struct Looked {
    StoredKeyframe* view = nullptr;
    int more = 0;
    bool is_news = false;
    int keyframe_id = -1;  ///< of the keyframe that it is from near of
};

/// Takes looks in to the keyframes that they are from near of, or to what took the place of those.
class LookIntake {
  public:
    using Keyframes = std::map<int, StoredKeyframe>;  ///< by id

    /// Regions that reach further than max_extent_m / 2 from their middle are refused.
    explicit LookIntake(double max_extent_m) : regions_(max_extent_m) {}

    /// Gives the look to its keyframe. Counts it as refused where that is not among them, or where the view
    /// is not known that it would be more looks of.
    Looked add(const Look& look, Keyframes& keyframes, MapLosses& losses) const;
    /// Whether the look's keyframe is among them, or one that took its place.
    bool knows(const Look& look, Keyframes& keyframes) const {
        return anchor_of(look, keyframes).keyframe != nullptr;
    }

    /// Looks of a keyframe that went are looks from near this one, at their poses now, from here on.
    /// Precondition: both have a pose.
    void redirect(const StoredKeyframe& gone, const StoredKeyframe& heir) { heirs_.add(gone, heir); }
    /// Takes what another one was told of keyframes that went. Precondition: no id went in both.
    void absorb(LookIntake&& other);

    /// On the heap.
    std::size_t memory_bytes() const { return heirs_.memory_bytes(); }

  private:
    /// The keyframe that a look is from near of, and where about it; nullptr where none is known.
    struct Anchor {
        StoredKeyframe* keyframe = nullptr;
        Pose keyframe_from_camera = Pose::Identity();
    };
    Anchor anchor_of(const Look& look, Keyframes& keyframes) const;

    RegionIntake regions_;
    Heirs heirs_;
};

}  // namespace planemap::map
