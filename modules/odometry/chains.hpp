// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

namespace planemap::odometry {

/// Which keyframes share an odom frame. A loss begins another; who is found again later is in the frame of
/// the keyframe that found it.
class Chains {
  public:
    /// A keyframe, and the one that its edge leads from (-1: none). Ids ascend. Returns its chain: the id of
    /// the first keyframe of its odom frame; -1 where that is no longer known.
    int add(int id, int previous_id);
    /// A keyframe of a process before.
    void remember(int id, int chain);
    /// Of a keyframe; -1: not known.
    int of(int id) const;

  private:
    std::map<int, int> runs_;  ///< first id of those in a row that are of one chain: the chain
};

}  // namespace planemap::odometry
