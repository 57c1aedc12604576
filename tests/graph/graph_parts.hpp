// SPDX-License-Identifier: BSD-3-Clause
// The parts of a graph without the graph: keyframes where they truly stand, tied by odometry.
#pragma once

#include "graph/keyframes.hpp"
#include "graph/options.hpp"
#include "graph/synthetic.hpp"
#include "graph/topology.hpp"

namespace planemap::graph::test {

/// A keyframe that saw nothing.
inline KeyframeNode bare_node(int id, const Pose& odom_from_camera = Pose::Identity()) {
    return {id, 1000 * id, odom_from_camera, {}};
}

/// Keyframes of a walk at their true poses, each tied to the one before by what odometry measured.
struct GraphParts {
    Keyframes keyframes;
    Topology topology;

    void add(const Keyframe& keyframe, const Pose& world_from_camera) {
        const int node = keyframes.size();
        topology.add_node();
        if (node > 0) {
            topology.add_odometry(
                odometry_tie({}, node - 1, node, keyframe.previous_from_camera, keyframe.covariance));
        }
        keyframes.add({keyframe.id, keyframe.utime, keyframe.odom_from_camera, make_view(keyframe, 600)},
                      world_from_camera, node - 1);
    }
};

inline GraphParts parts_of(const Walk& walk) {
    GraphParts parts;
    for (std::size_t i = 0; i < walk.keyframes.size(); ++i)
        parts.add(walk.keyframes[i], walk.world_from_camera[i]);
    return parts;
}

}  // namespace planemap::graph::test
