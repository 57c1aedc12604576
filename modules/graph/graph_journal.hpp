// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <planemap/keyframe_t.hpp>
#include <span>
#include <vector>

#include "core/keyframe.hpp"
#include "messages/complaints.hpp"
#include "messages/journal.hpp"
#include "messages/module_status.hpp"

namespace planemap::graph {

/// The keyframes of a graph in a file that outlives the process. See messages::Journal.
class GraphJournal {
  public:
    /// Throws as messages::Journal does.
    explicit GraphJournal(const std::filesystem::path& file) : journal_(file) {}

    const std::filesystem::path& file() const { return journal_.file(); }

    /// A keyframe as it came.
    struct Came {
        keyframe_t message;
        std::vector<std::uint8_t> bytes;  ///< of the message
    };
    /// Gives the keyframes of the process before, in their order; the handler says whether it took one.
    /// Returns the newest that was taken. What is damaged, or what the handler throws messages::MessageError
    /// for, is left out and said in `complaints`.
    std::optional<Came> replay(messages::Complaints& complaints,
                               const std::function<bool(const keyframe_t&)>& take);
    void add(std::span<const std::uint8_t> keyframe);
    /// Now and then makes the file as small as the graph is, of which `trajectory` are the keyframes: without
    /// those that went for newer ones of their place. An edge from one of these then leads from the newest
    /// before it that is left, as the graph has both. Tells of the file's troubles.
    void tend(const KeyframeTrajectory& trajectory, messages::ModuleStatus& status);

  private:
    void compact(const KeyframeTrajectory& trajectory);

    messages::Journal journal_;
};

}  // namespace planemap::graph
