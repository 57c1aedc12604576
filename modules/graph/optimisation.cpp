// SPDX-License-Identifier: BSD-3-Clause
#include "graph/optimisation.hpp"

#include <Eigen/Cholesky>

#include "graph/pose_problem.hpp"

namespace planemap::graph {

Twist edge_error(const PoseEdge& edge, const Pose& world_from_from, const Pose& world_from_to) {
    return edge.sqrt_information * RawError(edge.from_from_to, world_from_from.linear(),
                                            world_from_from.translation(), world_from_to.linear(),
                                            world_from_to.translation())
                                       .error;
}

Matrix6d sqrt_information(const Matrix6d& covariance, double add_m, double add_rad, double unknown) {
    Twist added;
    added << Eigen::Vector3d::Constant(add_m * add_m), Eigen::Vector3d::Constant(add_rad * add_rad);
    Matrix6d sum = 0.5 * (covariance + covariance.transpose());
    const bool sane = sum.allFinite() && sum.cwiseAbs().maxCoeff() < 1e6;
    if (!sane) sum = Matrix6d::Identity() * unknown * unknown;
    sum.diagonal() += added;
    Eigen::LLT<Matrix6d> cholesky(sum);
    if (cholesky.info() != Eigen::Success) {
        sum = Matrix6d::Identity() * unknown * unknown;
        cholesky.compute(sum);
    }
    return cholesky.matrixL().solve(Matrix6d::Identity());  // W = L^-1, so W^T W = (L L^T)^-1
}

OptimisationReport optimise(std::vector<Pose>& poses, const std::vector<PoseEdge>& edges, int fixed,
                            const OptimisationOptions& options, std::vector<Landmark>* landmarks,
                            const std::vector<Sighting>& sightings) {
    if (poses.empty() || edges.empty()) return {true, true, 0};
    PoseProblem problem(poses, landmarks, options.kernel_width);
    problem.add(edges);
    problem.add(sightings);
    problem.fix(fixed);
    const ceres::Solver::Summary summary = problem.solve(options);
    if (summary.IsSolutionUsable()) {
        for (std::size_t i = 0; i < poses.size(); ++i) {
            if (static_cast<int>(i) != fixed) poses[i] = problem.pose(i);
        }
        for (std::size_t i = 0; landmarks != nullptr && i < landmarks->size(); ++i)
            (*landmarks)[i].plane = problem.plane(i);
    }
    const bool converged =
        summary.termination_type == ceres::CONVERGENCE || summary.termination_type == ceres::USER_SUCCESS;
    return {summary.IsSolutionUsable(), converged, static_cast<int>(summary.iterations.size())};
}

}  // namespace planemap::graph
