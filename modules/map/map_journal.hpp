// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/surfaces.hpp"
#include "messages/complaints.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/journal.hpp"

namespace planemap::map {

/// What made the map what it is, in a file that outlives the process: keyframes and looks as they come, the
/// poses and the planes' ids once a second, of which a kill loses no more. See messages::Journal.
class MapJournal {
  public:
    /// Throws as messages::Journal does.
    explicit MapJournal(const std::filesystem::path& file) : journal_(file) {}

    std::string file() const { return journal_.file().string(); }
    /// A keyframe or a look.
    void add(std::string_view channel, std::span<const std::uint8_t> bytes) { journal_.add(channel, bytes); }
    /// The last trajectory, stored by the next save().
    void keep_poses(std::span<const std::uint8_t> trajectory) {
        trajectory_.assign(trajectory.begin(), trajectory.end());
    }

    struct Earlier {
        std::vector<std::uint8_t> trajectory;    ///< the last one's message; empty: none
        Surfaces surfaces;                       ///< the planes' ids then
        std::optional<keyframe_t> newest;        ///< keyframe
        std::vector<std::uint8_t> newest_bytes;  ///< its message
    };
    /// Gives the keyframes and looks of the process before, in their order. What is damaged, or what a
    /// handler throws messages::MessageError for, is left out and said in `complaints`.
    Earlier replay(messages::Complaints& complaints,
                   const std::function<void(const keyframe_t&)>& on_keyframe,
                   const std::function<void(const look_t&)>& on_look);

    /// Poses and the ids that `surfaces` tells (a message on PLANEMAP_SURFACES), if there are new poses.
    void save(const std::function<std::vector<std::uint8_t>()>& surfaces);
    /// Saves once a second; now and then the journal becomes as small as the map, of which has_keyframe(id)
    /// says what it holds.
    void tend(const std::function<std::vector<std::uint8_t>()>& surfaces,
              const std::function<bool(int)>& has_keyframe);
    /// What keeps it from the disk, where that is new.
    std::optional<std::string> news() { return journal_.news(); }

  private:
    void compact(const std::function<bool(int)>& has_keyframe);

    messages::Journal journal_;
    std::vector<std::uint8_t> trajectory_;  ///< the last one, where the journal does not have it yet
    std::int64_t saved_us_ = 0;             ///< wall clock when the journal got the last one
};

}  // namespace planemap::map
