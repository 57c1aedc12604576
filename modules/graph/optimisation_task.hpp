// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "graph/landmarks.hpp"
#include "graph/optimisation.hpp"

namespace planemap::graph {

/// One optimisation of a graph with a copy of all that it needs, so that it may run on another thread while
/// the graph grows.
struct OptimisationTask {
    std::vector<PoseEdge> edges;
    std::vector<PoseEdge> trusting_edges;  ///< to start with; none: the poses are near enough
    std::vector<PoseEdge> new_loops;       ///< what they trust
    std::vector<Pose> poses;               ///< world_from_camera of each node
    std::vector<Landmark> landmarks;
    std::vector<Sighting> sightings;
    OptimisationOptions options;
    std::size_t loops = 0;  ///< how many the graph had
    int started = 0;        ///< see Schedule::start()
    bool failed = false;    ///< by run(): the solver gave up, and poses and landmarks are as they were

    /// Moves poses and landmarks to the optimum. A loop closure far from the present poses is first trusted
    /// fully, so that it can pull against the kernel; when the rest contradicts it, the kernel lets go of it.
    void run();
};

}  // namespace planemap::graph
