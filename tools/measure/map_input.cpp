// SPDX-License-Identifier: BSD-3-Clause
#include "measure/map_input.hpp"

#include <stdexcept>

#include "exports/planes_json_reader.hpp"
#include "map/map_file.hpp"

namespace planemap {

PlaneMap read_map(const std::filesystem::path& map) {
    if (map.empty()) throw std::invalid_argument("MAP: must not be empty");
    std::error_code ignored;
    if (std::filesystem::is_directory(map, ignored)) {
        for (const char* name : {"plane_map.lcmlog", "planes.json"})
            if (std::filesystem::exists(map / name, ignored)) return read_map(map / name);
        throw std::runtime_error(map.string() + ": holds neither plane_map.lcmlog nor planes.json");
    }
    return map.extension() == ".json" ? exports::read_planes_json(map) : map::read_plane_map(map);
}

}  // namespace planemap
