// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include "messages/convert.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/module_status.hpp"

namespace planemap::odometry {

/// A frame and the regions of its depth image.
struct FrameWithRegions {
    std::shared_ptr<const messages::Frame> frame;
    std::optional<messages::FrameRegions> regions;  ///< none came
};

/// Brings frames and their regions, which come in messages of their own, together by utime. A frame waits for
/// its regions until a later one's come, kMaxWaiting frames wait, or it has waited for half a second; then it
/// goes on without. After ten of these in a row (no segmentation on the bus) frames do not wait, until
/// regions come again; in one process, where regions come before anything else can, they always do.
class RegionPairing {
  public:
    using Handler = std::function<void(const FrameWithRegions&)>;
    /// More than the segmentation has in its queue and at work: it drops what comes beyond that.
    static constexpr std::size_t kMaxWaiting = 8;

    /// Counts in `status`, which must outlive it, what found no partner; gives frames to `handler` in the
    /// order in which they came.
    RegionPairing(messages::ModuleStatus& status, bool is_in_process, Handler handler);

    void add(std::shared_ptr<const messages::Frame> frame);
    void add(messages::FrameRegions regions);
    /// Goes on with what has waited for too long. Returns whether frames still wait.
    bool poll();
    /// Handles the frames that still wait.
    void finish();

  private:
    using Clock = std::chrono::steady_clock;
    struct Waiting {
        FrameWithRegions input;
        Clock::time_point since = Clock::now();
    };
    void handle_front();
    void handle_ready(std::size_t max_waiting);

    messages::ModuleStatus& status_;
    bool is_in_process_;
    Handler handler_;
    std::deque<Waiting> waiting_;
    std::deque<messages::FrameRegions> early_;   ///< of frames that have not come yet; at most kMaxWaiting
    std::optional<std::int64_t> handled_utime_;  ///< of the last frame that was handled
    int missing_ = 0;                            ///< frames in a row that waited in vain
    bool heard_ = false;                         ///< a message came since the last poll()
};

}  // namespace planemap::odometry
