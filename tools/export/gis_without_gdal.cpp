// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "export/gis.hpp"

namespace planemap {

void require_gis() {
    throw std::runtime_error(
        "this planemap-export was built without GDAL, which writes GeoPackages and databases: build it with "
        "cmake -DPLANEMAP_GDAL=ON");
}

void write_geopackage(const std::filesystem::path&, const PlaneMap&, const Trajectory&) {
    require_gis();
}

void write_to_database(const std::string&, const PlaneMap&, const Trajectory&, bool) {
    require_gis();
}

}  // namespace planemap
