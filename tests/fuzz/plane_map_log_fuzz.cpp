// SPDX-License-Identifier: BSD-3-Clause
#include <optional>

#include "fuzz/fuzz.hpp"
#include "map/map_file.hpp"
#include "messages/sample_messages.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    const MemoryFile file(bytes);
    map::may_hold_planes(file.path());
    std::optional<PlaneMap> read;
    try {
        read = map::read_plane_map(file.path());
    } catch (const std::runtime_error&) {
        return;
    }
    const std::string written = map::plane_map_log(*read);
    const MemoryFile again({reinterpret_cast<const std::uint8_t*>(written.data()), written.size()});
    require(map::read_plane_map(again.path()).planes.size() == read->planes.size(),
            "what was read can be written and read");
}

std::vector<std::string> seeds() {
    return {map::plane_map_log(PlaneMap()), map::plane_map_log(test::sample_map())};
}

}  // namespace planemap::fuzz
