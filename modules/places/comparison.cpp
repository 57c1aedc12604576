// SPDX-License-Identifier: BSD-3-Clause
#include "places/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace planemap::places {

namespace {

/// Points spread over a region, within its outline.
std::vector<Eigen::Vector3d> samples_of(const PlanarRegion& region) {
    constexpr int kSide = 6;
    std::vector<Eigen::Vector3d> samples;
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            const Eigen::Vector2d at((2.0 * i + 1) / kSide - 1, (2.0 * j + 1) / kSide - 1);
            const Eigen::Vector2d flat = at.cwiseProduct(region.box.half_extents.head<2>());
            if (!region.outline.empty() && !contains(region.outline, flat)) continue;
            samples.push_back(
                region.plane.project(region.box.frame_from_box * Eigen::Vector3d(flat.x(), flat.y(), 0)));
        }
    }
    return samples;
}

/// Depth at which the ray of p from the camera meets the nearest region of the view, as a multiple of p;
/// infinity: none.
double ray_cast(const KeyframeView& view, const Eigen::Vector3d& p) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const PlanarRegion& region : view.regions) {
        const double slope = region.plane.normal.dot(p);
        if (std::abs(slope) < 0.17 * p.norm()) continue;  // grazing, within 10 degrees
        const double scale = -region.plane.d / slope;
        if (scale <= 0 || scale >= nearest) continue;
        if (distance(region, scale * p) < 1e-6) nearest = scale;
    }
    return nearest;
}

/// Where samples of b's regions lie with respect to the surfaces that a saw.
PlaneAgreement compare_one_way(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b,
                               double slack_m) {
    PlaneAgreement agreement;
    for (const PlanarRegion& region : b.regions) {
        for (const Eigen::Vector3d& sample : samples_of(region)) {
            const Eigen::Vector3d p = a_from_b * sample;
            if (!a.sees(p)) continue;
            const double behind = (ray_cast(a, p) - 1) * p.z();
            if (!std::isfinite(behind)) continue;
            const double margin =
                kPlaneDistance + slack_m + 3 * worst_sigma(a, b, p.z() + std::max(0.0, behind));
            if (behind > 2 * margin) ++agreement.contradict;
            if (std::abs(behind) < margin) ++agreement.agree;
        }
    }
    return agreement;
}

}  // namespace

double worst_sigma(const KeyframeView& a, const KeyframeView& b, double z) {
    return std::max(a.noise.sigma(z), b.noise.sigma(z));
}

PlaneAgreement compare_planes(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b,
                              double slack_m) {
    const PlaneAgreement of_b = compare_one_way(a, b, a_from_b, slack_m);
    const PlaneAgreement of_a = compare_one_way(b, a, a_from_b.inverse(Eigen::Isometry), slack_m);
    return {of_a.agree + of_b.agree, of_a.contradict + of_b.contradict};
}

PointAgreement compare_points(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b,
                              const VerificationOptions& options, double slack_m) {
    PointAgreement agreement;
    for (const Eigen::Vector3d& p : b.points) agreement.visible += a.sees(a_from_b * p);
    agreement.agree = static_cast<int>(match_at(a, b, a_from_b, options, slack_m).size());
    return agreement;
}

std::vector<Match> match_at(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b,
                            const VerificationOptions& options, double slack_m) {
    std::vector<Match> matches;
    for (std::size_t j = 0; j < b.points.size(); ++j) {
        const Eigen::Vector3d p = a_from_b * b.points[j];
        if (!a.sees(p)) continue;
        const double reach =
            slack_m + kInlierSigmas * (worst_sigma(a, b, p.z()) + options.bearing_sigma * p.norm());
        Match best;
        int best_distance = options.matching.max_distance + 1;
        for (std::size_t i = 0; i < a.points.size(); ++i) {
            if ((a.points[i] - p).squaredNorm() > reach * reach) continue;
            const int d = hamming_distance(a.descriptors[i], b.descriptors[j]);
            if (d >= best_distance) continue;
            best_distance = d;
            best = {static_cast<int>(i), static_cast<int>(j)};
        }
        if (best.first >= 0) matches.push_back(best);
    }
    // A point of a takes part once.
    std::vector<char> taken(a.points.size(), 0);
    std::erase_if(matches, [&](const Match& match) {
        const auto i = static_cast<std::size_t>(match.first);
        return std::exchange(taken[i], 1) != 0;
    });
    return matches;
}

}  // namespace planemap::places
