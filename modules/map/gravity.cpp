// SPDX-License-Identifier: BSD-3-Clause
#include "map/gravity.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/angle.hpp"

namespace planemap::map {

namespace {

constexpr std::size_t kPosesUsed = 256;           // of a long trajectory, evenly
constexpr std::size_t kNormals = 16, kPairs = 8;  // large planes that answers are made of
constexpr double kMotion_m = 0.5;  // spread of the positions at which their evidence counts half
constexpr double kMotionShare = 0.5;
constexpr int kRefinements = 4;
constexpr double kHeldWeight = 1e-3;  // of the cameras beside the planes: decides what planes leave open

struct Evidence {
    Eigen::Vector3d normal;
    double weight;
};

std::vector<Evidence> evidence_of(std::span<const MapPlane> planes) {
    std::vector<Evidence> evidence;
    evidence.reserve(planes.size());
    double sum = 0;
    for (const MapPlane& plane : planes) {
        const double length = plane.normal.cast<double>().norm();
        const double weight = std::sqrt(static_cast<double>(plane.area));
        if (!(std::abs(length - 1) < 1e-3 && weight > 0 && std::isfinite(weight))) continue;
        evidence.push_back({plane.normal.cast<double>() / length, weight});
        sum += weight;
    }
    for (Evidence& e : evidence) e.weight /= sum;
    std::stable_sort(evidence.begin(), evidence.end(),
                     [](const Evidence& a, const Evidence& b) { return a.weight > b.weight; });
    return evidence;
}

/// How the camera was held and moved.
struct Handling {
    Eigen::Vector3d up = Eigen::Vector3d::Zero();        ///< unit: the average of -y
    Eigen::Matrix3d sideways = Eigen::Matrix3d::Zero();  ///< u' sideways u is small for the true up

    double fit(const Eigen::Vector3d& u) const { return u.dot(up) - u.dot(sideways * u); }
};

std::optional<Handling> handling_of(std::span<const Pose> world_from_camera) {
    Eigen::Vector3d up = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d rows = Eigen::Matrix3d::Zero(), squares = Eigen::Matrix3d::Zero();
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    double count = 0;
    const std::size_t step = world_from_camera.size() / kPosesUsed + 1;
    for (std::size_t i = 0; i < world_from_camera.size(); i += step) {
        const Pose& pose = world_from_camera[i];
        if (!pose.matrix().allFinite()) continue;
        const Eigen::Vector3d x = pose.linear().col(0);
        if (count == 0) origin = pose.translation();
        const Eigen::Vector3d p = pose.translation() - origin;
        up -= pose.linear().col(1);
        rows += x * x.transpose();
        mean += p;
        squares += p * p.transpose();
        count += 1;
    }
    if (up.norm() < 0.1 * count || count == 0) return std::nullopt;
    mean /= count;
    const Eigen::Matrix3d motion = squares / count - mean * mean.transpose();
    Handling handling;
    handling.up = up.normalized();
    handling.sideways = rows / count + kMotionShare / (motion.trace() + kMotion_m * kMotion_m) * motion;
    return handling;
}

/// 1 for a plane exactly level or upright about u, falling to 0 at the tolerance. Negative: upright.
double agreement(const Eigen::Vector3d& normal, const Eigen::Vector3d& u, double sin2_tolerance) {
    const double cos2 = std::pow(normal.dot(u), 2);
    if (cos2 < sin2_tolerance) return cos2 / sin2_tolerance - 1;
    return std::max(0.0, 1 - (1 - cos2) / sin2_tolerance);
}

std::vector<Eigen::Vector3d> answers(const std::vector<Evidence>& evidence, const Handling& handling,
                                     double min_cos) {
    std::vector<Eigen::Vector3d> found;
    const auto add = [&](const Eigen::Vector3d& direction) {
        const double length = direction.norm();
        if (length < 0.2) return;  // badly determined
        const double cos = direction.dot(handling.up) / length;
        if (std::abs(cos) >= min_cos) found.push_back((cos > 0 ? 1 : -1) / length * direction);
    };
    for (std::size_t i = 0; i < std::min(evidence.size(), kNormals); ++i) add(evidence[i].normal);
    for (std::size_t i = 0; i < std::min(evidence.size(), kPairs); ++i) {
        const Eigen::Vector3d& n = evidence[i].normal;
        add(handling.up - n.dot(handling.up) * n);
        for (std::size_t j = 0; j < i; ++j) add(n.cross(evidence[j].normal));
    }
    return found;
}

Eigen::Vector3d refined(Eigen::Vector3d up, const std::vector<Evidence>& evidence, const Handling& handling,
                        double sin2_tolerance) {
    for (int i = 0; i < kRefinements; ++i) {
        // Up is where the sum of w (n . u)^2 over upright planes less that over level ones is smallest.
        Eigen::Matrix3d sum = kHeldWeight * (handling.sideways - handling.up * handling.up.transpose());
        for (const Evidence& e : evidence) {
            const double fit = agreement(e.normal, up, sin2_tolerance);
            if (fit != 0) sum -= e.weight * fit * e.normal * e.normal.transpose();
        }
        const Eigen::Vector3d next =
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum).eigenvectors().col(0);
        up = next.dot(up) < 0 ? (-next).eval() : next;
    }
    return up;
}

}  // namespace

std::optional<Eigen::Vector3d> find_up(std::span<const MapPlane> planes,
                                       std::span<const Pose> world_from_camera, const GravityRules& rules) {
    const std::vector<Evidence> evidence = evidence_of(planes);
    const std::optional<Handling> handling = handling_of(world_from_camera);
    if (evidence.empty() || !handling) return std::nullopt;

    const double sin2_tolerance = std::pow(std::sin(radians(rules.tolerance_deg)), 2);
    const std::vector<Eigen::Vector3d> candidates =
        answers(evidence, *handling, std::cos(radians(rules.held_deg)));
    std::vector<double> scores;
    for (const Eigen::Vector3d& u : candidates) {
        double score = handling->fit(u);
        for (const Evidence& e : evidence)
            score += e.weight * std::abs(agreement(e.normal, u, sin2_tolerance));
        scores.push_back(score);
    }
    const auto best_score = std::max_element(scores.begin(), scores.end());
    if (best_score == scores.end()) return std::nullopt;
    const Eigen::Vector3d best = candidates[static_cast<std::size_t>(best_score - scores.begin())];
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const bool rival = candidates[i].dot(best) < std::cos(radians(rules.rival_deg));
        if (rival && scores[i] > *best_score - rules.margin) return std::nullopt;
    }
    return refined(best, evidence, *handling, sin2_tolerance);
}

}  // namespace planemap::map
