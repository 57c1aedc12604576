// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>

#include "core/geometry/pose.hpp"
#include "graph/ties.hpp"

namespace planemap::graph {

/// Who stands for a keyframe that went.
struct Successor {
    int keeper_id = -1;
    Pose keeper_from_gone = Pose::Identity();
    Drift drift;  ///< between the two
};

/// What became of keyframes that went and that odometry may yet name: the 512 of the highest ids.
class Successors {
  public:
    /// The keyframe goes, and those that it stood for go over to its successor.
    void add(int gone_id, const Successor& successor);
    /// The one that stands for a keyframe that went; nullptr when it did not, or long ago.
    const Successor* of(int gone_id) const;
    std::size_t memory_bytes() const { return gone_.size() * sizeof(std::pair<int, Successor>); }

  private:
    std::map<int, Successor> gone_;  ///< by id
};

}  // namespace planemap::graph
