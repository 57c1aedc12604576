// SPDX-License-Identifier: BSD-3-Clause
// What becomes of keyframes that the graph lets go.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "core/keyframe.hpp"

namespace planemap {

/// A keyframe that a trajectory no longer names, and where it stood, seen from one that is still named.
struct Replacement {
    int id = -1;
    int by = -1;
    Pose by_from_id = Pose::Identity();
};

/// The keyframes that a trajectory names and the next one does not, each with the nearest of those that both
/// name and that it hung together with (a radian counts as a metre), as they stood in the first. None when
/// they share no keyframe: then the second is another graph's, and says nothing about the first.
std::vector<Replacement> replacements(const std::vector<KeyframePose>& before,
                                      const std::vector<KeyframePose>& now);

/// Where keyframes stand after each trajectory, also those that it no longer names: these stay fixed to the
/// one that they were replaced by, or, when that goes too, to its own replacement.
class KeyframePoses {
  public:
    void update(const std::vector<KeyframePose>& named);
    /// world_from_camera; nothing for a keyframe that no trajectory named, and when the one that it was fixed
    /// to is gone without a replacement.
    std::optional<Pose> pose_of(int id) const;
    /// KeyframePose::component, of those that have a pose.
    std::optional<int> component_of(int id) const;
    /// Forgets the replaced keyframes that nobody asks for any more: what bounds the memory of a long run.
    void keep_replaced(const std::function<bool(int id)>& is_wanted);

  private:
    const KeyframePose* named(int id) const;
    /// The named one that a keyframe is, or is fixed to; nullptr for none.
    const KeyframePose* keeper(int id) const;

    std::vector<KeyframePose> named_;      ///< ascending id
    std::map<int, Replacement> replaced_;  ///< by id; each by one that was named when it was replaced
};

}  // namespace planemap
