// SPDX-License-Identifier: BSD-3-Clause
#include <bit>

#include "exports/exports.hpp"
#include "exports/little_endian.hpp"

namespace planemap::exports {

std::string points_pcd(const std::vector<CloudPoint>& points, const std::string& comment) {
    const std::string count = std::to_string(points.size());
    std::string bytes =
        "# .PCD v0.7 - " + comment +
        "\nVERSION 0.7\nFIELDS x y z rgb label\nSIZE 4 4 4 4 4\nTYPE F F F F U\nCOUNT 1 1 1 1 1\n"
        "WIDTH " +
        count + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n";
    bytes.reserve(bytes.size() + 20 * points.size());
    for (const CloudPoint& point : points) {
        for (const float value : {point.position.x(), point.position.y(), point.position.z()})
            put(bytes, value);
        for (const std::uint8_t value : {point.color.b, point.color.g, point.color.r, std::uint8_t{0}})
            put(bytes, value);
        put(bytes, static_cast<std::uint32_t>(point.plane));
    }
    return bytes;
}

}  // namespace planemap::exports
