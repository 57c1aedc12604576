// SPDX-License-Identifier: BSD-3-Clause
#include "messages/keyframe_watch.hpp"

#include <iterator>
#include <utility>

#include "core/stamp.hpp"

namespace planemap::messages {

namespace {
constexpr std::int64_t kOnItsWay_us = 1000000;
}

void remark_new_part(ModuleStatus& status, int id, int previous_id, std::int64_t utime) {
    if (id <= 0 || previous_id >= 0) return;
    status.remark("part", "keyframe " + std::to_string(id) + ", at " + seconds_text(utime) +
                              ", does not hang on those before (tracking was lost, or the sensor started "
                              "again): a component of its own begins, until a loop closure ties it to them");
}

void KeyframeWatch::came(int id, int previous_id, std::int64_t utime) {
    remark_new_part(status_, id, previous_id, utime);
    came_.insert(id);
    missing_.erase(id);
    if (came_.size() > named_ + kMostAhead) came_.erase(std::prev(came_.end()));
}

void KeyframeWatch::named(const KeyframeTrajectory& trajectory, std::int64_t now_us) {
    if (missing_.empty()) missing_since_us_ = now_us;
    std::set<int> named_and_came;
    missing_.clear();
    for (const KeyframePose& keyframe : trajectory.keyframes)
        (came_.contains(keyframe.id) ? named_and_came : missing_).insert(keyframe.id);
    named_ = named_and_came.size();
    const int newest = trajectory.keyframes.empty() ? -1 : trajectory.keyframes.back().id;
    named_and_came.insert(came_.upper_bound(newest), came_.end());
    came_ = std::move(named_and_came);
}

void KeyframeWatch::tell(std::int64_t now_us) {
    if (missing_.size() == told_) return;
    if (!missing_.empty() && now_us - missing_since_us_ < kOnItsWay_us) return;
    told_ = missing_.size();
    status_.remark("keyframes",
                   told_ == 0 ? std::string()
                              : std::to_string(told_) +
                                    " keyframes of the trajectory were never received: " + consequence_);
}

}  // namespace planemap::messages
