// SPDX-License-Identifier: BSD-3-Clause
#include "graph/optimisation.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_set>
#include <utility>

#include "graph/node_index.hpp"

namespace planemap::graph {

namespace {

constexpr double kSightingKernel = 2.0;  // standard deviations: a wrong sighting must not bend the graph
constexpr double kStillStep = 5e-4;      // metres and radians, RMS over the nodes: nothing moved any more
constexpr std::ptrdiff_t kLoopsSolvedDirectly = 300;
constexpr std::ptrdiff_t kLoopsKept = 40;  // in the sparse part that is factored when there are more

/// J with exp(w + x) = exp(w) exp(J x) for small x.
Eigen::Matrix3d so3_right_jacobian(const Eigen::Vector3d& w) {
    const double angle = w.norm();
    const Eigen::Matrix3d s = skew(w);
    if (angle < 1e-4) return Eigen::Matrix3d::Identity() - 0.5 * s + s * s / 6;
    return Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / (angle * angle) * s +
           (angle - std::sin(angle)) / (angle * angle * angle) * s * s;
}

/// A node as Ceres sees it: how far it has moved from where it started, added to the translation and turned
/// about its own axes. What the residuals need of it is worked out once an evaluation, not once a residual.
struct Node {
    Pose start = Pose::Identity();
    std::array<double, 6> change{};
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< from change[3..5] to a turn about present axes

    explicit Node(const Pose& pose) : start(pose) { update(); }
    void update() {
        const Eigen::Map<const Twist> x(change.data());
        rotation = start.linear() * so3_exp(x.tail<3>());
        translation = start.translation() + x.head<3>();
        turn = so3_right_jacobian(x.tail<3>());
    }
    Pose pose() const {
        Pose pose = Pose::Identity();
        pose.linear() = rotation;
        pose.translation() = translation;
        return orthonormalised(pose);
    }
};

/// The error of an edge before whitening, and what its derivatives need.
struct RawError {
    Eigen::Vector3d offset;        ///< from `from` to `to`, in the frame of `from`
    Eigen::Matrix3d from_from_to;  ///< rotation by the nodes' poses
    Eigen::Quaterniond q;          ///< of the error's rotation, w >= 0
    Twist error;

    RawError(const Pose& measured, const Eigen::Matrix3d& r_from, const Eigen::Vector3d& t_from,
             const Eigen::Matrix3d& r_to, const Eigen::Vector3d& t_to)
        : offset(r_from.transpose() * (t_to - t_from)),
          from_from_to(r_from.transpose() * r_to),
          q(Eigen::Matrix3d(measured.linear().transpose() * from_from_to)) {
        if (q.w() < 0) q.coeffs() = -q.coeffs();
        error << measured.linear().transpose() * (offset - measured.translation()), 2 * q.vec();
    }
};

class EdgeCost : public ceres::SizedCostFunction<6, 6, 6> {
  public:
    EdgeCost(const PoseEdge& edge, const Node& from, const Node& to) : edge_(edge), from_(from), to_(to) {}

    bool Evaluate(double const* const* /*changes*/, double* residuals, double** jacobians) const override {
        const RawError raw(edge_.from_from_to, from_.rotation, from_.translation, to_.rotation,
                           to_.translation);
        Eigen::Map<Twist>{residuals} = edge_.sqrt_information * raw.error;
        if (jacobians == nullptr) return true;
        const Eigen::Matrix3d to_measured = edge_.from_from_to.linear().transpose();
        const Eigen::Matrix3d by_world = to_measured * from_.rotation.transpose();
        const Eigen::Matrix3d by_turn = raw.q.w() * Eigen::Matrix3d::Identity() + skew(raw.q.vec());
        using Jacobian = Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>;
        Matrix6d jacobian = Matrix6d::Zero();
        if (jacobians[0] != nullptr) {
            jacobian.topLeftCorner<3, 3>() = -by_world;
            jacobian.topRightCorner<3, 3>() = to_measured * skew(raw.offset) * from_.turn;
            jacobian.bottomRightCorner<3, 3>() = -by_turn * raw.from_from_to.transpose() * from_.turn;
            Jacobian{jacobians[0]} = edge_.sqrt_information * jacobian;
        }
        if (jacobians[1] != nullptr) {
            jacobian.topLeftCorner<3, 3>() = by_world;
            jacobian.topRightCorner<3, 3>().setZero();
            jacobian.bottomRightCorner<3, 3>() = by_turn * to_.turn;
            Jacobian{jacobians[1]} = edge_.sqrt_information * jacobian;
        }
        return true;
    }

