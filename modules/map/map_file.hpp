// SPDX-License-Identifier: BSD-3-Clause
// The map as a file: an LCM log of one event, or of two with the space that was seen to be empty, so that
// lcm-logplayer and lcm-spy read it too.
#pragma once

#include <filesystem>
#include <string>

#include "core/plane_map.hpp"
#include "core/seen_space.hpp"

namespace planemap::map {

/// The map as an event of an LCM log, on PLANEMAP_MAP; and, unless nothing was, what was seen to be empty as
/// another one, on PLANEMAP_SEEN_SPACE.
std::string plane_map_log(const PlaneMap& map, const SeenSpace& seen = {});

/// Writes plane_map_log() beside the file and renames it, so that the file holds a whole map at any moment.
/// Throws std::runtime_error naming the file.
void write_plane_map(const std::filesystem::path& file, const PlaneMap& map, const SeenSpace& seen = {});

/// The last map in a log, which may hold other things too. Throws std::runtime_error that names file and
/// reason if the file cannot be read, holds no map, is cut short, or the map does not make sense.
PlaneMap read_plane_map(const std::filesystem::path& file);

/// What was seen to be empty, of the last map in a log; nothing if the file does not say, as earlier ones.
/// Throws as read_plane_map() does.
SeenSpace read_seen_space(const std::filesystem::path& file);

/// True if there is a file that is worth more than a map without planes: also one that cannot be read as a
/// map, since what it holds is not known.
bool may_hold_planes(const std::filesystem::path& file);

}  // namespace planemap::map
