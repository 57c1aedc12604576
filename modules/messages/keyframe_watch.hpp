// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include "core/keyframe.hpp"
#include "messages/module_status.hpp"

namespace planemap::messages {

/// Remarks on the status that a keyframe after the first has no edge from those before it, as after a loss of
/// tracking or when the sensor started again elsewhere.
void remark_new_part(ModuleStatus& status, int id, int previous_id, std::int64_t utime);

/// Says what a module that is made of keyframes lacks: those that the trajectory names and that never came,
/// because the module started later or the network lost them.
class KeyframeWatch {
  public:
    /// consequence: of keyframes that never came, e.g. "the map is incomplete".
    KeyframeWatch(ModuleStatus& status, std::string consequence)
        : status_(status), consequence_(std::move(consequence)) {}

    void came(int id, int previous_id, std::int64_t utime);
    bool has(int id) const { return came_.contains(id); }
    void named(const KeyframeTrajectory& trajectory, std::int64_t now_us);
    /// Remarks on what is missing once that has been so for a second: a keyframe may come after the
    /// trajectory that names it.
    void tell(std::int64_t now_us);
    /// Keyframes that the last trajectory names and that have not come.
    std::size_t missing() const { return missing_.size(); }

  private:
    static constexpr std::size_t kMostAhead = 10000;  ///< ids that no trajectory names

    ModuleStatus& status_;
    std::string consequence_;
    std::set<int> came_, missing_;
    std::int64_t missing_since_us_ = 0;
    std::size_t named_ = 0;  ///< of those that came, by the last trajectory
    std::size_t told_ = 0;
};

}  // namespace planemap::messages
