// SPDX-License-Identifier: BSD-3-Clause
#include "run/vdb_bytes.hpp"

#include <openvdb/openvdb.h>

#include <sstream>

namespace planemap {

std::string vdb_topology(const std::vector<octomap::Voxel>& cells) {
    openvdb::MaskTree tree;
    for (const octomap::Voxel& c : cells) tree.setValueOn(openvdb::Coord(c.x, c.y, c.z));
    std::ostringstream out;
    openvdb::io::setDataCompression(out, openvdb::io::COMPRESS_ACTIVE_MASK);
    tree.writeTopology(out);
    return std::move(out).str();
}

}  // namespace planemap
