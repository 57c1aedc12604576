// SPDX-License-Identifier: BSD-3-Clause
#include "octomap/keyframe_tracer.hpp"

#include <gtest/gtest.h>

#include "octomap/scenes.hpp"

namespace planemap::octomap {
namespace {

using test::pose;
using test::room;
using test::small_camera;

std::size_t occupied(const ::octomap::OcTree& tree) {
    std::size_t count = 0;
    for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf)
        count += tree.isNodeOccupied(*leaf);
    return count;
}

::octomap::OcTree traced(const OctomapOptions& options, const CameraInfo& camera = small_camera()) {
    KeyframeTracer tracer(options);
    ::octomap::OcTree tree(options.resolution_m);
    tracer.trace(tree, StoredScan(room(camera), camera), pose(0, 0));
    tracer.apply(tree);
    return tree;
}

TEST(KeyframeTracer, BeyondTheRangeNothingIsOccupied) {
    OctomapOptions options;
    const std::size_t all = occupied(traced(options));
    options.max_range_m = 1.6;  // the box, but not the wall behind it
    const std::size_t near = occupied(traced(options));
    EXPECT_GT(near, 0u);
    EXPECT_LT(near, all);
    options.max_range_m = 0.5;
    const ::octomap::OcTree free = traced(options);
    EXPECT_EQ(occupied(free), 0u);
    EXPECT_GT(free.size(), 0u) << "what the rays pass is free all the same";
}

TEST(KeyframeTracer, WithoutARangeTheCamerasHolds) {
    CameraInfo camera = small_camera();
    camera.depth_max_m = 1.6;
    OctomapOptions options;
    const ::octomap::OcTree by_camera = traced(options, camera);
    options.max_range_m = 1.6;
    EXPECT_TRUE(by_camera == traced(options, camera));
}

TEST(KeyframeTracer, FewerPixelsHitFewerCells) {
    OctomapOptions options;
    options.resolution_m = 0.01;
    const std::size_t all = occupied(traced(options));
    options.subsample = 4;
    EXPECT_LT(occupied(traced(options)), all / 4);
}

TEST(KeyframeTracer, UpdatesOnlyTheBlocksAskedFor) {
    const OctomapOptions options;
    KeyframeTracer tracer(options);
    ::octomap::OcTree whole(options.resolution_m), part(options.resolution_m);
    tracer.trace(whole, StoredScan(room(small_camera()), small_camera()), pose(0, 0));
    const std::vector<Voxel> blocks = tracer.blocks();
    ASSERT_GT(blocks.size(), 1u);
    BlockSet first;
    first.insert(blocks.front());
    tracer.apply(whole);
    tracer.apply(part, &first);
    ASSERT_GT(part.calcNumNodes(), 0u);
    for (auto leaf = part.begin_leafs(), end = part.end_leafs(); leaf != end; ++leaf) {
        const ::octomap::OcTreeKey key = leaf.getKey();
        EXPECT_TRUE(first.contains(block_of({key[0], key[1], key[2]})));
    }
    EXPECT_LT(part.calcNumNodes(), whole.calcNumNodes());
}

}  // namespace
}  // namespace planemap::octomap
