// SPDX-License-Identifier: BSD-3-Clause
#include "graph/pose_problem.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "graph/node_index.hpp"

namespace planemap::graph {

namespace {

constexpr double kSightingKernel = 2.0;  // standard deviations: a wrong sighting must not bend the graph
constexpr double kStillStep = 5e-4;      // metres and radians, RMS over the nodes: nothing moved any more
constexpr std::ptrdiff_t kLoopsSolvedDirectly = 300;
constexpr std::ptrdiff_t kLoopsKept = 40;  // in the sparse part that is factored when there are more

/// Ends the iterations when they move nodes by less than anybody can see.
class StopWhenStill : public ceres::IterationCallback {
  public:
    explicit StopWhenStill(double step) : step_(step) {}
    ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
        const bool still = summary.iteration > 0 && summary.step_is_successful && summary.step_norm < step_;
        return still ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
    }

  private:
    double step_;
};

ceres::Solver::Options solver_options(const OptimisationOptions& options) {
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    // Without a threaded BLAS below it, so that the same input gives the same bytes.
    if (ceres::IsSparseLinearAlgebraLibraryTypeAvailable(ceres::EIGEN_SPARSE))
        solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    solver.num_threads = 1;
    solver.max_num_iterations = options.max_iterations;
    solver.initial_trust_region_radius = 1e8;  // the start is a good one: steps of Gauss-Newton at once
    solver.function_tolerance = 1e-5;
    solver.parameter_tolerance = 1e-9;
    solver.logging_type = ceres::SILENT;
    return solver;
}

/// Many loop closures fill the factor of the normal equations. Then only those of a sparse part of the graph
/// are factored, and precondition conjugate gradients over all of it (Dellaert et al. 2010, subgraph
/// preconditioning).
void solve_by_conjugate_gradients(ceres::Solver::Options& solver,
                                  std::unordered_set<ceres::ResidualBlockId> sparse) {
    solver.linear_solver_type = ceres::CGNR;
    solver.preconditioner_type = ceres::SUBSET;
    solver.residual_blocks_for_subset_preconditioner = std::move(sparse);
    solver.max_linear_solver_iterations = 100;
}

}  // namespace

PoseProblem::PoseProblem(const std::vector<Pose>& poses, const std::vector<Landmark>* landmarks,
                         double kernel_width)
    : nodes_(poses.begin(), poses.end()),
      has_kernel_(kernel_width > 0),
      kernel_(has_kernel_ ? kernel_width : 1.0),
      sighting_kernel_(kSightingKernel) {
    if (landmarks != nullptr) planes_ = std::vector<PlaneNode>(landmarks->begin(), landmarks->end());
}

ceres::Problem::Options PoseProblem::shared(UpdateNodes& update) {
    ceres::Problem::Options options;
    options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.evaluation_callback = &update;
    return options;
}

Node& PoseProblem::node(int number) {
    return nodes_[at(number)];
}

PlaneNode& PoseProblem::plane_node(int landmark) {
    return planes_.at(at(landmark));
}

void PoseProblem::add(const std::vector<PoseEdge>& edges) {
    loops_ = std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.robust; });
    for (std::ptrdiff_t loop = 0; const PoseEdge& edge : edges) {
        Node &from = node(edge.from), &to = node(edge.to);
        const auto residual = problem_.AddResidualBlock(new EdgeCost(edge, from, to),
                                                        edge.robust && has_kernel_ ? &kernel_ : nullptr,
                                                        from.change.data(), to.change.data());
        if (!edge.robust || loop++ % (loops_ / kLoopsKept + 1) == 0) sparse_.insert(residual);
    }
}

void PoseProblem::add(const std::vector<Sighting>& sightings) {
    for (const Sighting& sighting : sightings) {
        PlaneNode& plane = plane_node(sighting.landmark);
        Node& seen_by = node(sighting.node);
        add(new SightingCost(sighting, seen_by, plane), {seen_by.change.data(), plane.change.data()});
    }
}

ceres::ResidualBlockId PoseProblem::add(ceres::CostFunction* cost, const std::vector<double*>& changes) {
    const ceres::ResidualBlockId id = problem_.AddResidualBlock(cost, &sighting_kernel_, changes);
    sparse_.insert(id);
    return id;
}

void PoseProblem::fix(int number) {
    double* const anchor = node(number).change.data();
    if (problem_.HasParameterBlock(anchor)) problem_.SetParameterBlockConstant(anchor);
}

ceres::Solver::Summary PoseProblem::solve(const OptimisationOptions& options) {
    StopWhenStill stop(kStillStep * std::sqrt(static_cast<double>(nodes_.size())));
    ceres::Solver::Options solver = solver_options(options);
    solver.callbacks.push_back(&stop);
    if (loops_ > kLoopsSolvedDirectly) solve_by_conjugate_gradients(solver, std::move(sparse_));
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    return summary;
}

std::vector<double*> PoseProblem::moving() {
    std::vector<double*> changes;
    const auto take = [&](double* change) {
        if (problem_.HasParameterBlock(change) && !problem_.IsParameterBlockConstant(change))
            changes.push_back(change);
    };
    for (Node& node : nodes_) take(node.change.data());
    for (PlaneNode& plane : planes_) take(plane.change.data());
    return changes;
}

Pose PoseProblem::pose(std::size_t number) {
    nodes_[number].update();  // the last step tried may not be the one taken
    return nodes_[number].pose();
}

}  // namespace planemap::graph
