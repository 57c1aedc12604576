// SPDX-License-Identifier: BSD-3-Clause
#include "graph/bent_depth.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "core/depth_correction.hpp"
#include "graph/optimisation_task.hpp"
#include "graph/pose_problem.hpp"

namespace planemap::graph {

namespace {

constexpr int kNodes = static_cast<int>(DepthCorrection::kNodes);
constexpr double kPrior_per_m = 0.06 / (3 * 3);  // 6 cm at 3 m: 2 cm held half of a real bias back
constexpr double kCertain = 2;  // standard deviations that an offset must have to count at all

using Field = Flatness::Field;
using FieldMatrix = Flatness::Information;

/// How a region bends with the field. Over a region the field is taken for linear in the direction, so that
/// 1 / z' = 1 / z + k . p / z, p' = p / (1 + k . p) in the depth camera's frame: planes stay planes.
Eigen::Matrix<double, 3, kNodes> bending_of(const Sighting& sighting, const CameraInfo& camera,
                                            const Pose& depth_from_camera) {
    constexpr int kSide = 3;           // samples on each side of the region's middle
    constexpr double kHalfSide = 1.7;  // of a rectangle, in standard deviations
    const auto& p = sighting.points_camera;
    const Eigen::Vector3d middle = 0.5 * (p[0] + p[2]), a = p[0] - middle, b = p[1] - middle;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, kNodes> right = Eigen::Matrix<double, 3, kNodes>::Zero();
    for (int i = -kSide; i <= kSide; ++i) {
        for (int j = -kSide; j <= kSide; ++j) {
            const Eigen::Vector3d point = depth_from_camera * (middle + kHalfSide / kSide * (i * a + j * b));
            if (!(point.z() > 0)) continue;
            const Eigen::Vector3d direction = point / point.z();
            const Eigen::Vector2d pixel = camera.depth.project(point);
            if (!camera.depth.sees(pixel)) continue;
            const FieldWeights field = field_weights(camera, pixel.x(), pixel.y());
            normal += direction * direction.transpose();
            for (std::size_t k = 0; k < 4; ++k)
                right.col(static_cast<int>(field.nodes[k])) += field.weights[k] * direction;
        }
    }
    normal.diagonal().array() += 1e-6;
    return normal.ldlt().solve(right);
}

/// A sighting as SightingCost has it, of readings that the field corrects.
class BentSightingCost : public ceres::SizedCostFunction<3, 6, 3, kNodes> {
  public:
    BentSightingCost(const Sighting& sighting, const Node& node, const PlaneNode& plane,
                     const CameraInfo& camera, const Pose& depth_from_camera)
        : node_(node),
          plane_(plane),
          sighting_(sighting),
          bending_(bending_of(sighting, camera, depth_from_camera)) {
        for (std::size_t i = 0; i < 4; ++i) {
            points_depth_.col(static_cast<int>(i)) = depth_from_camera * sighting.points_camera[i];
            rays_camera_.col(static_cast<int>(i)) =
                sighting.points_camera[i] - camera.color_from_depth.translation();
        }
    }

    bool Evaluate(double const* const* changes, double* residuals, double** jacobians) const override {
        const Eigen::Map<const Field> field(changes[2]);
        const Eigen::Vector4d shares = points_depth_.transpose() * (bending_ * field);
        const Eigen::Matrix3d terms =
            sighting_.terms - rays_camera_ * shares.asDiagonal() * sighting_.by_point;
        evaluate_sighting(terms, sighting_.weight, node_, plane_, residuals,
                          jacobians == nullptr ? nullptr : jacobians[0],
                          jacobians == nullptr ? nullptr : jacobians[1]);
        if (jacobians == nullptr || jacobians[2] == nullptr) return true;
        const Eigen::Vector3d normal_camera = node_.rotation.transpose() * plane_.plane().normal;
        const Eigen::Vector4d along = rays_camera_.transpose() * normal_camera;
        Eigen::Map<Eigen::Matrix<double, 3, kNodes, Eigen::RowMajor>>{jacobians[2]} =
            -(sighting_.by_point.transpose() * along.asDiagonal() * points_depth_.transpose()) * bending_;
        return true;
    }

  private:
    const Node& node_;
    const PlaneNode& plane_;
    SightingTerms sighting_;
    Eigen::Matrix<double, 3, kNodes> bending_;
    Eigen::Matrix<double, 3, 4> points_depth_, rays_camera_;  ///< of the four points
};

/// The field as it is known before: it and what was corrected earlier are zero together.
class FieldPrior : public ceres::SizedCostFunction<kNodes, kNodes> {
  public:
    explicit FieldPrior(const Field& so_far) : so_far_(so_far) {}
    bool Evaluate(double const* const* changes, double* residuals, double** jacobians) const override {
        Eigen::Map<Field>{residuals} = (Eigen::Map<const Field>(changes[0]) + so_far_) / kPrior_per_m;
        if (jacobians == nullptr || jacobians[0] == nullptr) return true;
        using Jacobian = Eigen::Matrix<double, kNodes, kNodes, Eigen::RowMajor>;
        Eigen::Map<Jacobian>{jacobians[0]} = Jacobian::Identity() / kPrior_per_m;
        return true;
    }

