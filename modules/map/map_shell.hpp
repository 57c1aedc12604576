// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "map/map.hpp"
#include "messages/channels.hpp"
#include "messages/process.hpp"
#include "messages/stream_guard.hpp"

namespace planemap {

struct MapShellOptions {
    MapOptions map;
    std::filesystem::path
        start;  ///< plane_map.lcmlog to start from, see PlaneMapper::start_from(); empty: none
    /// Folder that plane_map.lcmlog is written to (beside and renamed), every few seconds and at the end;
    /// empty: none. It is tried at the start; a write that fails later is said in the status and tried again
    /// every second, at the end finish() throws if the last one failed.
    std::filesystem::path output;
};

/// PLANEMAP_KEYFRAME and PLANEMAP_TRAJECTORY to PLANEMAP_MAP. Throws std::runtime_error naming the file for a
/// map to start from that cannot be read.
class MapShell : public Shell {
  public:
    MapShell(Bus& bus, const MapShellOptions& options);

    ModuleStatus& status() override { return status_; }
    /// Writes the map every few seconds, and repeats it on the bus when a second has passed without one.
    int poll() override;
    void finish() override;

    const PlaneMapper& mapper() const { return mapper_; }

  private:
    void on_keyframe(const RawMessage& message);
    void on_trajectory(const RawMessage& message);
    void tell_losses();
    void publish();
    void tell();
    void try_write();
    void write();

    Bus& bus_;
    std::filesystem::path output_;
    PlaneMapper mapper_;
    ModuleStatus status_{"map"};
    StreamGuard keyframe_guard_{channels::kKeyframe, "keyframes", status_};
    StreamGuard trajectory_guard_{channels::kTrajectory, "trajectories", status_, false};
    MapLosses told_;  ///< what the status knows
    std::int32_t seq_ = 0;
    std::int64_t published_us_ = 0;  ///< wall clock of the last map; 0: none yet
    std::int64_t last_write_us_ = 0;
    std::string write_error_;  ///< of the last attempt; empty if it went well
    bool unwritten_ = false;
};

}  // namespace planemap
