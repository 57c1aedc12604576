// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "map/component_maps.hpp"

namespace planemap::map {

/// Where the maps of a run are on disk: plane_map.lcmlog, and plane_map_2.lcmlog ... of further components,
/// in a folder, each beside and renamed. A map of an earlier process stays until there are planes to write,
/// and is then kept under another name (keep_earlier_map()). A disk that is full, or a write that fails, ends
/// nothing: it is said in error() and tried again every second. Of what was seen to be empty it holds what is
/// found in half a second, since a stop waits for that; the rest is unknown.
class MapOutput {
  public:
    /// An empty folder: nothing is written.
    explicit MapOutput(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Tries the folder, and writes the map if none is there. Throws std::runtime_error, naming it, for a
    /// path that cannot be one.
    void open(const ComponentMaps& maps);
    /// What lies in the folder is this map, as it was.
    void claim() { is_ours_ = true; }
    /// There is something new to write.
    void change() { is_unwritten_ = true; }
    /// Writes what is new every few seconds, at most a fiftieth of the time. Returns whether it tried.
    bool poll(const ComponentMaps& maps);
    /// Writes what is new now. Returns whether it tried.
    bool finish(const ComponentMaps& maps);

    /// Why the last attempt failed; empty if it went well.
    const std::string& error() const { return error_; }
    /// Whether an earlier map is still there, since nothing came that is worth as much.
    bool leaves_earlier() const { return !folder_.empty() && !is_ours_ && error_.empty(); }
    /// plane_map.lcmlog.
    std::filesystem::path file() const;

  private:
    void try_write(const ComponentMaps& maps);
    void write(const ComponentMaps& maps);
    bool make_way(const ComponentMaps& maps);
    void fail(const std::string& why);

    std::filesystem::path folder_;
    std::string error_;
    std::int64_t last_write_us_ = 0, write_cost_us_ = 0;
    bool is_unwritten_ = false;
    bool is_ours_ = false;  ///< the file is this process's, or what was there is kept
};

}  // namespace planemap::map
