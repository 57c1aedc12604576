// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/plane_search.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

namespace planemap {
namespace {

constexpr std::size_t kLargest = 8;     // regions of each view that are tried
constexpr double kSameAngle = 0.09;     // 5 degrees: two views of an angle, or of a normal
constexpr double kSameDistance = 0.04;  // metres: two views of a plane
constexpr double kSamePlace = 0.5;      // metres along a plane between what two views see of it
constexpr double kIndependent = 0.2;    // least determinant of three normals
constexpr double kExplained = 0.5;      // least share of the view's points

struct Pairing {
    const PlanarRegion *keyframe, *view;
};

std::vector<const PlanarRegion*> largest(std::span<const PlanarRegion> regions) {
    std::vector<const PlanarRegion*> sorted;
    for (const PlanarRegion& region : regions) sorted.push_back(&region);
    std::stable_sort(sorted.begin(), sorted.end(), [](const PlanarRegion* a, const PlanarRegion* b) {
        return a->moments.count > b->moments.count;
    });
    if (sorted.size() > kLargest) sorted.resize(kLargest);
    return sorted;
}

/// camera_from_keyframe that makes three pairs of planes coincide; nothing when their angles differ.
std::optional<Pose> motion_of(const Pairing& a, const Pairing& b, const Pairing& c) {
    Eigen::Matrix3d keyframe_normals, view_normals;
    keyframe_normals << a.keyframe->plane.normal, b.keyframe->plane.normal, c.keyframe->plane.normal;
    view_normals << a.view->plane.normal, b.view->plane.normal, c.view->plane.normal;
    if (std::abs(view_normals.determinant()) < kIndependent) return std::nullopt;
    const auto angle_differs = [](const Pairing& p, const Pairing& q) {
        return std::abs(angle_between(p.keyframe->plane.normal, q.keyframe->plane.normal) -
                        angle_between(p.view->plane.normal, q.view->plane.normal)) > kSameAngle;
    };
    if (angle_differs(a, b) || angle_differs(b, c) || angle_differs(a, c)) return std::nullopt;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(view_normals * keyframe_normals.transpose(),
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Pose pose = Pose::Identity();
    const Eigen::Matrix3d mirror =
        Eigen::Vector3d(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant()).asDiagonal();
    pose.linear() = svd.matrixU() * mirror * svd.matrixV().transpose();
    // A plane moves by d_view = d_keyframe - n_view . t.
    const Eigen::Vector3d shift(a.keyframe->plane.d - a.view->plane.d, b.keyframe->plane.d - b.view->plane.d,
                                c.keyframe->plane.d - c.view->plane.d);
    pose.translation() = view_normals.transpose().inverse() * shift;
    return pose;
}

/// Points of the view's regions that lie on a plane of the keyframe.
double explained_points(const std::vector<const PlanarRegion*>& keyframe,
                        const std::vector<const PlanarRegion*>& view, const Pose& camera_from_keyframe) {
    const Pose keyframe_from_camera = camera_from_keyframe.inverse();
    double points = 0;
    for (const PlanarRegion* region : view) {
        const Plane plane = keyframe_from_camera * region->plane;
        const Eigen::Vector3d mean = keyframe_from_camera * region->moments.mean();
        for (const PlanarRegion* other : keyframe) {
            if (angle_between(plane.normal, other->plane.normal) > kSameAngle ||
                std::abs(other->plane.signed_distance(mean)) > kSameDistance ||
                distance(*other, mean) > kSamePlace)
                continue;
            points += std::min(region->moments.count, other->moments.count);
            break;
        }
    }
    return points;
}

}  // namespace

std::optional<Pose> search_planes(std::span<const PlanarRegion> keyframe_regions,
                                  std::span<const PlanarRegion> regions, const Pose& guess,
                                  const PlaneSearchLimits& limits) {
    const auto keyframe = largest(keyframe_regions), view = largest(regions);
    std::vector<Pairing> pairs;
    for (const PlanarRegion* k : keyframe)
        for (const PlanarRegion* v : view)
            if (angle_between(guess.linear() * k->plane.normal, v->plane.normal) < limits.max_rotation)
                pairs.push_back({k, v});
    double all = 0;
    for (const PlanarRegion* region : view) all += region->moments.count;
    std::optional<Pose> best;
    double best_points = kExplained * all;
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (std::size_t j = i + 1; j < pairs.size(); ++j)
            for (std::size_t k = j + 1; k < pairs.size(); ++k) {
                const std::optional<Pose> pose = motion_of(pairs[i], pairs[j], pairs[k]);
                if (!pose || !is_valid(*pose)) continue;
                const Pose off = *pose * guess.inverse();
                if (rotation_angle(off) > limits.max_rotation ||
                    off.translation().norm() > limits.max_translation)
                    continue;
                // Of motions that explain as much, the one nearest to the guess.
                const double points = explained_points(keyframe, view, *pose) *
                                      (1 - 0.1 * rotation_angle(off) - 0.1 * off.translation().norm());
                if (points <= best_points) continue;
                best_points = points;
                best = pose;
            }
    return best;
}

}  // namespace planemap
