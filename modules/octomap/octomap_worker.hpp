// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "core/keyframe.hpp"
#include "octomap/octomap_builder.hpp"

namespace planemap::octomap {

/// How an OctoMap stood at one moment.
struct OctomapState {
    OctomapSizes sizes;
    std::size_t keyframes = 0;   ///< in it
    std::size_t refused = 0;     ///< keyframes that the builder did not take
    std::size_t frozen = 0;      ///< keyframes whose depth is no longer kept
    std::int64_t utime = 0;      ///< of the newest trajectory that was taken in, microseconds
    int revision = 0;            ///< of the same
    bool is_up_to_date = false;  ///< holds all keyframes given so far where that trajectory has them
};

/// Builds an OctoMap on a thread of its own, so that whoever hears messages never waits for it. New keyframes
/// come first; a rebuild goes on between them, scan by scan, and takes at most half of a processor's time.
class OctomapWorker {
  public:
    static constexpr std::size_t kMaxWaiting = 4096;  ///< about 600 MB

    /// Nobody else may use the builder while the worker lives.
    explicit OctomapWorker(OctomapBuilder& builder);
    /// Abandons what is under way, within some milliseconds: then the builder can only be destroyed.
    ~OctomapWorker();
    OctomapWorker(const OctomapWorker&) = delete;
    OctomapWorker& operator=(const OctomapWorker&) = delete;

    /// False, and nothing is taken, when kMaxWaiting keyframes are not in the tree yet.
    bool add(ScanId id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera,
             const ScanAnchor& anchor);
    /// A keyframe's own.
    bool add(int keyframe_id, std::shared_ptr<const StoredScan> scan, const Pose& world_from_camera) {
        return add(keyframe_id, std::move(scan), world_from_camera, {keyframe_id, Pose::Identity()});
    }
    void update(KeyframeTrajectory trajectory);

    /// The newest state, once; nothing until there is a newer one: every few seconds while something changes.
    /// Throws what the thread failed of.
    std::optional<OctomapState> newer_state();
    /// Waits until all that was given is in the tree, but not longer than this, and brings the state up to
    /// date if so. The OctoMap is not built on afterwards.
    void finish(std::chrono::milliseconds patience);

  private:
    using Clock = std::chrono::steady_clock;
    struct Given {
        ScanId id;
        std::shared_ptr<const StoredScan> scan;
        Pose world_from_camera;
        ScanAnchor anchor;
    };

    void run(const std::stop_token& stop);
    bool work(const std::stop_token& stop);
    void take_in();
    void publish_state(const std::stop_token& stop);
    Clock::time_point next_wake() const;

    OctomapBuilder& builder_;

    std::mutex mutex_;  ///< guards what follows, up to the thread's own
    std::condition_variable_any changed_;
    std::vector<Given> given_;
    std::size_t waiting_ = 0;  ///< keyframes that the builder holds and has not inserted
    std::optional<KeyframeTrajectory> trajectory_;
    std::optional<OctomapState> state_;
    std::exception_ptr failure_;
    bool finishing_ = false, finished_ = false;

    // The thread's own.
    OctomapState now_;
    bool unpublished_ = false;
    bool hurried_ = false;  ///< finish() was called: nothing rests any more
    Clock::time_point next_state_, next_rebuild_;
    Clock::duration rebuilding_{};  ///< time that the rebuild under way took so far

    std::jthread thread_;  ///< last: it uses all of the above
};

}  // namespace planemap::octomap
