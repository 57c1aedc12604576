// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <map>
#include <memory>

#include "core/keyframe.hpp"
#include "messages/channels.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/process.hpp"
#include "messages/stream_guard.hpp"
#include "octomap/octomap_builder.hpp"

namespace planemap {

/// The depth of keyframes (OPENNI_FRAME, PLANEMAP_KEYFRAME) at their poses (PLANEMAP_TRAJECTORY) into an
/// OctoMap; its size on PLANEMAP_OCTOMAP_SIZE.
class OctomapShell : public Shell {
  public:
    OctomapShell(Bus& bus, std::shared_ptr<FrameDecoder> decoder, const OctomapOptions& options);

    ModuleStatus& status() override { return status_; }
    int poll() override;
    /// Brings the tree up to date with the last trajectory and publishes all its sizes.
    void finish() override;

    OctomapBuilder& builder() { return builder_; }

  private:
    static constexpr std::size_t kRecentFrames = 16;  ///< a keyframe comes a few frames after its frame
    static constexpr std::size_t kMaxWaiting = 64;    ///< keyframes without a pose

    void on_frame(const std::shared_ptr<const Frame>& frame);
    void on_keyframe(const RawMessage& message);
    void on_trajectory(const RawMessage& message);
    void publish_size();

    Bus& bus_;
    std::shared_ptr<FrameDecoder> decoder_;
    OctomapBuilder builder_;
    ModuleStatus status_{"octomap"};
    StreamGuard keyframe_guard_{channels::kKeyframe, "keyframes", status_};
    StreamGuard trajectory_guard_{channels::kTrajectory, "trajectories", status_, false};
    std::deque<std::shared_ptr<const Frame>> recent_;
    std::map<int, std::shared_ptr<const Frame>> waiting_;  ///< by keyframe id
    double resolution_m_;
    std::int64_t last_utime_ = 0, last_publish_us_ = 0;
    int last_revision_ = 0;
    std::int32_t keyframes_ = 0;
    bool unpublished_ = false;
    std::int32_t seq_ = 0;
};

/// Flags for the options, each named --<prefix>NAME.
void add_flags(Flags& flags, OctomapOptions& options, const std::string& prefix = "");

}  // namespace planemap
