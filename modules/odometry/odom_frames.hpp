// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "core/geometry/pose.hpp"
#include "core/keyframe.hpp"

namespace planemap::odometry {

/// The odom frames of the chains of keyframes (one begins at each loss), and how they lie about the first
/// one: which a trajectory says, when loop closures have joined them.
class OdomFrames {
  public:
    /// A keyframe of ours; the first of each odom frame counts.
    void add(const Keyframe& keyframe);
    /// What the graph says of keyframes, ours and others'.
    void hear(const KeyframeTrajectory& trajectory);

    /// Whether a trajectory would tell what is not known yet.
    bool wants_trajectory(bool wants_world) const { return first_ && (wants_world || !apart_.empty()); }
    /// first_from_odom of a chain; nullopt: not known.
    std::optional<Pose> first_from(int chain) const;
    /// Of the first odom frame; nullopt: not known.
    const std::optional<Pose>& odom_from_world() const { return odom_from_world_; }

  private:
    /// The first keyframe of an odom frame, by which a trajectory says how that lies in the world.
    struct Start {
        int id;
        std::int64_t utime;
        Pose odom_from_camera;
    };
    std::optional<Start> first_;
    int first_chain_ = -1;                 ///< of that one
    std::map<int, Start> apart_;           ///< by chain: those of which it is not known how they lie
    std::map<int, Pose> first_from_odom_;  ///< by chain: those of which it is; the newest
    std::optional<Pose> odom_from_world_;
};

}  // namespace planemap::odometry
