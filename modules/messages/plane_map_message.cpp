// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "messages/checks.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/map_meetings.hpp"
#include "messages/packed_map.hpp"

namespace planemap::messages {

Eigen::Vector3f checked_up(const float* up_world) {
    const Eigen::Vector3f up(up_world);
    require(up.allFinite() && (up.isZero() || std::abs(up.norm() - 1) < 1e-3f), "up",
            "is neither zero nor a unit vector");
    return up;
}

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
    PlaneMap map;
    map.utime = checked_utime(message.utime, "plane_map.utime");
    map.revision = message.revision;
    require(message.component >= 0, "component", "is negative");
    map.component = message.component;
    map.up = checked_up(message.up);
    unpack_map(message.packed, message.unit, map);
    return map;
}

PlaneMap plane_map_from(std::span<const std::uint8_t> bytes) {
    return is_a<earlier_plane_map_t>(bytes) ? from_message(decode<earlier_plane_map_t>(bytes))
                                            : from_message(decode<plane_map_t>(bytes));
}

}  // namespace planemap::messages
