// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/ceres.h>

#include <cstddef>
#include <unordered_set>
#include <vector>

#include "graph/residuals.hpp"

namespace planemap::graph {

/// The graph as Ceres sees it, with all that its residuals refer to. What it is given must outlive it.
class PoseProblem {
  public:
    PoseProblem(const std::vector<Pose>& poses, const std::vector<Landmark>* landmarks, double kernel_width);
    PoseProblem(const PoseProblem&) = delete;
    PoseProblem& operator=(const PoseProblem&) = delete;

    void add(const std::vector<PoseEdge>& edges);
    void add(const std::vector<Sighting>& sightings);
    /// A residual that counts as sightings do. Takes ownership of the cost.
    ceres::ResidualBlockId add(ceres::CostFunction* cost, const std::vector<double*>& changes);
    void fix(int node);

    ceres::Solver::Summary solve(const OptimisationOptions& options);

    Node& node(int number);
    PlaneNode& plane_node(int landmark);
    Pose pose(std::size_t node);
    Plane plane(std::size_t landmark) const { return planes_[landmark].plane(); }
    ceres::Problem& ceres() { return problem_; }
    /// The changes of all nodes and planes that residuals speak of and that may move, in their order. (Ceres
    /// has them by their addresses, which are other ones in each run.)
    std::vector<double*> moving();

  private:
    static ceres::Problem::Options shared(UpdateNodes& update);

    std::vector<Node> nodes_;
    std::vector<PlaneNode> planes_;
    bool has_kernel_;
    ceres::CauchyLoss kernel_, sighting_kernel_;
    UpdateNodes update_{nodes_};
    ceres::Problem problem_{shared(update_)};
    std::ptrdiff_t loops_ = 0;
    std::unordered_set<ceres::ResidualBlockId> sparse_;  ///< what is factored when there are many loops
};

}  // namespace planemap::graph
