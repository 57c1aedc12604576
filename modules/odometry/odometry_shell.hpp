// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>

#include "messages/convert.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/process.hpp"
#include "odometry/odometry.hpp"

namespace planemap {

/// OPENNI_FRAME and PLANEMAP_REGIONS of the same utime to PLANEMAP_ODOMETRY, POSE_BODY and PLANEMAP_KEYFRAME.
/// A frame waits for its regions until `kMaxWaiting` frames wait; then the oldest goes on without. While no
/// regions come at all (no segmentation on the bus), frames do not wait.
class OdometryShell : public Shell {
  public:
    OdometryShell(Bus& bus, std::shared_ptr<FrameDecoder> decoder, const OdometryOptions& options);

    /// Reasons in status().losses() for frames that were not tracked; others had depth that could be used.
    static constexpr const char* kNoReadings = "untracked frames with hardly a depth reading in range";
    static constexpr const char* kBesideColor = "untracked frames whose depth lies beside the colour image";

    ModuleStatus& status() override { return status_; }
    /// Handles the frames that still wait.
    void finish() override;

  private:
    static constexpr std::size_t kMaxWaiting = 3;
    static constexpr int kMaxMissing = 10;  ///< frames in a row without regions, then nothing waits

    struct Waiting {
        std::shared_ptr<const Frame> frame;
        std::optional<FrameRegions> regions;
    };
    void on_frame(const RawMessage& message);
    void on_regions(const RawMessage& message);
    void process_ready(std::size_t max_waiting);
    void process(const Waiting& input);

    Bus& bus_;
    std::shared_ptr<FrameDecoder> decoder_;
    Odometry odometry_;
    ModuleStatus status_{"odometry"};
    std::deque<Waiting> waiting_;
    std::deque<FrameRegions> early_regions_;  ///< of frames that have not come yet; at most kMaxWaiting
    int missing_ = kMaxMissing;
    std::int32_t odometry_seq_ = 0, keyframe_seq_ = 0;
};

/// Flags for the options, each named --<prefix>NAME.
void add_flags(Flags& flags, OdometryOptions& options, const std::string& prefix = "");

}  // namespace planemap
