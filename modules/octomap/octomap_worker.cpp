// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/octomap_worker.hpp"

#include <algorithm>
#include <utility>

namespace planemap::octomap {

namespace {

using namespace std::chrono_literals;

constexpr auto kFirstState = 1s, kStatePeriod = 5s;
constexpr int kStateShare = 20;  ///< of the thread's time, the part that states may take

}  // namespace

OctomapWorker::OctomapWorker(OctomapBuilder& builder)
    : builder_(builder),
      next_state_(Clock::now() + kFirstState),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

OctomapWorker::~OctomapWorker() = default;

bool OctomapWorker::add(ScanId id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera,
                        const ScanAnchor& anchor) {
    {
        const std::lock_guard lock(mutex_);
        if (given_.size() + waiting_ >= kMaxWaiting) return false;
        given_.push_back({id, std::move(scan), world_from_camera, anchor});
    }
    changed_.notify_all();
    return true;
}

void OctomapWorker::update(KeyframeTrajectory trajectory) {
    {
        const std::lock_guard lock(mutex_);
        trajectory_ = std::move(trajectory);
    }
    changed_.notify_all();
}

std::optional<OctomapState> OctomapWorker::newer_state() {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::exchange(state_, std::nullopt);
}

void OctomapWorker::finish(std::chrono::milliseconds patience) {
    {
        std::unique_lock lock(mutex_);
        finishing_ = true;
        changed_.notify_all();
        changed_.wait_for(lock, patience, [this] { return finished_; });
    }
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
}

void OctomapWorker::run(const std::stop_token& stop) {
    try {
        while (!stop.stop_requested()) {
            take_in();
            if (work(stop)) continue;
            if (hurried_) {
                publish_state(stop);
                break;
            }
            std::unique_lock lock(mutex_);
            changed_.wait_until(lock, stop, next_wake(),
                                [this] { return !given_.empty() || trajectory_ || finishing_; });
        }
    } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    finished_ = true;
    changed_.notify_all();
}

/// What came by now goes to the builder: keyframes first, since the trajectory may be newer than their poses.
void OctomapWorker::take_in() {
    std::vector<Given> given;
    std::optional<KeyframeTrajectory> trajectory;
    {
        const std::lock_guard lock(mutex_);
        given.swap(given_);
        trajectory = std::exchange(trajectory_, std::nullopt);
        hurried_ = finishing_;
        waiting_ = builder_.waiting() + given.size();
    }
    for (Given& g : given) {
        if (!builder_.keep(g.id, std::move(g.scan), g.world_from_camera, g.anchor)) ++now_.refused;
    }
    if (trajectory) {
        builder_.update(*trajectory);
        now_.utime = trajectory->utime;
        now_.revision = trajectory->revision;
    }
    unpublished_ = unpublished_ || !given.empty() || trajectory;
}

/// One piece of work; false when nothing is due.
bool OctomapWorker::work(const std::stop_token& stop) {
    if (unpublished_ && Clock::now() >= next_state_) {
        publish_state(stop);
        return true;
    }
    const std::size_t rebuilds = builder_.rebuilds();
    const Clock::time_point start = Clock::now();
    const bool worked = builder_.advance(hurried_ || start >= next_rebuild_, stop);
    unpublished_ = unpublished_ || worked;
    // A rebuild rests as long as it took.
    if (worked && builder_.rebuild_due()) rebuilding_ += Clock::now() - start;
    if (builder_.rebuilds() > rebuilds)
        next_rebuild_ = Clock::now() + std::exchange(rebuilding_, Clock::duration{});
    return worked;
}

void OctomapWorker::publish_state(const std::stop_token& stop) {
    const Clock::time_point start = Clock::now();
    builder_.tidy(stop);
    if (stop.stop_requested()) return;
    now_.sizes = builder_.sizes();
    now_.keyframes = builder_.keyframes_in_tree();
    now_.frozen = builder_.frozen();
    now_.is_up_to_date = !builder_.rebuild_due() && builder_.waiting() == 0;
    const Clock::time_point end = Clock::now();
    next_state_ = end + std::max<Clock::duration>(kStatePeriod, kStateShare * (end - start));
    unpublished_ = false;
    const std::lock_guard lock(mutex_);
    state_ = now_;
}

/// When work() has something to do again that no message brings.
OctomapWorker::Clock::time_point OctomapWorker::next_wake() const {
    Clock::time_point wake = Clock::now() + kStatePeriod;
    if (unpublished_) wake = std::min(wake, next_state_);
    if (builder_.rebuild_due()) wake = std::min(wake, next_rebuild_);
    return wake;
}

}  // namespace planemap::octomap