  private:
    const PoseEdge& edge_;
    const Node &from_, &to_;
};

/// A landmark as Ceres sees it: how its plane turns about two axes and shifts, at a reference point on it.
struct PlaneNode {
    Eigen::Vector3d point, normal, u, v;
    std::array<double, 3> change{};

    explicit PlaneNode(const Landmark& landmark)
        : point(landmark.plane.project(landmark.box.frame_from_box.translation())),
          normal(landmark.plane.normal) {
        const Eigen::Matrix3d axes = plane_axes(normal, landmark.box.frame_from_box.linear().col(0));
        u = axes.col(0);
        v = axes.col(1);
    }
    Plane plane() const {
        const Eigen::Vector3d n = (normal + change[0] * u + change[1] * v).normalized();
        return {n, -n.dot(point) - change[2]};
    }
    /// How the normal moves with change[0] and change[1].
    Eigen::Matrix<double, 3, 2> normal_jacobian() const {
        const Eigen::Vector3d sum = normal + change[0] * u + change[1] * v;
        const Eigen::Vector3d n = sum.normalized();
        Eigen::Matrix<double, 3, 2> jacobian;
        jacobian << u - n * n.dot(u), v - n * n.dot(v);
        return jacobian / sum.norm();
    }
};

/// The four points of a sighting lie on the plane. Their squared distances add up to those of three terms,
/// the centre's and those of the two half axes.
class SightingCost : public ceres::SizedCostFunction<3, 6, 3> {
  public:
    SightingCost(const Sighting& sighting, const Node& node, const PlaneNode& plane)
        : node_(node), plane_(plane) {
        const auto& p = sighting.points_camera;
        centre_ = (p[0] + p[1] + p[2] + p[3]) / 4;
        terms_.col(0) = 2 * sighting.sqrt_weight * centre_;
        terms_.col(1) = std::numbers::sqrt2 * sighting.sqrt_weight * (p[0] - p[2]) / 2;
        terms_.col(2) = std::numbers::sqrt2 * sighting.sqrt_weight * (p[1] - p[3]) / 2;
        weight_ = 2 * sighting.sqrt_weight;
    }

    bool Evaluate(double const* const* /*changes*/, double* residuals, double** jacobians) const override {
        const Plane plane = plane_.plane();
        const Eigen::Vector3d normal_camera = node_.rotation.transpose() * plane.normal;
        Eigen::Map<Eigen::Vector3d> error(residuals);
        error = terms_.transpose() * normal_camera;
        error[0] += weight_ * (plane.normal.dot(node_.translation) + plane.d);
        if (jacobians == nullptr) return true;
        if (jacobians[0] != nullptr) {
            Eigen::Map<Eigen::Matrix<double, 3, 6, Eigen::RowMajor>> by_node(jacobians[0]);
            by_node.setZero();
            by_node.topLeftCorner<1, 3>() = weight_ * plane.normal.transpose();
            for (int i = 0; i < 3; ++i)
                by_node.block<1, 3>(i, 3) = terms_.col(i).cross(normal_camera).transpose() * node_.turn;
        }
        if (jacobians[1] != nullptr) {
            Eigen::Map<Eigen::Matrix3d> by_plane_transposed(jacobians[1]);
            Eigen::Matrix3d points_world = node_.rotation * terms_;
            points_world.col(0) += weight_ * (node_.translation - plane_.point);
            by_plane_transposed.topRows<2>() = plane_.normal_jacobian().transpose() * points_world;
            by_plane_transposed.row(2) << -weight_, 0, 0;
        }
        return true;
    }

