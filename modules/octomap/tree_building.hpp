// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>

#include "core/keyframe.hpp"
#include "octomap/octomap_builder.hpp"
#include "octomap/octomap_worker.hpp"

namespace planemap::octomap {

/// Where the OctoMap is built.
enum class Building {
    kInHandler,     ///< as messages come; rebuilt at the end only: the same input gives the same bytes
    kInBackground,  ///< on another thread; messages do not wait
};

/// An OctoMap under construction, on whichever thread: the same calls in the same order for both.
class TreeBuilding {
  public:
    /// Throws std::invalid_argument for bad options.
    TreeBuilding(const OctomapOptions& options, Building building);
    /// Abandons what the background is at; does not wait until the memory is given back.
    ~TreeBuilding();
    TreeBuilding(const TreeBuilding&) = delete;
    TreeBuilding& operator=(const TreeBuilding&) = delete;

    bool is_in_background() const { return worker_ != nullptr; }
    /// Precondition: built in the handler, or the background has finished.
    OctomapBuilder& builder() { return *builder_; }

    /// A trajectory came: between begin and end, the scans that it gave a pose are added.
    void begin_update(const KeyframeTrajectory& trajectory);
    void end_update(const KeyframeTrajectory& trajectory);
    /// False if the scan is not taken: in the background, because too many wait already; in the handler,
    /// because the builder refuses it.
    bool add(ScanId id, const std::shared_ptr<const StoredScan>& scan, const Pose& world_from_camera,
             const ScanAnchor& anchor);
    /// Begins anew with an empty tree. Returns how many keyframes were in it, or waited for it.
    std::size_t start_over();

    /// In the background: its newest state, once.
    std::optional<OctomapState> newer_state();
    /// In the handler: everything is brought up to date, and how it stands then.
    OctomapState state_up_to_date();
    /// In the background: waits until it is up to date, but not longer than this. It is not built on
    /// afterwards.
    void finish(std::chrono::milliseconds patience);

  private:
    OctomapOptions options_;
    std::unique_ptr<OctomapBuilder> builder_;
    std::unique_ptr<OctomapWorker> worker_;  ///< null when built in the handler
    std::int64_t utime_ = 0;                 ///< of the last trajectory
    int revision_ = 0;                       ///< of the same
};

}  // namespace planemap::octomap
