// SPDX-License-Identifier: BSD-3-Clause
// The parts of a graph without the graph: keyframes where they truly stand, tied by odometry.
#pragma once

#include "graph/keyframes.hpp"
#include "graph/options.hpp"
#include "graph/topology.hpp"
#include "places/synthetic.hpp"

namespace planemap::test {

/// A keyframe that saw nothing.
inline graph::KeyframeNode bare_node(int id, const Pose& odom_from_camera = Pose::Identity()) {
    return {id, 1000 * id, -1, odom_from_camera, {}};
}

/// Keyframes of a walk at their true poses, each tied to the one before by what odometry measured.
struct GraphParts {
    graph::Keyframes keyframes;
    graph::Topology topology;

    void add(const Keyframe& keyframe, const Pose& world_from_camera) {
        const int node = keyframes.size();
        topology.add_node();
        if (node > 0) {
            topology.add_odometry(
                graph::odometry_tie({}, node - 1, node, keyframe.previous_from_camera, keyframe.covariance));
        }
        keyframes.add({keyframe.id, keyframe.utime, keyframe.chain, keyframe.odom_from_camera,
                       places::make_view(keyframe, 600)},
                      world_from_camera, node - 1);
    }
};

inline GraphParts parts_of(const Walk& walk) {
    GraphParts parts;
    for (std::size_t i = 0; i < walk.keyframes.size(); ++i)
        parts.add(walk.keyframes[i], walk.world_from_camera[i]);
    return parts;
}

}  // namespace planemap::test
