// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "core/keyframe.hpp"
#include "messages/channels.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/keyframe_guard.hpp"
#include "messages/keyframe_watch.hpp"
#include "messages/process.hpp"
#include "messages/stream_guard.hpp"
#include "octomap/recent_frames.hpp"
#include "octomap/scan_journal.hpp"
#include "octomap/tree_building.hpp"
#include "octomap/waiting_scans.hpp"

namespace planemap::octomap {

/// Where an OctoMap is kept; empty: nowhere.
struct OctomapFiles {
    std::filesystem::path output;   ///< folder that octomap.bt is written to at the end
    std::filesystem::path journal;  ///< keyframes' depth and poses, for a process that is started again
};

/// The depth of keyframes, and of looks at what changed (OPENNI_FRAME, PLANEMAP_KEYFRAME, PLANEMAP_LOOK), at
/// their poses (PLANEMAP_TRAJECTORY) into an OctoMap; its size on PLANEMAP_OCTOMAP_SIZE.
class OctomapShell : public messages::Shell {
  public:
    OctomapShell(messages::Bus& bus, std::shared_ptr<messages::FrameDecoder> decoder,
                 const OctomapOptions& options, Building building = Building::kInHandler,
                 const OctomapFiles& files = {});

    messages::ModuleStatus& status() override { return status_; }
    int poll() override;
    /// Brings the tree up to date with the last trajectory and publishes all its sizes. In the background it
    /// does so for a quarter of a second at most; then the sizes are those of what the tree holds by then,
    /// which the message and the log say.
    void finish() override;

    /// Precondition: built in the handler.
    OctomapBuilder& builder() { return tree_.builder(); }

  private:
    void on_keyframe(const messages::RawMessage& message);
    void on_look(const messages::RawMessage& message);
    void on_trajectory(const messages::RawMessage& message);
    void take(const KeyframeTrajectory& all);
    void resume();
    void write_tree();
    std::shared_ptr<const StoredScan> scan_of(const messages::Frame& frame);
    void add(ScanId id, const std::shared_ptr<const StoredScan>& scan, const Pose& world_from_camera,
             const ScanAnchor& anchor);
    void start_over();
    WaitingScans::Taker adder() {
        return [this](ScanId id, const auto& scan, const Pose& world_from_camera, const ScanAnchor& anchor) {
            add(id, scan, world_from_camera, anchor);
        };
    }
    void drop(const char* reason, std::int64_t count = 1);
    void bring_up_to_date_and_publish();
    void publish(const OctomapState& state);

    messages::Bus& bus_;
    std::shared_ptr<messages::FrameDecoder> decoder_;
    TreeBuilding tree_;
    messages::ModuleStatus status_{"octomap"};
    messages::KeyframeGuard keyframe_guard_{status_};
    messages::StreamGuard trajectory_guard_{messages::channels::kTrajectory, "trajectories", status_, false};
    messages::KeyframeWatch watch_{status_, "the OctoMap is incomplete"};
    RecentFrames recent_;
    std::unique_ptr<ScanJournal> journal_;  ///< null without
    std::set<int> named_;                   ///< keyframes of the last trajectory
    /// For a pose in the largest component. Their depth is compressed at once: to do so with many when their
    /// poses come would block.
    WaitingScans waiting_;
    int component_ = -1;  ///< the largest, which the tree is of; -1: none yet
    double resolution_m_;
    std::size_t max_keyframes_;
    std::filesystem::path output_;
    std::int64_t last_publish_us_ = 0;
    std::size_t frozen_ = 0, refused_ = 0;  ///< as counted in the status
    bool unpublished_ = false;
    std::int32_t seq_ = 0;
};

}  // namespace planemap::octomap
