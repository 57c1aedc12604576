// SPDX-License-Identifier: BSD-3-Clause
// The planes of a map in as few bytes as they need. docs/formats.md says byte by byte what they are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/plane_map.hpp"

namespace planemap::messages {

/// What outlines are rounded to, metres: in its plane a vertex is at most 3.6 mm from where it was. The plane
/// itself is rounded to 0.25 mm at the middle of its outline and to 3e-5 rad, so that up to 80 m from there
/// no vertex is further than 5 mm from where it was.
inline constexpr float kMapStep_m = 0.005f;

/// The planes of the map, where they meet, and what is inferred of them, in steps of `unit` metres. Not sent,
/// for it follows: the box's centre and half extents (it is around the outline), areas, positions of lines
/// and points. Of what is not finite something finite is sent. Throws std::length_error if the map is too
/// large for a message.
std::vector<std::uint8_t> packed_map(const PlaneMap& map, float unit);

/// Sets the map's planes, lines, points and inferred parts to what packed_map() made the bytes of. Throws
/// MessageError that names the field for anything that makes no sense; what is allocated is a small multiple
/// of the bytes.
void unpack_map(std::span<const std::uint8_t> bytes, float unit, PlaneMap& map);

}  // namespace planemap::messages
