// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>

#include "core/keyframe.hpp"
#include "core/look.hpp"
#include "core/replacement.hpp"
#include "octomap/kept_keyframes.hpp"
#include "octomap/stored_scan.hpp"

namespace planemap::octomap {

/// Depth images of keyframes and looks from when they come until a trajectory says where they belong.
class WaitingScans {
  public:
    /// Keyframes, and looks, that wait at most: as many as the graph's own queue holds.
    static constexpr std::size_t kMost = 256;

    /// Takes a scan that has its place.
    using Taker = std::function<void(ScanId id, const std::shared_ptr<const StoredScan>& scan,
                                     const Pose& world_from_camera, const ScanAnchor& anchor)>;

    /// Keyframes that came before the process was started again.
    void resume(std::map<int, std::shared_ptr<const StoredScan>> keyframes) {
        keyframes_ = std::move(keyframes);
    }
    /// A keyframe came: what is said of it before its scan is known.
    void announce(int keyframe_id);
    /// False: that is one more than may wait, and the one of the lowest id went.
    bool add_keyframe(int id, std::shared_ptr<const StoredScan> scan);
    /// A look since the newest keyframe that came. False: that is one more than may wait, and the oldest
    /// went.
    bool add_look(const Look& look, std::shared_ptr<const StoredScan> scan);

    /// Gives the keyframes that the trajectory names, in its order. The looks that they were waiting for are
    /// next: give_looks().
    void give_keyframes(const KeyframeTrajectory& trajectory, const Taker& take);
    /// Gives, in their order, the looks whose keyframe has a pose and does not wait any more.
    void give_looks(const Taker& take);
    /// Where keyframes lie now is of no use any more, and the looks that wait go.
    void start_over();

    std::size_t keyframes() const { return keyframes_.size(); }
    /// Of the keyframes that wait, those of these ids.
    std::size_t keyframes_among(const std::set<int>& ids) const;
    void clear_keyframes() { keyframes_.clear(); }

  private:
    struct WaitingLook {
        ScanId id;
        ScanAnchor anchor;
        std::shared_ptr<const StoredScan> scan;
    };

    std::map<int, std::shared_ptr<const StoredScan>> keyframes_;  ///< by id
    std::deque<WaitingLook> looks_;
    KeyframePoses poses_;  ///< by the trajectories
    int newest_id_ = -1;   ///< of the keyframes that came
    int looks_since_ = 0;  ///< the newest one
};

}  // namespace planemap::octomap
