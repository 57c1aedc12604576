// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "core/camera.hpp"
#include "messages/bus.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/journal.hpp"
#include "messages/module_status.hpp"
#include "octomap/stored_scan.hpp"

namespace planemap::octomap {

/// Keyframes' depth and their poses on disk, for a process that is started again.
class ScanJournal {
  public:
    struct Came {
        int id, previous_id;
        std::int64_t utime;
    };
    /// What the process before left.
    struct Earlier {
        std::map<int, std::shared_ptr<const StoredScan>> scans;  ///< by keyframe
        std::vector<Came> keyframes;                             ///< in the order in which they came
        std::vector<std::uint8_t> newest;                        ///< the bytes of the last one
        std::vector<std::uint8_t> trajectory;                    ///< of the last one; empty: none
    };

    /// The bus, whose complaints and session are used, must outlive it.
    ScanJournal(messages::Bus& bus, const std::filesystem::path& file) : bus_(bus), journal_(file) {}

    /// What is damaged is left out and said.
    Earlier earlier();
    /// A keyframe's depth, and the keyframe as it came.
    void keep(const messages::Frame& frame, std::span<const std::uint8_t> keyframe);
    /// The newest poses; they are on disk within a second.
    void hear(std::span<const std::uint8_t> trajectory) {
        trajectory_.assign(trajectory.begin(), trajectory.end());
    }
    /// Once a second: poses, of which a kill loses no more; now and then: without the keyframes that went for
    /// newer ones, which are those that the last trajectory does not name, and all but the newest
    /// `max_keyframes` of those that it does. Tells of the journal's troubles.
    void tend(const std::set<int>& named, std::size_t max_keyframes, messages::ModuleStatus& status);
    /// Poses that are not on disk yet go there.
    void save_trajectory();

    const std::filesystem::path& file() const { return journal_.file(); }

  private:
    void compact(const std::set<int>& named, std::size_t max_keyframes);

    messages::Bus& bus_;
    messages::Journal journal_;
    std::optional<CameraInfo> camera_;      ///< that the journal described last
    std::vector<std::uint8_t> trajectory_;  ///< the last one, where the journal does not have it yet
    std::int64_t saved_us_ = 0;             ///< wall clock of the last save
};

}  // namespace planemap::octomap
