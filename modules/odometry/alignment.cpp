// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace planemap::odometry {
namespace {

constexpr double kNearest = 0.05;  // metres; nothing nearer to the camera is measured

using Matrix8d = Eigen::Matrix<double, 8, 8>;
using Vector8d = Eigen::Matrix<double, 8, 1>;

constexpr int kOffset = 6, kReadout = 7;

/// Normal equations in (x, time offset, readout); the readout is not solved for.
struct Normal {
    Matrix8d information = Matrix8d::Zero();
    Vector8d gradient = Vector8d::Zero();
};

double heavy_tail_weight(double squared_sigmas, double scale) {
    return 1 / (1 + squared_sigmas / (scale * scale));
}

void add_row(const Vector8d& j, double residual, double weight, Normal& normal) {
    normal.information.noalias() += (weight * j) * j.transpose();
    normal.gradient.noalias() += (weight * residual) * j;
}

/// Where a point is when the colour image and when the depth image shows it, camera frame.
struct Seen {
    Eigen::Vector3d in_color, in_depth;
};

Seen see(const Alignment& a, const PointTerm& term, const Pose& camera_from_keyframe, double offset) {
    const Eigen::Vector3d p = camera_from_keyframe * term.point;
    const double late = a.readout_s * row_share(a.camera, term.pixel.y());
    return {moved((offset + late) * a.velocity, p), moved(late * a.velocity, p)};
}

/// normal_of(term) is what a point is added to.
template <typename NormalOf>
void add_points(const Alignment& a, const Pose& camera_from_keyframe, double offset,
                const NormalOf& normal_of) {
    for (const PointTerm& term : a.points) {
        Normal& normal = normal_of(term);
        const Seen seen = see(a, term, camera_from_keyframe, offset);
        Eigen::Vector3d r, r_depth;
        Eigen::Matrix<double, 3, 6> j, j_depth;
        if (!point_residual(a.camera, term, seen.in_color, r, &j) ||
            !point_residual(a.camera, term, seen.in_depth, r_depth, &j_depth))
            continue;
        // The derivative by time is that by the motion of a second; by the readout, that of the row's share
        // of it, and of the point.
        const double share = row_share(a.camera, term.pixel.y());
        const Eigen::Vector3d rate = camera_from_keyframe.linear() * term.point_per_readout;
        const auto full_row = [&](const Eigen::Matrix<double, 1, 6>& by_motion, bool is_color) {
            const double by_time = by_motion.dot(a.velocity);
            Vector8d row;
            row << by_motion.transpose(), is_color ? by_time : 0,
                share * by_time + by_motion.head<3>().dot(rate);
            return row;
        };
        const double weight = heavy_tail_weight(r.head<2>().squaredNorm(), a.loss_scale);
        add_row(full_row(j.row(0), true), r.x(), weight, normal);
        add_row(full_row(j.row(1), true), r.y(), weight, normal);
        if (term.inverse_depth > 0)
            add_row(full_row(j_depth.row(2), false), r_depth.z(),
                    heavy_tail_weight(r_depth.z() * r_depth.z(), a.loss_scale), normal);
    }
}

Twist gradient_at(const QuadraticTerm& term, const Pose& camera_from_keyframe) {
    return term.gradient + term.information * twist_from_pose(camera_from_keyframe * term.at.inverse());
}

void add_quadratics(const Alignment& a, const Pose& camera_from_keyframe, Normal& normal) {
    for (const QuadraticTerm& term : a.quadratics) {
        normal.information.topLeftCorner<6, 6>() += term.information;
        normal.gradient.head<6>() += gradient_at(term, camera_from_keyframe);
    }
}

/// Sums outer products of the blocks' gradients, the time offset being solved for; see
/// AlignmentResult::scatter. `offset_share` is what a gradient by the offset does to that by x.
Matrix6d scatter_of(const Alignment& a, const AlignmentResult& result, const Twist& offset_share) {
    std::array<Normal, kTiles> tiles;
    add_points(a, result.camera_from_keyframe, result.color_offset_s, [&](const PointTerm& term) -> Normal& {
        return tiles[static_cast<std::size_t>(tile_of(a.camera, term.pixel.x(), term.pixel.y()))];
    });
    Matrix6d scatter = Matrix6d::Zero();
    int blocks = 0;
    const auto add = [&](const Twist& gradient) {
        scatter += gradient * gradient.transpose();
        ++blocks;
    };
    for (const Normal& tile : tiles)
        if (tile.information(0, 0) > 0) add(tile.gradient.head<6>() - tile.gradient(kOffset) * offset_share);
    for (const QuadraticTerm& term : a.quadratics)
        if (!term.is_prior && term.information.trace() > 0)
            add(gradient_at(term, result.camera_from_keyframe));
    // Six values were fitted to them.
    constexpr double kFitted = 6, kMostCorrection = 4;
    return scatter *
           (blocks > kFitted ? std::min(kMostCorrection, blocks / (blocks - kFitted)) : kMostCorrection);
}

void mark_inliers(const Alignment& a, AlignmentResult& result) {
    double squared_px = 0;
    result.inlier.assign(a.points.size(), 0);
    for (std::size_t i = 0; i < a.points.size(); ++i) {
        const Seen seen = see(a, a.points[i], result.camera_from_keyframe, result.color_offset_s);
        Eigen::Vector3d r, r_depth;
        if (!point_residual(a.camera, a.points[i], seen.in_color, r) ||
            !point_residual(a.camera, a.points[i], seen.in_depth, r_depth))
            continue;
        if (!(r.head<2>().norm() < a.inlier_sigmas && std::abs(r_depth.z()) < 2 * a.inlier_sigmas)) continue;
        result.inlier[i] = 1;
        ++result.inliers;
        squared_px += r.head<2>().squaredNorm() * a.points[i].pixel_sigma * a.points[i].pixel_sigma;
    }
    if (result.inliers > 0) result.residual_px = std::sqrt(squared_px / result.inliers);
}

}  // namespace

