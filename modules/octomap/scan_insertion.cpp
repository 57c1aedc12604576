// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/scan_insertion.hpp"

namespace planemap::octomap {

namespace {

Voxel voxel(const ::octomap::OcTreeKey& key) {
    return {key[0], key[1], key[2]};
}

::octomap::OcTreeKey key(const Voxel& v) {
    return {static_cast<::octomap::key_type>(v.x), static_cast<::octomap::key_type>(v.y),
            static_cast<::octomap::key_type>(v.z)};
}

}  // namespace

/// One ray to the centre of each cell that was hit, as OctoMap's computeUpdate() casts them.
void ScanInserter::trace(const ::octomap::OcTree& tree, std::span<const ::octomap::point3d> points,
                         const ::octomap::point3d& origin, double max_range, const std::stop_token& stop) {
    ends_.clear();
    free_.clear();
    occupied_.clear();
    for (const ::octomap::point3d& p : points) {
        ::octomap::OcTreeKey end;
        if (tree.coordToKeyChecked(p, end)) ends_.insert(voxel(end));
    }
    ends_.for_each([&](const Voxel& v) {
        if (stop.stop_requested()) return;
        ::octomap::point3d end = tree.keyToCoord(key(v));
        if (max_range < 0 || (end - origin).norm() <= max_range) {
            occupied_.insert(v);
        } else {
            end = origin + (end - origin).normalized() * static_cast<float>(max_range);
        }
        if (!tree.computeRayKeys(origin, end, ray_)) return;
        for (const ::octomap::OcTreeKey& passed : ray_) free_.insert(voxel(passed));
    });
}

void ScanInserter::apply(::octomap::OcTree& tree, const BlockSet* only, const std::stop_token& stop) const {
    const auto wanted = [&](const Voxel& low) {
        return !stop.stop_requested() && (only == nullptr || only->contains(block_of(low)));
    };
    // A cell that is both passed and hit was hit.
    free_.for_each_where(wanted, [&](const Voxel& v) {
        if (!occupied_.contains(v)) tree.updateNode(key(v), false, true);
    });
    occupied_.for_each_where(wanted, [&](const Voxel& v) { tree.updateNode(key(v), true, true); });
}

std::vector<Voxel> ScanInserter::blocks() const {
    BlockSet blocks;
    const auto none = [](const Voxel&) {};
    const auto note = [&](const Voxel& low) {
        blocks.insert(block_of(low));
        return false;
    };
    free_.for_each_where(note, none);
    occupied_.for_each_where(note, none);
    std::vector<Voxel> list;
    list.reserve(blocks.size());
    blocks.for_each([&](const Voxel& block) { list.push_back(block); });
    return list;
}

}  // namespace planemap::octomap
