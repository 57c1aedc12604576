// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <optional>

#include "exports/corner.hpp"
#include "exports/exports.hpp"
#include "exports/planes_json_reader.hpp"
#include "fuzz/fuzz.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    const MemoryFile file(bytes);
    std::optional<PlaneMap> map;
    try {
        map = exports::read_planes_json(file.path());
    } catch (const std::runtime_error&) {
    } catch (const std::invalid_argument&) {
    }
    if (!map) return;
    for (std::size_t i = 0; i < map->planes.size(); ++i) {
        const MapPlane& plane = map->planes[i];
        require(plane.normal.allFinite() && plane.center.allFinite(), "planes are finite");
        require(i == 0 || plane.id > map->planes[i - 1].id, "ids ascend");
    }
    for (const IntersectionLine& line : map->lines)
        require(map->find(line.plane_a) != nullptr && map->find(line.plane_b) != nullptr,
                "lines are of planes");
}

std::vector<std::string> seeds() {
    return {exports::planes_json(scene::corner()), exports::planes_json({})};
}

}  // namespace planemap::fuzz
