// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "messages/checks.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/map_meetings.hpp"
#include "messages/packed_map.hpp"

namespace planemap::messages {

plane_map_t to_message(const PlaneMap& map, std::int32_t seq, std::int64_t session) {
    plane_map_t message;
    message.session = session;
    message.utime = map.utime;
    message.seq = seq;
    message.revision = map.revision;
    message.component = map.component;
    std::copy(map.up.data(), map.up.data() + 3, message.up);
    message.unit = kMapStep_m;
    message.packed = packed_map(map, message.unit);
    message.n_bytes = count32(message.packed.size());
    return message;
}

PlaneMap from_message(const plane_map_t& message) {
    PlaneMap map = map_without_planes(message);
    unpack_map(message.packed, message.unit, map);
    return map;
}

PlaneMap plane_map_from(std::span<const std::uint8_t> bytes) {
    return is_a<earlier_plane_map_t>(bytes) ? from_message(decode<earlier_plane_map_t>(bytes))
                                            : from_message(decode<plane_map_t>(bytes));
}

}  // namespace planemap::messages
