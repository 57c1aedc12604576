// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/keyframe.hpp"
#include "messages/bus.hpp"
#include "messages/journal.hpp"
#include "messages/module_status.hpp"

namespace planemap::odometry {

/// PLANEMAP_KEYFRAME of the odometry, and what makes it last: a journal, which a path names, from which a
/// process that is started again knows the keyframes that it made; and the keyframes of the last seconds,
/// which are sent again when a module that lives on them was started again.
class KeyframeOutbox {
  public:
    /// Bus and status must outlive it. An empty path: no journal.
    KeyframeOutbox(messages::Bus& bus, messages::ModuleStatus& status, const std::filesystem::path& journal);

    /// The keyframes of the process before, oldest first; what is none in the journal is left out and said.
    std::vector<Keyframe> earlier();
    void publish(const Keyframe& keyframe);
    /// Keeps the journal small, and tells of its troubles.
    void tend_journal();

  private:
    void on_status(const messages::RawMessage& message);
    void send_again();

    messages::Bus& bus_;
    messages::ModuleStatus& status_;
    std::unique_ptr<messages::Journal> journal_;  ///< null without
    std::int32_t seq_ = 0;
    struct Sent {
        std::chrono::steady_clock::time_point at;
        std::vector<std::uint8_t> bytes;
    };
    std::deque<Sent> sent_;                         ///< the last keyframes
    std::map<std::string, std::int64_t> sessions_;  ///< of the modules that live on them
};

}  // namespace planemap::odometry
