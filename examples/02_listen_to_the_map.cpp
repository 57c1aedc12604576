// SPDX-License-Identifier: BSD-3-Clause
// Listens to PLANEMAP_MAP and prints the planes of each map that comes, until one has come N times (default:
// for ever).
//   02_listen_to_the_map [LCM-URL [N]]
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "core/plane_map.hpp"
#include "messages/bus.hpp"
#include "messages/channels.hpp"
#include "messages/convert.hpp"

namespace {

void print(const planemap::PlaneMap& map) {
    std::printf("map %lld: %zu planes\n", static_cast<long long>(map.utime), map.planes.size());
    for (const planemap::MapPlane& plane : map.planes) {
        // n.p + d = 0 in the world frame, the normal towards where it was seen from.
        const planemap::Plane p = plane.plane();
        std::printf("  %d %-10s normal %6.3f %6.3f %6.3f  d %6.3f m\n", plane.id, label_name(plane.label),
                    p.normal.x(), p.normal.y(), p.normal.z(), p.d);
    }
}

void listen(const char* url, long wanted) {
    planemap::messages::Bus bus(url);
    long heard = 0;
    // What cannot be decoded throws; the bus counts it, says so once, and goes on.
    bus.subscribe(planemap::messages::channels::kMap, [&](const planemap::messages::RawMessage& message) {
        print(planemap::messages::plane_map_from(message.bytes));
        ++heard;
    });
    while (wanted == 0 || heard < wanted) bus.handle(1000);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        listen(argc > 1 ? argv[1] : "", argc > 2 ? std::atol(argv[2]) : 0);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return 1;
    }
}