  private:
    Field so_far_;
};

/// The field as single images say it.
class FlatnessCost : public ceres::SizedCostFunction<kNodes, kNodes> {
  public:
    explicit FlatnessCost(const Flatness& flatness) {
        const Eigen::SelfAdjointEigenSolver<FieldMatrix> axes(flatness.information);
        const double least = 1e-9 * std::max(1.0, axes.eigenvalues().maxCoeff());
        for (int i = 0; i < kNodes; ++i) {
            const double value = axes.eigenvalues()[i];
            if (!(value > least)) continue;
            root_.row(i) = std::sqrt(value) * axes.eigenvectors().col(i).transpose();
            target_[i] = axes.eigenvectors().col(i).dot(flatness.pull) / std::sqrt(value);
        }
    }
    bool Evaluate(double const* const* changes, double* residuals, double** jacobians) const override {
        Eigen::Map<Field>{residuals} = root_ * Eigen::Map<const Field>(changes[0]) - target_;
        if (jacobians != nullptr && jacobians[0] != nullptr) Eigen::Map<Rows>{jacobians[0]} = root_;
        return true;
    }

  private:
    using Rows = Eigen::Matrix<double, kNodes, kNodes, Eigen::RowMajor>;
    Rows root_ = Rows::Zero();
    Field target_ = Field::Zero();
};

class BentProblem {
  public:
    BentProblem(const OptimisationTask& task, const CameraInfo& camera, const Field& so_far,
                const Flatness& flatness)
        : problem_(task.poses, &task.landmarks, task.options.kernel_width) {
        const Pose depth_from_camera = camera.color_from_depth.inverse(Eigen::Isometry);
        problem_.add(task.edges);
        for (const Sighting& sighting : task.sightings) {
            Node& node = problem_.node(sighting.node);
            PlaneNode& plane = problem_.plane_node(sighting.landmark);
            sightings_.push_back(
                problem_.add(new BentSightingCost(sighting, node, plane, camera, depth_from_camera),
                             {node.change.data(), plane.change.data(), field_.data()}));
        }
        problem_.ceres().AddResidualBlock(new FieldPrior(so_far), nullptr, field_.data());
        problem_.ceres().AddResidualBlock(new FlatnessCost(flatness), nullptr, field_.data());
        problem_.fix(0);
    }

    const Field& field() const { return field_; }
    bool solve(const OptimisationOptions& options) { return problem_.solve(options).IsSolutionUsable(); }

    /// What is left of the information on the field when poses and planes are not known either.
    std::optional<FieldMatrix> information() {
        ceres::Problem::EvaluateOptions options;
        options.parameter_blocks = problem_.moving();
        options.parameter_blocks.push_back(field_.data());
        ceres::CRSMatrix jacobian;
        if (!problem_.ceres().Evaluate(options, nullptr, nullptr, nullptr, &jacobian)) return std::nullopt;
        const Eigen::Map<Eigen::SparseMatrix<double, Eigen::RowMajor>> rows(
            jacobian.num_rows, jacobian.num_cols, static_cast<int>(jacobian.values.size()),
            jacobian.rows.data(), jacobian.cols.data(), jacobian.values.data());
        const Eigen::SparseMatrix<double> columns(rows);
        const int others = jacobian.num_cols - kNodes;
        const Eigen::SparseMatrix<double> x = columns.leftCols(others), f = columns.rightCols(kNodes);
        Eigen::SparseMatrix<double> xx = x.transpose() * x;
        for (int i = 0; i < others; ++i) xx.coeffRef(i, i) += 1e-9;
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(xx);
        if (solver.info() != Eigen::Success) return std::nullopt;
        const Eigen::MatrixXd xf = x.transpose() * f, ff = f.transpose() * f;
        return FieldMatrix(ff - xf.transpose() * solver.solve(xf));
    }

    /// Whitened RMS of the sightings' residuals under their kernel.
    double rms() {
        ceres::Problem::EvaluateOptions options;
        options.residual_blocks = sightings_;
        double cost = 0;
        problem_.ceres().Evaluate(options, &cost, nullptr, nullptr, nullptr);
        return std::sqrt(2 * cost / (3 * static_cast<double>(sightings_.size())));
    }

  private:
    Field field_ = Field::Zero();
    PoseProblem problem_;
    std::vector<ceres::ResidualBlockId> sightings_;
};

/// What of the field is certain: along each axis of its information, less by as much as it is uncertain.
Field certain_part(const Field& field, const FieldMatrix& information, double scale, Field& sigmas) {
    const Eigen::SelfAdjointEigenSolver<FieldMatrix> axes(information);
    Field kept = Field::Zero(), variances = Field::Zero();
    for (int i = 0; i < kNodes; ++i) {
        const Field axis = axes.eigenvectors().col(i);
        const double variance = scale / std::max(axes.eigenvalues()[i], 1e-9), along = axis.dot(field);
        const double share = 1 - kCertain * kCertain * variance / std::max(along * along, 1e-18);
        kept += std::max(0.0, share) * along * axis;
        variances += variance * axis.cwiseAbs2();
    }
    sigmas = variances.cwiseSqrt();
    return kept;
}

}  // namespace

BentDepth bent_depth(const OptimisationTask& task, const CameraInfo& camera, const DepthCorrection& so_far,
                     const Flatness& flatness) {
    BentDepth bent;
    bent.sightings = static_cast<int>(task.sightings.size());
    if (task.sightings.empty() || task.edges.empty()) return bent;
    const Field before = Eigen::Map<const Field>(so_far.offsets.data());
    BentProblem problem(task, camera, before, flatness);
    bent.rms_before = problem.rms();
    if (!problem.solve(task.options)) return bent;
    bent.rms_after = problem.rms();
    const std::optional<FieldMatrix> information = problem.information();
    if (!information) return bent;
    Field sigmas;
    const double scale = std::max(1.0, bent.rms_after * bent.rms_after);
    const Field total = certain_part(problem.field() + before, *information, scale, sigmas);
    Eigen::Map<Field>{bent.correction.offsets.data()} = total - before;
    Eigen::Map<Field>{bent.correction.sigmas.data()} = sigmas;
    bent.is_known = true;
    return bent;
}

}  // namespace planemap::graph
