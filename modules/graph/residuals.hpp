// SPDX-License-Identifier: BSD-3-Clause
// The graph's variables and residuals as Ceres sees them.
#pragma once

#include <ceres/ceres.h>

#include <array>
#include <vector>

#include "core/geometry/pose.hpp"
#include "graph/landmarks.hpp"
#include "graph/optimisation.hpp"

namespace planemap::graph {

/// A node as Ceres sees it: how far it has moved from where it started, added to the translation and turned
/// about its own axes. What the residuals need of it is worked out once an evaluation, not once a residual.
struct Node {
    Pose start = Pose::Identity();
    std::array<double, 6> change{};
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< from change[3..5] to a turn about present axes

    explicit Node(const Pose& pose) : start(pose) { update(); }
    void update();
    Pose pose() const;
};

/// A landmark as Ceres sees it: how its plane turns about two axes and shifts, at a reference point on it.
struct PlaneNode {
    Eigen::Vector3d point, normal, u, v;
    std::array<double, 3> change{};

    explicit PlaneNode(const Landmark& landmark);
    Plane plane() const;
    /// How the normal moves with change[0] and change[1].
    Eigen::Matrix<double, 3, 2> normal_jacobian() const;
};

/// The error of an edge before whitening, and what its derivatives need.
struct RawError {
    Eigen::Vector3d offset;        ///< from `from` to `to`, in the frame of `from`
    Eigen::Matrix3d from_from_to;  ///< rotation by the nodes' poses
    Eigen::Quaterniond q;          ///< of the error's rotation, w >= 0
    Twist error;

    RawError(const Pose& measured, const Eigen::Matrix3d& r_from, const Eigen::Vector3d& t_from,
             const Eigen::Matrix3d& r_to, const Eigen::Vector3d& t_to);
};

/// All refer to what they are given, which must outlive them.
class EdgeCost : public ceres::SizedCostFunction<6, 6, 6> {
  public:
    EdgeCost(const PoseEdge& edge, const Node& from, const Node& to) : edge_(edge), from_(from), to_(to) {}
    bool Evaluate(double const* const* changes, double* residuals, double** jacobians) const override;

  private:
    const PoseEdge& edge_;
    const Node &from_, &to_;
};

/// The four points of a sighting, weighted, as three terms whose squared distances to a plane add up to
/// theirs: the centre, and both half axes.
struct SightingTerms {
    Eigen::Matrix<double, 4, 3> by_point;  ///< what of each point is in each term, 1/metres
    Eigen::Matrix3d terms;                 ///< a column each, camera frame
    double weight;                         ///< of the centre's distance, 1/metres

    explicit SightingTerms(const Sighting& sighting);
};

/// Distances of the terms to the plane and, where they are asked for, their derivatives by the node's and the
/// plane's changes (row by row).
void evaluate_sighting(const Eigen::Matrix3d& terms, double weight, const Node& node, const PlaneNode& plane,
                       double* residuals, double* by_node, double* by_plane);

/// The four points of a sighting lie on the plane.
class SightingCost : public ceres::SizedCostFunction<3, 6, 3> {
  public:
    SightingCost(const Sighting& sighting, const Node& node, const PlaneNode& plane)
        : node_(node), plane_(plane), sighting_(sighting) {}
    bool Evaluate(double const* const* changes, double* residuals, double** jacobians) const override;

  private:
    const Node& node_;
    const PlaneNode& plane_;
    SightingTerms sighting_;
};

/// Brings what the residuals share up to date before each evaluation.
class UpdateNodes : public ceres::EvaluationCallback {
  public:
    explicit UpdateNodes(std::vector<Node>& nodes) : nodes_(nodes) {}
    void PrepareForEvaluation(bool jacobians, bool moved) override;

  private:
    std::vector<Node>& nodes_;
};

}  // namespace planemap::graph
