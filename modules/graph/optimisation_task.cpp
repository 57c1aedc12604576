// SPDX-License-Identifier: BSD-3-Clause
#include "graph/optimisation_task.hpp"

#include <algorithm>

#include "graph/node_index.hpp"

namespace planemap::graph {

void OptimisationTask::run() {
    if (!trusting_edges.empty()) {
        optimise(poses, trusting_edges, 0, options, &landmarks, sightings);
        const bool fit = std::all_of(new_loops.begin(), new_loops.end(), [&](const PoseEdge& edge) {
            return edge_error(edge, poses[at(edge.from)], poses[at(edge.to)]).norm() < options.kernel_width;
        });
        if (fit) return;
    }
    failed = !optimise(poses, edges, 0, options, &landmarks, sightings).usable;
}

}  // namespace planemap::graph
