// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <planemap/keyframe_t.hpp>
#include <span>

#include "messages/channels.hpp"
#include "messages/stream_guard.hpp"

namespace planemap::messages {

/// Keyframes as the main stream of a module: as StreamGuard has it, and without those that the module has
/// already, which odometry sends again when a module was started again.
class KeyframeGuard {
  public:
    /// The status must outlive it.
    explicit KeyframeGuard(ModuleStatus& status) : status_(status) {}

    /// Whether to use a keyframe; `is_known`: one of its id came to the module before. What is not used is
    /// counted in the status.
    bool admits(const keyframe_t& received, std::span<const std::uint8_t> bytes, bool is_known) {
        if (is_of_last_session(received) && is_known) {
            status_.count_loss("keyframes that came twice");
            return false;
        }
        return guard_.admits(received.session, received.seq, received.utime, bytes);
    }
    /// The module took a keyframe in.
    void took(const keyframe_t& received) { session_ = received.session; }
    /// Goes on from the last keyframe that was taken before the process was started again; counts nothing.
    void resume(const keyframe_t& newest, std::span<const std::uint8_t> bytes) {
        guard_.resume(newest.session, newest.seq, newest.utime, bytes);
        took(newest);
    }

    /// Session of the last keyframe that was taken; 0: of none, or of an odometry that has none.
    std::int64_t session() const { return session_; }

  private:
    bool is_of_last_session(const keyframe_t& received) const {
        return received.session != 0 && received.session == session_;
    }

    ModuleStatus& status_;
    StreamGuard guard_{channels::kKeyframe, "keyframes", status_};
    std::int64_t session_ = 0;
};

}  // namespace planemap::messages
