// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "core/keyframe.hpp"
#include "core/replacement.hpp"
#include "messages/channels.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/keyframe_watch.hpp"
#include "messages/process.hpp"
#include "messages/stream_guard.hpp"
#include "octomap/octomap_builder.hpp"
#include "octomap/octomap_worker.hpp"
#include "octomap/recent_frames.hpp"
#include "octomap/scan_journal.hpp"

namespace planemap::octomap {

/// Where the OctoMap is built.
enum class Building {
    kInHandler,     ///< as messages come; rebuilt at the end only: the same input gives the same bytes
    kInBackground,  ///< on another thread; messages do not wait
};

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
    ~OctomapShell() override;

    messages::ModuleStatus& status() override { return status_; }
    int poll() override;
    /// Brings the tree up to date with the last trajectory and publishes all its sizes. In the background it
    /// does so for a quarter of a second at most; then the sizes are those of what the tree holds by then,
    /// which the message and the log say.
    void finish() override;

    /// Precondition: built in the handler.
    OctomapBuilder& builder() { return *builder_; }

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
    void add_looks();
    void drop(const char* reason, std::int64_t count = 1);
    /// In the handler: the state with everything brought up to date.
    OctomapState state();
    void publish(const OctomapState& state);

    messages::Bus& bus_;
    std::shared_ptr<messages::FrameDecoder> decoder_;
    OctomapOptions options_;
    std::unique_ptr<OctomapBuilder> builder_;
    std::unique_ptr<OctomapWorker> worker_;  ///< null when built in the handler
    messages::ModuleStatus status_{"octomap"};
    messages::StreamGuard keyframe_guard_{messages::channels::kKeyframe, "keyframes", status_};
    messages::StreamGuard trajectory_guard_{messages::channels::kTrajectory, "trajectories", status_, false};
    messages::KeyframeWatch watch_{status_, "the OctoMap is incomplete"};
    RecentFrames recent_;
    std::unique_ptr<ScanJournal> journal_;  ///< null without
    std::set<int> named_;                   ///< keyframes of the last trajectory
    std::int64_t keyframes_of_ = 0;         ///< session of the last keyframe
    /// Keyframes without a pose in the largest component, by id. Their depth is compressed at once: to do so
    /// with many when their poses come would block.
    std::map<int, std::shared_ptr<const StoredScan>> waiting_;
    struct WaitingLook {
        ScanId id;
        ScanAnchor anchor;
        std::shared_ptr<const StoredScan> scan;
    };
    std::deque<WaitingLook> looks_;  ///< that wait for their keyframe's pose
    KeyframePoses poses_;            ///< by the trajectories
    int component_ = -1;             ///< the largest, which the tree is of; -1: none yet
    int newest_id_ = -1;             ///< of the keyframes that came
    int looks_since_ = 0;            ///< the newest one
    double resolution_m_;
    std::size_t max_keyframes_;
    std::filesystem::path output_;
    std::int64_t last_utime_ = 0, last_publish_us_ = 0;
    int last_revision_ = 0;
    std::size_t frozen_ = 0, refused_ = 0;  ///< as counted in the status
    bool unpublished_ = false;
    std::int32_t seq_ = 0;
};

}  // namespace planemap::octomap