int tile_of(const PinholeCamera& camera, double u, double v) {
    const auto part = [](double at, int size, int parts) {
        const double share = (at + 0.5) / size * parts;
        return share > 0 ? std::min(parts - 1, static_cast<int>(std::min<double>(share, parts))) : 0;
    };
    return part(v, camera.height, kTileRows) * kTileColumns + part(u, camera.width, kTileColumns);
}

Matrix6d assumed_covariance(const AlignmentResult& result) {
    return result.information.ldlt().solve(Matrix6d::Identity());
}

Matrix6d covariance_of(const AlignmentResult& result) {
    const Matrix6d assumed = assumed_covariance(result);
    const Matrix6d found = assumed * result.scatter * assumed;
    return assumed + 0.5 * (found + found.transpose());
}

bool point_residual(const PinholeCamera& camera, const PointTerm& term, const Eigen::Vector3d& p,
                    Eigen::Vector3d& residual, Eigen::Matrix<double, 3, 6>* jacobian) {
    if (!(p.z() > kNearest)) return false;
    const double inverse = 1 / p.z(), x = p.x() * inverse, y = p.y() * inverse;
    const double u_scale = camera.fx / term.pixel_sigma, v_scale = camera.fy / term.pixel_sigma;
    residual.x() = (camera.fx * x + camera.cx - term.pixel.x()) / term.pixel_sigma;
    residual.y() = (camera.fy * y + camera.cy - term.pixel.y()) / term.pixel_sigma;
    const bool has_depth = term.inverse_depth > 0;
    residual.z() = has_depth ? (inverse - term.inverse_depth) / term.inverse_depth_sigma : 0;
    if (jacobian) {
        const double w_scale = has_depth ? -inverse / term.inverse_depth_sigma : 0;
        jacobian->row(0) << u_scale * inverse, 0, -u_scale * x * inverse, -u_scale * x * y,
            u_scale * (1 + x * x), -u_scale * y;
        jacobian->row(1) << 0, v_scale * inverse, -v_scale * y * inverse, -v_scale * (1 + y * y),
            v_scale * x * y, v_scale * x;
        jacobian->row(2) << 0, 0, w_scale * inverse, w_scale * y, -w_scale * x, 0;
    }
    return true;
}

AlignmentResult align(const Alignment& a, const Pose& initial, int max_iterations) {
    AlignmentResult result;
    result.camera_from_keyframe = initial;
    result.color_offset_s = a.color_offset_s;
    const double offset_information = 1 / (a.color_offset_sigma_s * a.color_offset_sigma_s);
    Normal normal;
    Eigen::LDLT<Eigen::Matrix<double, kReadout, kReadout>> solver;
    for (int i = 0; i < max_iterations && !result.converged; ++i) {
        normal = Normal{};
        add_points(a, result.camera_from_keyframe, result.color_offset_s,
                   [&](const PointTerm&) -> Normal& { return normal; });
        add_quadratics(a, result.camera_from_keyframe, normal);
        normal.information(kOffset, kOffset) += offset_information;
        normal.gradient(kOffset) += offset_information * (result.color_offset_s - a.color_offset_s);
        const auto solvable = normal.information.topLeftCorner<kReadout, kReadout>();
        solver.compute(solvable);
        const Eigen::Matrix<double, kReadout, 1> step = -solver.solve(normal.gradient.head<kReadout>());
        if (!step.allFinite()) return result;
        result.camera_from_keyframe = pose_from_twist(step.head<6>()) * result.camera_from_keyframe;
        result.color_offset_s += step(6);
        result.converged = step.head<6>().norm() < 1e-4;
    }
    result.camera_from_keyframe = orthonormalised(result.camera_from_keyframe);
    // The time offset is marginalised out; and all else out of the readout.
    result.information = normal.information.topLeftCorner<6, 6>();
    Twist offset_share = Twist::Zero();
    if (normal.information(kOffset, kOffset) > 0) {
        const Twist coupling = normal.information.block<6, 1>(0, kOffset);
        offset_share = coupling / normal.information(kOffset, kOffset);
        result.information -= offset_share * coupling.transpose();
    }
    result.scatter = scatter_of(a, result, offset_share);
    const Eigen::Matrix<double, kReadout, 1> coupling = normal.information.topRightCorner<kReadout, 1>();
    const Eigen::Matrix<double, kReadout, 1> solved = solver.solve(coupling);
    result.readout_information = std::max(0.0, normal.information(kReadout, kReadout) - coupling.dot(solved));
    result.readout_gradient = normal.gradient(kReadout) - solved.dot(normal.gradient.head<kReadout>());
    mark_inliers(a, result);
    return result;
}

}  // namespace planemap::odometry
