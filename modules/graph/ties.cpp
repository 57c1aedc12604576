// SPDX-License-Identifier: BSD-3-Clause
#include "graph/ties.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "graph/node_index.hpp"

namespace planemap::graph {

namespace {

constexpr int kMostMeasurements = 4;

/// How a small motion in frame b reads in frame a: a_from_b exp(x) = exp(adjoint x) a_from_b.
Matrix6d adjoint(const Pose& a_from_b) {
    Matrix6d matrix = Matrix6d::Zero();
    matrix.topLeftCorner<3, 3>() = matrix.bottomRightCorner<3, 3>() = a_from_b.linear();
    matrix.topRightCorner<3, 3>() = skew(a_from_b.translation()) * a_from_b.linear();
    return matrix;
}

Matrix6d information(const PoseEdge& edge) {
    return edge.sqrt_information.transpose() * edge.sqrt_information;
}

/// W with W^T W = information.
Matrix6d root_of(const Matrix6d& information) {
    return information.llt().matrixU();
}

/// The edge's error at the poses, not whitened, in the frame of its `to`.
Twist raw_error(const PoseEdge& edge, const std::vector<Pose>& poses) {
    PoseEdge plain = edge;
    plain.sqrt_information.setIdentity();
    return edge_error(plain, poses[at(edge.from)], poses[at(edge.to)]);
}

/// Gives the edge this error at the poses.
void set_error(PoseEdge& edge, const Twist& error, const std::vector<Pose>& poses) {
    const Pose from_from_to = poses[at(edge.from)].inverse(Eigen::Isometry) * poses[at(edge.to)];
    edge.from_from_to = orthonormalised(from_from_to * pose_from_twist(error).inverse(Eigen::Isometry));
}

PoseEdge leading_from(int node, const PoseEdge& edge) {
    return edge.from == node ? edge : reversed(edge);
}

void renumber(int& node, int gone) {
    if (node > gone) --node;
}

/// Largest standard deviation of a covariance's translation and rotation; 0 where it is not usable.
Drift worst_sigmas(const Matrix6d& covariance) {
    if (!covariance.allFinite()) return {0, 0};
    const auto worst = [](const Eigen::Matrix3d& block) {
        return std::sqrt(std::max(0.0, block.diagonal().maxCoeff()));
    };
    return {worst(covariance.topLeftCorner<3, 3>()), worst(covariance.bottomRightCorner<3, 3>())};
}

}  // namespace

Matrix6d within_reach(const Matrix6d& covariance, double seconds) {
    constexpr double kSpeed = 1;  // m/s and rad/s
    if (!covariance.allFinite() || !(seconds > 0)) return covariance;
    const double reach = kSpeed * seconds;
    const Matrix6d sum = covariance + reach * reach * Matrix6d::Identity();
    // Of inverses the sum's inverse; not as a difference, in which what is very wide would count as certain.
    const Matrix6d less = reach * reach * sum.ldlt().solve(covariance);
    return 0.5 * (less + less.transpose());
}

Tie odometry_tie(const GraphOptions& options, int from, int to, const Pose& step, const Matrix6d& covariance,
                 const Drift& detour) {
    const double drift =
        options.drift_per_metre * step.translation().norm() + options.drift_per_radian * rotation_angle(step);
    Tie tie;
    tie.edge = {from, to, step,
                sqrt_information(covariance, options.odometry_sigma_m + detour.metres,
                                 options.odometry_sigma_rad + detour.radians),
                false};
    tie.drift = Drift{drift, drift} + worst_sigmas(covariance) + detour;
    tie.is_step = true;
    return tie;
}

Tie gap_tie(const GraphOptions& options, int from, int to, const Pose& step, double seconds) {
    const double reach = options.max_lost_speed * seconds;
    const Matrix6d nothing_known = Matrix6d::Zero();
    Tie gap;
    gap.edge = {from, to, step, sqrt_information(nothing_known, 1.0 + reach, std::numbers::pi), false};
    gap.drift = {reach, std::numbers::pi};
    return gap;
}

Tie loop_tie(const GraphOptions& options, int from, int to, const Pose& from_from_to,
             const Matrix6d& covariance, std::int64_t closure) {
    Tie tie;
    tie.edge = {from, to, from_from_to,
                sqrt_information(covariance, options.loop_sigma_m, options.loop_sigma_rad), true};
    tie.drift = worst_sigmas(covariance) + Drift{options.loop_sigma_m, options.loop_sigma_rad};
    tie.closure = closure;
    tie.is_known = tie.is_applied = false;
    return tie;
}

PoseEdge reversed(const PoseEdge& edge) {
    PoseEdge out = edge;
    out.from = edge.to;
    out.to = edge.from;
    out.from_from_to = edge.from_from_to.inverse(Eigen::Isometry);
    out.sqrt_information = edge.sqrt_information * adjoint(out.from_from_to);
    return out;
}

Tie handed_over(const Tie& tie, const Tie& to_keeper, int gone, const std::vector<Pose>& poses) {
    const PoseEdge to_other = leading_from(gone, tie.edge);
    const PoseEdge from_keeper = reversed(leading_from(gone, to_keeper.edge));  // ends in `gone`
    const Matrix6d by_motion = adjoint(poses[at(to_other.to)].inverse(Eigen::Isometry) * poses[at(gone)]);
    const Matrix6d covariance = information(to_other).inverse() +
                                by_motion * information(from_keeper).inverse() * by_motion.transpose();
    const Twist pull = information(to_other) * raw_error(to_other, poses);
    Tie out = tie;
    out.is_step = false;
    out.drift = tie.drift + to_keeper.drift;
    out.edge.from = from_keeper.from;
    out.edge.to = to_other.to;
    out.edge.sqrt_information = root_of(covariance.inverse());
    set_error(out.edge, covariance * pull, poses);
    return out;
}

void fuse(Tie& tie, const Tie& other, const std::vector<Pose>& poses) {
    const PoseEdge second = leading_from(tie.edge.from, other.edge);
    const Matrix6d information_1 = information(tie.edge), information_2 = information(second);
    const Matrix6d sum = information_1 + information_2;
    const Twist error = sum.llt().solve(information_1 * raw_error(tie.edge, poses) +
                                        information_2 * raw_error(second, poses));
    const int measurements = tie.measurements + other.measurements;
    tie.measurements = std::min(measurements, kMostMeasurements);
    tie.edge.sqrt_information = root_of(sum * tie.measurements / measurements);
    set_error(tie.edge, error, poses);
    if (other.drift.size() < tie.drift.size()) tie.drift = other.drift;
    tie.is_step = tie.is_step || other.is_step;
    tie.closure = std::max(tie.closure, other.closure);
    tie.weight = std::max(tie.weight, other.weight);
}

void hand_over(std::vector<Tie>& ties, const Tie& to_keeper, int gone, const std::vector<Pose>& poses) {
    const int keeper = to_keeper.other(gone);
    const auto of_gone_begin =
        std::stable_partition(ties.begin(), ties.end(), [&](const Tie& tie) { return !tie.touches(gone); });
    const std::vector<Tie> of_gone(of_gone_begin, ties.end());
    ties.erase(of_gone_begin, ties.end());
    for (const Tie& tie : of_gone) {
        if (tie.touches(keeper) || (tie.edge.robust && tie.weight < kDistrusted)) continue;
        const Tie handed = handed_over(tie, to_keeper, gone, poses);
        const auto same = std::find_if(ties.begin(), ties.end(), [&](const Tie& t) {
            const bool is_fit = t.is_applied && !(t.edge.robust && t.weight < kDistrusted);
            return is_fit && t.touches(keeper) && t.other(keeper) == handed.edge.to;
        });
        if (same != ties.end()) {
            fuse(*same, handed, poses);
        } else {
            ties.push_back(handed);
        }
    }
    for (Tie& tie : ties) {
        renumber(tie.edge.from, gone);
        renumber(tie.edge.to, gone);
    }
}

}  // namespace planemap::graph
