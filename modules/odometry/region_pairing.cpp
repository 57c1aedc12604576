// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/region_pairing.hpp"

#include <algorithm>
#include <utility>

namespace planemap::odometry {

namespace {

constexpr std::chrono::milliseconds kMaxWait{500};
constexpr int kMaxMissing = 10;  // frames in a row without regions, then nothing waits

}  // namespace

RegionPairing::RegionPairing(messages::ModuleStatus& status, bool is_in_process, Handler handler)
    : status_(status), is_in_process_(is_in_process), handler_(std::move(handler)) {}

void RegionPairing::add(std::shared_ptr<const messages::Frame> frame) {
    heard_ = true;
    Waiting waiting{{std::move(frame), std::nullopt}};
    const auto early = std::find_if(early_.begin(), early_.end(), [&](const messages::FrameRegions& regions) {
        return regions.utime == waiting.input.frame->utime();
    });
    if (early != early_.end()) {
        waiting.input.regions = std::move(*early);
        early_.erase(early);
    }
    waiting_.push_back(std::move(waiting));
    handle_ready(missing_ >= kMaxMissing && !is_in_process_ ? 0 : kMaxWaiting);
}

void RegionPairing::add(messages::FrameRegions regions) {
    missing_ = 0;
    heard_ = true;
    const auto waiting = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& w) {
        return w.input.frame->utime() == regions.utime;
    });
    if (waiting != waiting_.end()) {
        waiting->input.regions = std::move(regions);
        // Regions come in the frames' order: none will come for those before.
        for (auto before = waiting - waiting_.begin(); before > 0; --before) handle_front();
        handle_ready(kMaxWaiting);
        return;
    }
    const bool is_twice = std::any_of(early_.begin(), early_.end(),
                                      [&](const auto& early) { return early.utime == regions.utime; });
    if (is_twice || (handled_utime_ && regions.utime <= *handled_utime_))
        return status_.lost("regions that came late or twice");
    early_.push_back(std::move(regions));
    if (early_.size() > kMaxWaiting) {
        early_.pop_front();
        status_.lost("regions that no frame waited for");
    }
}

void RegionPairing::handle_ready(std::size_t max_waiting) {
    while (!waiting_.empty() && (waiting_.front().input.regions || waiting_.size() > max_waiting)) {
        if (!waiting_.front().input.regions) ++missing_;
        handle_front();
    }
}

void RegionPairing::handle_front() {
    const FrameWithRegions input = std::move(waiting_.front().input);
    waiting_.pop_front();
    handled_utime_ = input.frame->utime();
    if (!input.regions) status_.lost("frames handled without their regions");
    handler_(input);
}

bool RegionPairing::poll() {
    // While messages come one after the other, the regions may be among those that the bus holds.
    const bool is_quiet = !std::exchange(heard_, false);
    if (is_quiet && !waiting_.empty() && Clock::now() - waiting_.front().since > kMaxWait) {
        ++missing_;
        handle_front();
        handle_ready(missing_ >= kMaxMissing ? 0 : kMaxWaiting);
    }
    return !waiting_.empty();
}

void RegionPairing::finish() {
    handle_ready(0);
}

}  // namespace planemap::odometry
