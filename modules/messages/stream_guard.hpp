// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "messages/module_status.hpp"
#include "messages/sender_guard.hpp"

namespace planemap::messages {

/// A channel of results of our own modules, which number them, that a module lives on: one sender's are
/// admitted, what another sender or an earlier run says is counted and named (see SenderGuard).
class StreamGuard {
  public:
    /// What is not admitted counts in `status` as lost `things`, plural; if they are the module's main
    /// stream, those of the sender count as received. Beside it each message takes the place of those before.
    StreamGuard(const std::string& channel, std::string things, ModuleStatus& status, bool main_stream = true)
        : channel_(channel),
          guard_(channel, SenderGuard::Order::kNumber),
          things_(std::move(things)),
          status_(status),
          main_stream_(main_stream) {}

    /// Whether to use a message; `session` is the sender's id, or 0 if it does not say. One that repeats the
    /// last, byte for byte, is not used; beside the main stream it is for those who came late, in it
    /// it is counted, with a warning if the sender has no session: then only a replay of an old log does
    /// that. One that comes late is admitted to the
    /// main stream: the module knows what it can do with it; beside that, what came since has taken its
    /// place.
    bool admits(std::int64_t session, std::int32_t seq, std::optional<std::int64_t> utime,
                std::span<const std::uint8_t> bytes);

    /// Goes on from a message that was admitted before the process was started again; counts nothing.
    void resume(std::int64_t session, std::int32_t seq, std::optional<std::int64_t> utime,
                std::span<const std::uint8_t> bytes);

  private:
    std::string channel_;
    SenderGuard guard_;
    std::string things_;
    ModuleStatus& status_;
    bool main_stream_;
};

}  // namespace planemap::messages
