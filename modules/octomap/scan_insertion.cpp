// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/scan_insertion.hpp"

namespace planemap {

namespace {

Voxel voxel(const octomap::OcTreeKey& key) {
    return {key[0], key[1], key[2]};
}

octomap::OcTreeKey key(const Voxel& v) {
    return {static_cast<octomap::key_type>(v.x), static_cast<octomap::key_type>(v.y),
            static_cast<octomap::key_type>(v.z)};
}

}  // namespace

void ScanInserter::insert(octomap::OcTree& tree, std::span<const octomap::point3d> points,
                          const octomap::point3d& origin, double max_range) {
    ends_.clear();
    for (const octomap::point3d& p : points) {
        octomap::OcTreeKey end;
        if (tree.coordToKeyChecked(p, end)) ends_.insert(voxel(end));
    }
    trace_rays(tree, origin, max_range);
    // A cell that is both passed and hit was hit.
    free_.for_each([&](const Voxel& v) {
        if (!occupied_.contains(v)) tree.updateNode(key(v), false, true);
    });
    occupied_.for_each([&](const Voxel& v) { tree.updateNode(key(v), true, true); });
}

/// One ray to the centre of each cell that was hit, as OctoMap's computeUpdate() casts them.
void ScanInserter::trace_rays(const octomap::OcTree& tree, const octomap::point3d& origin, double max_range) {
    free_.clear();
    occupied_.clear();
    ends_.for_each([&](const Voxel& v) {
        octomap::point3d end = tree.keyToCoord(key(v));
        if (max_range < 0 || (end - origin).norm() <= max_range) {
            occupied_.insert(v);
        } else {
            end = origin + (end - origin).normalized() * static_cast<float>(max_range);
        }
        if (!tree.computeRayKeys(origin, end, ray_)) return;
        for (const octomap::OcTreeKey& passed : ray_) free_.insert(voxel(passed));
    });
}

}  // namespace planemap
