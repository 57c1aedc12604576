// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "map/component_maps.hpp"
#include "map/map_journal.hpp"
#include "map/map_output.hpp"
#include "messages/channels.hpp"
#include "messages/keyframe_watch.hpp"
#include "messages/process.hpp"
#include "messages/stream_guard.hpp"

namespace planemap::map {

struct MapShellOptions {
    MapOptions map;
    std::filesystem::path
        start;  ///< plane_map.lcmlog to start from, see PlaneMapper::start_from(); empty: none
    /// Folder that the maps are written to (MapOutput), every few seconds and at the end; empty: none. What
    /// keeps them from the disk is said in the status; finish() throws if the last attempt failed.
    std::filesystem::path output;
    /// Keyframes, poses and plane ids are kept in this file: a process that is started again goes on with
    /// them, in the same world frame; empty: in none.
    std::filesystem::path journal;
    bool needs_planes = false;  ///< finish() throws if the map has none
};

/// PLANEMAP_KEYFRAME, PLANEMAP_LOOK and PLANEMAP_TRAJECTORY to PLANEMAP_MAP, the map of the component with
/// the most keyframes, and PLANEMAP_MAP_OTHERS, those of others; PLANEMAP_CAMERA_INFO and
/// PLANEMAP_ACCELERATION tell which way is up. Throws std::runtime_error naming the file for a map to start
/// from that cannot be read, and for an output folder that cannot be one.
class MapShell : public messages::Shell {
  public:
    MapShell(messages::Bus& bus, const MapShellOptions& options);

    messages::ModuleStatus& status() override { return status_; }
    /// The camera, where it does not come off the bus: how it is mounted says which way is up.
    void hear(const CameraInfo& camera);
    /// Writes the map every few seconds, and repeats it on the bus when a second has passed without one.
    int poll() override;
    void finish() override;
    /// Brings the map up to date with all that came, and says so if that changed it.
    void settle();

    /// The map of the component with the most keyframes: what PLANEMAP_MAP is.
    const PlaneMapper& mapper() const { return maps_.largest(); }
    const ComponentMaps& maps() const { return maps_; }

  private:
    void on_keyframe(const messages::RawMessage& message);
    void on_look(const messages::RawMessage& message);
    void on_trajectory(const messages::RawMessage& message);
    void on_camera(const messages::RawMessage& message);
    void on_acceleration(const messages::RawMessage& message);
    void resume();
    std::vector<std::uint8_t> surfaces_message() const;
    void tell_losses();
    void publish();
    void publish_maps(std::int32_t seq);
    void publish_surfaces();
    void tell();
    bool is_up_missing() const;

    messages::Bus& bus_;
    bool needs_planes_;
    bool tells_surfaces_;
    ComponentMaps maps_;
    MapOutput output_;
    messages::ModuleStatus status_{"map"};
    messages::StreamGuard keyframe_guard_{messages::channels::kKeyframe, "keyframes", status_};
    messages::StreamGuard trajectory_guard_{messages::channels::kTrajectory, "trajectories", status_, false};
    messages::KeyframeWatch watch_;
    std::unique_ptr<MapJournal> journal_;  ///< null without
    std::int64_t keyframes_of_ = 0;        ///< session of the last keyframe
    std::int64_t newest_utime_ = 0;        ///< of the keyframes in the map
    MapLosses told_;                       ///< what the status knows
    std::int32_t seq_ = 0, surfaces_seq_ = 0;
    std::size_t told_rebuilds_ = 0;  ///< when the surfaces were last told
    std::int64_t published_us_ = 0;  ///< wall clock of the last map; 0: none yet
};

}  // namespace planemap::map
