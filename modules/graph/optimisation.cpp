// SPDX-License-Identifier: BSD-3-Clause
#include "graph/optimisation.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>

namespace planemap::graph {

namespace {

constexpr double kSightingKernel = 2.0;  // standard deviations: a wrong sighting must not bend the graph

/// A node as Ceres sees it: quaternion (x, y, z, w), then translation.
struct Node {
    std::array<double, 4> rotation{};
    std::array<double, 3> translation{};
};

Eigen::Quaterniond positive(Eigen::Quaterniond q) {
    q.normalize();
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    return q;
}

template <typename T>
Eigen::Matrix<T, 6, 1> raw_error(const Pose& from_from_to, const Eigen::Quaternion<T>& q_from,
                                 const Eigen::Matrix<T, 3, 1>& t_from, const Eigen::Quaternion<T>& q_to,
                                 const Eigen::Matrix<T, 3, 1>& t_to) {
    const Eigen::Quaternion<T> measured = Eigen::Quaterniond(from_from_to.linear()).cast<T>();
    const Eigen::Matrix<T, 3, 1> measured_t = from_from_to.translation().cast<T>();
    Eigen::Quaternion<T> q = measured.conjugate() * (q_from.conjugate() * q_to);
    if (q.w() < T(0)) q.coeffs() = -q.coeffs();
    Eigen::Matrix<T, 6, 1> error;
    error.template head<3>() = measured.conjugate() * (q_from.conjugate() * (t_to - t_from) - measured_t);
    error.template tail<3>() = T(2) * q.vec();
    return error;
}

struct EdgeCost {
    PoseEdge edge;

    template <typename T>
    bool operator()(const T* rotation_from, const T* translation_from, const T* rotation_to,
                    const T* translation_to, T* residual) const {
        using Vector = Eigen::Matrix<T, 3, 1>;
        Eigen::Map<Eigen::Matrix<T, 6, 1>> out(residual);
        out =
            edge.sqrt_information.cast<T>() *
            raw_error<T>(edge.from_from_to, Eigen::Quaternion<T>(rotation_from),
                         Vector(Eigen::Map<const Vector>(translation_from)),
                         Eigen::Quaternion<T>(rotation_to), Vector(Eigen::Map<const Vector>(translation_to)));
        return true;
    }
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
};

struct SightingCost {
    Sighting sighting;
    const PlaneNode* plane;

    template <typename T>
    bool operator()(const T* rotation, const T* translation, const T* change, T* residual) const {
        using Vector = Eigen::Matrix<T, 3, 1>;
        const Eigen::Quaternion<T> q(rotation);
        const Vector t = Eigen::Map<const Vector>(translation);
        const Vector n =
            (plane->normal.cast<T>() + change[0] * plane->u.cast<T>() + change[1] * plane->v.cast<T>())
                .normalized();
        for (int i = 0; i < 4; ++i) {
            const Vector p = q * sighting.points_camera[static_cast<std::size_t>(i)].template cast<T>() + t;
            residual[i] = T(sighting.sqrt_weight) * (n.dot(p - plane->point.cast<T>()) - change[2]);
        }
        return true;
    }
};

Node to_node(const Pose& pose) {
    Node node;
    Eigen::Map<Eigen::Vector4d>(node.rotation.data()) = positive(Eigen::Quaterniond(pose.linear())).coeffs();
    Eigen::Map<Eigen::Vector3d>(node.translation.data()) = pose.translation();
    return node;
}

Pose to_pose(const Node& node) {
    return make_pose(Eigen::Map<const Eigen::Vector3d>(node.translation.data()),
                     Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(node.rotation.data())));
}

ceres::Solver::Options solver_options(const OptimisationOptions& options) {
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    // Without a threaded BLAS below it, so that the same input gives the same bytes.
    if (ceres::IsSparseLinearAlgebraLibraryTypeAvailable(ceres::EIGEN_SPARSE))
        solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
    solver.num_threads = 1;
    solver.max_num_iterations = options.max_iterations;
    solver.function_tolerance = 1e-6;
    solver.parameter_tolerance = 1e-9;
    solver.logging_type = ceres::SILENT;
    return solver;
}

}  // namespace

Twist edge_error(const PoseEdge& edge, const Pose& world_from_from, const Pose& world_from_to) {
    return edge.sqrt_information *
           raw_error<double>(edge.from_from_to, Eigen::Quaterniond(world_from_from.linear()),
                             world_from_from.translation(), Eigen::Quaterniond(world_from_to.linear()),
                             world_from_to.translation());
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
    if (poses.empty() || edges.empty()) return {true, 0, 0, 0};
    std::vector<Node> nodes;
    nodes.reserve(poses.size());
    for (const Pose& pose : poses) nodes.push_back(to_node(pose));

    ceres::Problem::Options shared;
    shared.manifold_ownership = shared.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::EigenQuaternionManifold manifold;
    ceres::CauchyLoss kernel(options.kernel_width > 0 ? options.kernel_width : 1.0);
    ceres::Problem problem(shared);
    for (Node& node : nodes) {
        problem.AddParameterBlock(node.rotation.data(), 4, &manifold);
        problem.AddParameterBlock(node.translation.data(), 3);
    }
    for (const PoseEdge& edge : edges) {
        Node &from = nodes[static_cast<std::size_t>(edge.from)],
             &to = nodes[static_cast<std::size_t>(edge.to)];
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<EdgeCost, 6, 4, 3, 4, 3>(new EdgeCost{edge}),
                                 edge.robust && options.kernel_width > 0 ? &kernel : nullptr,
                                 from.rotation.data(), from.translation.data(), to.rotation.data(),
                                 to.translation.data());
    }
    std::vector<PlaneNode> planes;
    if (landmarks != nullptr) {
        for (const Landmark& landmark : *landmarks) planes.emplace_back(landmark);
    }
    ceres::CauchyLoss sighting_kernel(kSightingKernel);
    for (const Sighting& sighting : sightings) {
        PlaneNode& plane = planes.at(static_cast<std::size_t>(sighting.landmark));
        Node& node = nodes[static_cast<std::size_t>(sighting.node)];
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<SightingCost, 4, 4, 3, 3>(new SightingCost{sighting, &plane}),
            &sighting_kernel, node.rotation.data(), node.translation.data(), plane.change.data());
    }
    Node& anchor = nodes[static_cast<std::size_t>(fixed)];
    problem.SetParameterBlockConstant(anchor.rotation.data());
    problem.SetParameterBlockConstant(anchor.translation.data());

    ceres::Solver::Summary summary;
    ceres::Solve(solver_options(options), &problem, &summary);
    if (summary.IsSolutionUsable()) {
        for (std::size_t i = 0; i < poses.size(); ++i) {
            if (static_cast<int>(i) != fixed) poses[i] = to_pose(nodes[i]);
        }
        for (std::size_t i = 0; i < planes.size(); ++i) (*landmarks)[i].plane = planes[i].plane();
    }
    return {summary.termination_type == ceres::CONVERGENCE, static_cast<int>(summary.iterations.size()),
            summary.initial_cost, summary.final_cost};
}

}  // namespace planemap::graph
