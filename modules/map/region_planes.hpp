// SPDX-License-Identifier: BSD-3-Clause
// Which plane each region of each keyframe is part of, as the journal of the map keeps it.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace planemap::map {

/// Channel of the journal; no message of the bus.
inline constexpr const char* kRegionPlanes = "PLANEMAP_REGION_PLANES";

/// For each keyframe its id, the number of its regions, and the plane id of each: 32-bit integers,
/// big-endian.
std::vector<std::uint8_t> encode_region_planes(const std::map<int, std::vector<int>>& planes);
/// The same back; what cannot be read (damage) and what is behind it is left out.
std::map<int, std::vector<int>> decode_region_planes(std::span<const std::uint8_t> bytes);

}  // namespace planemap::map