  private:
    const Node& node_;
    const PlaneNode& plane_;
    Eigen::Matrix3d terms_;  ///< a column each, weighted: centre, half axes; camera frame
    Eigen::Vector3d centre_;
    double weight_ = 0;  ///< of the centre's distance, 1/metres
};

/// Brings what the residuals share up to date before each evaluation.
class UpdateNodes : public ceres::EvaluationCallback {
  public:
    explicit UpdateNodes(std::vector<Node>& nodes) : nodes_(nodes) {}
    void PrepareForEvaluation(bool /*jacobians*/, bool moved) override {
        if (!moved) return;
        for (Node& node : nodes_) node.update();
    }

  private:
    std::vector<Node>& nodes_;
};

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

/// The graph as Ceres sees it, with all that its residuals refer to.
class Problem {
  public:
    Problem(const std::vector<Pose>& poses, const std::vector<Landmark>* landmarks, double kernel_width)
        : nodes_(poses.begin(), poses.end()),
          has_kernel_(kernel_width > 0),
          kernel_(has_kernel_ ? kernel_width : 1.0) {
        if (landmarks != nullptr) planes_ = std::vector<PlaneNode>(landmarks->begin(), landmarks->end());
    }

    void add(const std::vector<PoseEdge>& edges) {
        loops_ = std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.robust; });
        for (std::ptrdiff_t loop = 0; const PoseEdge& edge : edges) {
            Node &from = nodes_[at(edge.from)], &to = nodes_[at(edge.to)];
            const auto residual = problem_.AddResidualBlock(new EdgeCost(edge, from, to),
                                                            edge.robust && has_kernel_ ? &kernel_ : nullptr,
                                                            from.change.data(), to.change.data());
            if (!edge.robust || loop++ % (loops_ / kLoopsKept + 1) == 0) sparse_.insert(residual);
        }
    }

    void add(const std::vector<Sighting>& sightings) {
        for (const Sighting& sighting : sightings) {
            PlaneNode& plane = planes_.at(at(sighting.landmark));
            Node& node = nodes_[at(sighting.node)];
            sparse_.insert(problem_.AddResidualBlock(new SightingCost(sighting, node, plane),
                                                     &sighting_kernel_, node.change.data(),
                                                     plane.change.data()));
        }
    }

    void fix(int node) {
        double* const anchor = nodes_[at(node)].change.data();
        if (problem_.HasParameterBlock(anchor)) problem_.SetParameterBlockConstant(anchor);
    }

    ceres::Solver::Summary solve(const OptimisationOptions& options) {
        StopWhenStill stop(kStillStep * std::sqrt(static_cast<double>(nodes_.size())));
        ceres::Solver::Options solver = solver_options(options);
        solver.callbacks.push_back(&stop);
        if (loops_ > kLoopsSolvedDirectly) solve_by_conjugate_gradients(solver, std::move(sparse_));
        ceres::Solver::Summary summary;
        ceres::Solve(solver, &problem_, &summary);
        return summary;
    }

    Pose pose(std::size_t node) {
        nodes_[node].update();  // the last step tried may not be the one taken
        return nodes_[node].pose();
    }
    Plane plane(std::size_t landmark) const { return planes_[landmark].plane(); }

  private:
    static ceres::Problem::Options shared(UpdateNodes& update) {
        ceres::Problem::Options options;
        options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        options.evaluation_callback = &update;
        return options;
    }

    std::vector<Node> nodes_;
    std::vector<PlaneNode> planes_;
    bool has_kernel_;
    ceres::CauchyLoss kernel_;
    ceres::CauchyLoss sighting_kernel_{kSightingKernel};
    UpdateNodes update_{nodes_};
    ceres::Problem problem_{shared(update_)};
    std::ptrdiff_t loops_ = 0;
    std::unordered_set<ceres::ResidualBlockId> sparse_;  ///< what is factored when there are many loops
};

}  // namespace

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
    Problem problem(poses, landmarks, options.kernel_width);
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
