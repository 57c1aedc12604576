// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "camera/frame_pairing.hpp"

namespace planemap::camera {

/// What a live camera lost, by its reason.
using Losses = std::map<std::string, std::int64_t>;

/// From a camera's threads, on which frames arrive, to the one that reads them in pairs. Of each stream 4
/// frames wait at most; then the oldest goes. What is lost is counted by its reason.
/// Image is what the camera's library hands out; it must be movable.
template <typename Image>
class LiveFrames {
  public:
    struct Frame {
        std::int64_t stamp_us = 0;    ///< the device's
        std::int64_t arrival_us = 0;  ///< wall clock, when the host had it
        Image image{};
    };
    using Pair = typename FramePairing<Frame>::Pair;

    /// On any thread.
    void add_depth(Frame frame) { add(depth_, std::move(frame)); }
    void add_color(Frame frame) { add(color_, std::move(frame)); }

    /// On the reading thread, as all that follows: what came so far is left out, and pairs are made from now
    /// on.
    void begin(std::int64_t period_us, bool has_color) {
        const std::lock_guard lock(mutex_);
        depth_.clear();
        color_.clear();
        dropped_ = 0;
        period_us_ = period_us;
        has_color_ = has_color;
        pairing_ = FramePairing<Frame>(period_us / 2);
        pairing_.expect_color(has_color);
        last_arrival_ = Clock::now();
    }
    /// Waits for a depth frame before begin(); false if none came.
    bool wait_for_depth(std::chrono::milliseconds wait) {
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, wait, [&] { return !depth_.empty(); });
    }
    /// The next pair; nothing if none is whole within `wait`.
    std::optional<Pair> next(std::chrono::milliseconds wait, Losses& lost) {
        const auto until = Clock::now() + wait;
        std::optional<Pair> pair;
        while (!(pair = pairing_.take()) && take_arrivals(until, lost)) {
        }
        const std::int64_t unpaired = pairing_.unpaired_colors();
        count(lost, "colour frames without a depth frame near in time",
              unpaired - std::exchange(unpaired_, unpaired));
        if (pair && !pair->color && has_color_)
            count(lost, "depth frames without a colour frame near in time", 1);
        return pair;
    }
    /// How long no new depth frame has come.
    std::chrono::milliseconds silence() const {
        return std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - last_arrival_);
    }
    /// Lets go of all frames: they belong to a library that is about to end.
    void clear() {
        const std::lock_guard lock(mutex_);
        depth_.clear();
        color_.clear();
        pairing_.clear();
    }

  private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t kCapacity = 4;

    static void count(Losses& lost, const char* what, std::int64_t n) {
        if (n > 0) lost[what] += n;
    }
    void add(std::deque<Frame>& queue, Frame frame) {
        const std::lock_guard lock(mutex_);
        if (queue.size() == kCapacity) {
            queue.pop_front();
            ++dropped_;
        }
        queue.push_back(std::move(frame));
        changed_.notify_all();
    }
    bool take_arrivals(Clock::time_point until, Losses& lost) {
        std::deque<Frame> depth, color;
        {
            std::unique_lock lock(mutex_);
            if (!changed_.wait_until(lock, until, [&] { return !depth_.empty() || !color_.empty(); }))
                return false;
            depth = std::exchange(depth_, {});
            color = std::exchange(color_, {});
            count(lost, "frames that came while earlier ones were at work", std::exchange(dropped_, 0));
        }
        // Colour first: depth that arrived with its colour need not wait.
        for (Frame& frame : color) {
            const std::int64_t stamp_us = frame.stamp_us;
            if (is_new(frame, last_color_us_, lost)) pairing_.add_color(stamp_us, std::move(frame));
        }
        for (Frame& frame : depth) {
            const std::int64_t before_us = last_depth_us_, stamp_us = frame.stamp_us;
            if (!is_new(frame, last_depth_us_, lost)) continue;
            const std::int64_t steps = (stamp_us - before_us + period_us_ / 2) / period_us_;
            if (before_us >= 0 && stamp_us > before_us)
                count(lost, "frames that the camera did not send", steps - 1);
            last_arrival_ = Clock::now();
            pairing_.add_depth(stamp_us, std::move(frame));
        }
        return true;
    }
    /// A stamp that goes back is a clock that began again.
    bool is_new(const Frame& frame, std::int64_t& last_us, Losses& lost) {
        if (frame.stamp_us == last_us) {
            count(lost, "frames whose stamp did not go on", 1);
            return false;
        }
        if (frame.stamp_us < last_us) {
            pairing_.clear();
            last_depth_us_ = last_color_us_ = -1;
        }
        last_us = frame.stamp_us;
        return true;
    }

    std::mutex mutex_;  ///< of the four below
    std::condition_variable changed_;
    std::deque<Frame> depth_, color_;
    std::int64_t dropped_ = 0;

    FramePairing<Frame> pairing_{0};
    bool has_color_ = false;
    std::int64_t period_us_ = 1, last_depth_us_ = -1, last_color_us_ = -1, unpaired_ = 0;
    Clock::time_point last_arrival_ = Clock::now();
};

/// Wall clock, microseconds since the epoch.
inline std::int64_t wall_us() {
    return std::chrono::duration_cast<std::chrono::microseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

}  // namespace planemap::camera
