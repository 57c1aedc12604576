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

/// What a view says of a point of a surface that another one saw.
enum class Witness {
    kNothing,  ///< does not look there
    kAgrees,   ///< has a surface there
    kThrough,  ///< sees one clearly behind it
    kBeside,   ///< neither for certain
};

/// What `a` says of a point of b's surface at p, a's frame.
Witness look_at(const KeyframeView& a, const KeyframeView& b, const Eigen::Vector3d& p, double slack_m) {
    if (!a.sees(p)) return Witness::kNothing;
    const double behind = (ray_cast(a, p) - 1) * p.z();
    if (!std::isfinite(behind)) return Witness::kNothing;
    const double margin = kPlaneDistance + slack_m + 3 * worst_sigma(a, b, p.z() + std::max(0.0, behind));
    if (behind > 2 * margin) return Witness::kThrough;
    return std::abs(behind) < margin ? Witness::kAgrees : Witness::kBeside;
}

/// Where samples of b's regions lie with respect to the surfaces that a saw.
PlaneAgreement compare_one_way(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b,
                               double slack_m) {
    PlaneAgreement agreement;
    for (const PlanarRegion& region : b.regions) {
        for (const Eigen::Vector3d& sample : samples_of(region)) {
            const Witness witness = look_at(a, b, a_from_b * sample, slack_m);
            agreement.agree += witness == Witness::kAgrees;
            agreement.contradict += witness == Witness::kThrough;
        }
    }
    return agreement;
}

/// Surface in readings: what was confirmed, and what was seen through.
struct Testimony {
    double agrees = 0, through = 0;
    double share_through() const { return through > 0 ? through / (agrees + through) : 0; }
};

/// What all others say of a view's regions: what one of them has a surface at is there for all.
Testimony seen_by_others(const KeyframeView& view, std::span<const PlacedView> others, double slack_m) {
    Testimony all;
    for (const PlanarRegion& region : view.regions) {
        const std::vector<Eigen::Vector3d> samples = samples_of(region);
        const double readings = region.moments.count / std::max(1.0, static_cast<double>(samples.size()));
        for (const Eigen::Vector3d& sample : samples) {
            bool agrees = false, through = false;
            for (const PlacedView& other : others) {
                const Witness witness = look_at(*other.view, view, other.other_from_view * sample, slack_m);
                agrees = agrees || witness == Witness::kAgrees;
                through = through || witness == Witness::kThrough;
            }
            all.agrees += agrees ? readings : 0;
            all.through += through && !agrees ? readings : 0;
        }
    }
    return all;
}

/// What a view says of all others' regions.
Testimony seen_of_others(const KeyframeView& view, std::span<const PlacedView> others, double slack_m) {
    Testimony all;
    for (const PlacedView& other : others) {
        const Pose view_from_other = other.other_from_view.inverse(Eigen::Isometry);
        for (const PlanarRegion& region : other.view->regions) {
            const std::vector<Eigen::Vector3d> samples = samples_of(region);
            const double readings = region.moments.count / std::max(1.0, static_cast<double>(samples.size()));
            for (const Eigen::Vector3d& sample : samples) {
                const Witness witness = look_at(view, *other.view, view_from_other * sample, slack_m);
                all.agrees += witness == Witness::kAgrees ? readings : 0;
                all.through += witness == Witness::kThrough ? readings : 0;
            }
        }
    }
    return all;
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

double share_seen_through(const KeyframeView& view, std::span<const PlacedView> others, double slack_m) {
    return std::max(seen_by_others(view, others, slack_m).share_through(),
                    seen_of_others(view, others, slack_m).share_through());
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
