// SPDX-License-Identifier: BSD-3-Clause
// Decoding what the bus delivers. The generated decoders allocate what a length field asks for before they
// look at how many bytes there are, and throw on negative lengths; so every message is walked and bounded
// first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "messages/error.hpp"

namespace bot_core {
class images_t;
class pose_t;
class rigid_transform_t;
}  // namespace bot_core
namespace kinect {
class frame_msg_t;
}
namespace planemap {
class camera_info_t;
class planar_regions_t;
class odometry_t;
class keyframe_t;
class look_t;
class surfaces_t;
class trajectory_t;
class plane_map_t;
class earlier_plane_map_t;
class seen_space_t;
class map_size_t;
class module_status_t;
}  // namespace planemap

namespace planemap::messages {

/// The fingerprints of messages that decode<T>() reads: today's first, then those of the type as earlier
/// planemaps wrote it into files that users keep. Of what it lacked then, decode() says what is true of such
/// a message: session 0, not measured, not known.
template <typename T>
std::vector<std::uint64_t> fingerprints();

/// The first eight bytes of a message, which tell its type; 0 if there are fewer.
std::uint64_t fingerprint_of(std::span<const std::uint8_t> bytes);

/// Whether decode<T>() takes the bytes for a message of its type.
template <typename T>
bool is_a(std::span<const std::uint8_t> bytes);

/// Decodes one message of the type. Throws MessageError when the fingerprint is another type's, when a length
/// is negative or larger than the bytes that are there, or when bytes are missing or left over. Never
/// allocates more than a small multiple of the message's size. Defined for the types declared above.
template <typename T>
T decode(std::span<const std::uint8_t> bytes);

}  // namespace planemap::messages
