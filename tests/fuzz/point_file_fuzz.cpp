// SPDX-License-Identifier: BSD-3-Clause
#include <stdexcept>

#include "fuzz/fuzz.hpp"
#include "report_page/point_file.hpp"

namespace planemap::fuzz {

void fuzz(Bytes bytes) {
    const MemoryFile file(bytes);
    try {
        const std::vector<CloudPoint> points = read_points(file.path());
        require(points.size() * 19 <= bytes.size(), "no more points than there are bytes for");
        for (const CloudPoint& point : points) require(point.position.allFinite(), "positions are finite");
    } catch (const std::runtime_error&) {
    }
}

std::vector<std::string> seeds() {
    const std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment planemap\nelement vertex 2\nproperty float x\n"
        "property float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "property int plane\nend_header\n";
    return {header + std::string(38, '\1')};
}

}  // namespace planemap::fuzz
