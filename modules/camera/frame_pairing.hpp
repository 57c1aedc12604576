// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstdlib>
#include <deque>
#include <optional>
#include <utility>

namespace planemap::camera {

/// Pairs the depth and colour frames of a camera by the device's stamps: each depth frame with the nearest
/// colour frame within `max_gap_us`, each colour frame at most once. Every depth frame comes out, in order;
/// one without a partner alone. It waits for a colour frame that is not older, or for two later depth frames:
/// colour that stops holds depth up by two frames, and no longer.
/// Frame is any type that can be moved. Both streams must be added in order of their stamps.
template <typename Frame>
class FramePairing {
  public:
    struct Pair {
        std::int64_t depth_us = 0, color_us = 0;
        Frame depth;
        std::optional<Frame> color;
    };

    explicit FramePairing(std::int64_t max_gap_us) : max_gap_us_(max_gap_us) {}

    /// There is no colour to wait for: depth comes out at once.
    void expect_color(bool expected) { expects_color_ = expected; }
    void add_depth(std::int64_t stamp_us, Frame frame) { depths_.emplace_back(stamp_us, std::move(frame)); }
    void add_color(std::int64_t stamp_us, Frame frame) { colors_.emplace_back(stamp_us, std::move(frame)); }
    /// No frame comes any more: nothing is waited for.
    void end() { ended_ = true; }
    /// Forgets what waits: the device's clock began again, or the device did.
    void clear() {
        depths_.clear();
        while (!colors_.empty()) drop_color();
    }

    /// The next depth frame whose partner is known.
    std::optional<Pair> take() {
        if (depths_.empty()) return std::nullopt;
        const std::int64_t depth_us = depths_.front().first;
        const bool has_later_color = !colors_.empty() && colors_.back().first >= depth_us;
        if (expects_color_ && !has_later_color && depths_.size() <= kWait && !ended_) return std::nullopt;
        Pair pair{depth_us, 0, std::move(depths_.front().second), std::nullopt};
        depths_.pop_front();
        // Of two colour frames in reach the nearer; those before it have no partner.
        while (colors_.size() > 1 && gap(colors_[1], depth_us) <= gap(colors_[0], depth_us)) drop_color();
        if (!colors_.empty() && gap(colors_.front(), depth_us) <= max_gap_us_) {
            pair.color_us = colors_.front().first;
            pair.color = std::move(colors_.front().second);
            colors_.pop_front();
        }
        while (!colors_.empty() && colors_.front().first < depth_us - max_gap_us_) drop_color();
        has_begun_ = true;
        return pair;
    }

    /// Colour frames that no depth frame was near to; without those from before the first depth frame.
    std::int64_t unpaired_colors() const { return unpaired_colors_; }

  private:
    static constexpr std::size_t kWait = 2;
    using Stamped = std::pair<std::int64_t, Frame>;

    static std::int64_t gap(const Stamped& frame, std::int64_t stamp_us) {
        return std::abs(frame.first - stamp_us);
    }
    void drop_color() {
        colors_.pop_front();
        unpaired_colors_ += has_begun_;
    }

    std::int64_t max_gap_us_;
    bool expects_color_ = true, ended_ = false;
    bool has_begun_ = false;  ///< the first depth frame came out; colour may come before it in vain
    std::deque<Stamped> depths_, colors_;
    std::int64_t unpaired_colors_ = 0;
};

}  // namespace planemap::camera
