// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "core/geometry/pose.hpp"
#include "graph/landmarks.hpp"

namespace planemap::graph {

/// A measured relative pose between two nodes of the graph. Its error is the twist of
/// inverse(from_from_to) * (what the nodes' poses say), in the frame of `to`.
struct PoseEdge {
    int from = -1, to = -1;  ///< indices of nodes
    Pose from_from_to = Pose::Identity();
    Matrix6d sqrt_information = Matrix6d::Identity();  ///< W with W^T W = inverse covariance
    bool robust = false;  ///< may be wrong: weighted by a Cauchy kernel on its whitened error
};

/// The whitened error of an edge: W times (translation; twice the vector part of the error's quaternion).
Twist edge_error(const PoseEdge& edge, const Pose& world_from_from, const Pose& world_from_to);

/// W of an edge with this covariance after the given standard deviations are added to it (metres, radians). A
/// covariance that is not finite, or not positive, counts as `unknown` in all directions.
Matrix6d sqrt_information(const Matrix6d& covariance, double add_m, double add_rad, double unknown = 0.3);

struct OptimisationOptions {
    double kernel_width = 1.0;  ///< Cauchy width for robust edges, in standard deviations; 0: no kernel
    int max_iterations = 30;
};

/// What an optimisation did.
struct OptimisationReport {
    bool usable = false;  ///< the solver found an answer; else poses and landmarks are as they were
    bool converged = false;
    int iterations = 0;
};

/// Moves the poses (world_from_node) and the landmarks' planes to the least-squares optimum of edges and
/// sightings (these under a Cauchy kernel too); node `fixed` stays. Every node must be connected to it by
/// edges. Ceres, sparse, one thread: the same input gives the same output. Poses are left alone when the
/// solver fails.
OptimisationReport optimise(std::vector<Pose>& poses, const std::vector<PoseEdge>& edges, int fixed,
                            const OptimisationOptions& options, std::vector<Landmark>* landmarks = nullptr,
                            const std::vector<Sighting>& sightings = {});

}  // namespace planemap::graph
