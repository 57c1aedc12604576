// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/ransac.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace planemap::odometry {
namespace {

struct Pair {
    Eigen::Vector3d keyframe, camera;
};

/// The rigid motion of a triangle, or nothing when it is thin or its sides disagree between the views. It
/// lays the triangles on each other by their own axes: a hypothesis needs no least squares
/// (core/geometry/rigid_fit), which would take a singular value decomposition each.
std::optional<Pose> motion_of(const std::array<Pair, 3>& t) {
    for (int i = 0; i < 3; ++i) {
        const auto &a = t[static_cast<std::size_t>(i)], &b = t[static_cast<std::size_t>((i + 1) % 3)];
        const double before = (a.keyframe - b.keyframe).norm(), after = (a.camera - b.camera).norm();
        if (before < 0.05 || std::abs(before - after) > 0.02 + 0.1 * before) return std::nullopt;
    }
    const auto frame = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
        Eigen::Matrix3d axes;
        axes.col(2) = (b - a).cross(c - a).normalized();
        axes.col(0) = ((b + c) / 2 - a).normalized();
        axes.col(1) = axes.col(2).cross(axes.col(0));
        return axes;
    };
    const Eigen::Vector3d ab = t[1].keyframe - t[0].keyframe, ac = t[2].keyframe - t[0].keyframe;
    if (ab.cross(ac).norm() < 0.1 * ab.norm() * ac.norm()) return std::nullopt;
    Pose pose = Pose::Identity();
    pose.linear() = frame(t[0].camera, t[1].camera, t[2].camera) *
                    frame(t[0].keyframe, t[1].keyframe, t[2].keyframe).transpose();
    pose.translation() = (t[0].camera + t[1].camera + t[2].camera) / 3 -
                         pose.linear() * (t[0].keyframe + t[1].keyframe + t[2].keyframe) / 3;
    if (!pose.matrix().allFinite()) return std::nullopt;
    return pose;
}

int count_inliers(const PinholeCamera& camera, std::span<const PointTerm> points, const Pose& pose,
                  double inlier_px) {
    int inliers = 0;
    for (const PointTerm& term : points) {
        const Eigen::Vector3d p = pose * term.point;
        if (!(p.z() > 0.05)) continue;
        if ((camera.project(p) - term.pixel).squaredNorm() > inlier_px * inlier_px) continue;
        if (term.inverse_depth > 0 && std::abs(1 / p.z() - term.inverse_depth) > 4 * term.inverse_depth_sigma)
            continue;
        ++inliers;
    }
    return inliers;
}

}  // namespace

MotionRansacOptions motion_ransac_options(const OdometryOptions& options) {
    return {.inlier_px = options.inlier_sigmas * options.pixel_sigma_px,
            .min_inliers = options.min_inliers,
            .seed = options.seed};
}

std::optional<Pose> ransac_motion(const PinholeCamera& camera, std::span<const PointTerm> points,
                                  const MotionRansacOptions& options) {
    std::vector<Pair> pairs;
    for (const PointTerm& term : points)
        if (term.inverse_depth > 0)
            pairs.push_back(
                {term.point, camera.unproject(term.pixel.x(), term.pixel.y(), 1 / term.inverse_depth)});
    if (pairs.size() < 3) return std::nullopt;
    std::mt19937_64 random(options.seed);
    std::uniform_int_distribution<std::size_t> pick(0, pairs.size() - 1);
    std::optional<Pose> best;
    int best_inliers = options.min_inliers - 1;
    double needed = options.max_iterations;
    for (int i = 0; i < options.max_iterations && i < needed; ++i) {
        const std::array<Pair, 3> sample{pairs[pick(random)], pairs[pick(random)], pairs[pick(random)]};
        const std::optional<Pose> pose = motion_of(sample);
        if (!pose) continue;
        const int inliers = count_inliers(camera, points, *pose, options.inlier_px);
        if (inliers <= best_inliers) continue;
        best = pose;
        best_inliers = inliers;
        const double share = static_cast<double>(inliers) / static_cast<double>(points.size());
        needed = std::log(1 - options.confidence) / std::log(1 - std::min(0.999, share * share * share));
    }
    return best;
}

}  // namespace planemap::odometry
