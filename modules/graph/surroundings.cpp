// SPDX-License-Identifier: BSD-3-Clause
#include "graph/surroundings.hpp"

#include <algorithm>
#include <vector>

#include "places/comparison.hpp"

namespace planemap::graph {

namespace {

constexpr double kFarthest = 2.5;    // metres between two cameras that see the same from alike
constexpr double kMinOverlap = 0.4;  // share of points in view, both ways
constexpr double kMinSlack = 0.1;    // metres

// So that the cost is bounded, and dwelling at one place does not outvote the rest.
constexpr std::size_t kMostViews = 60;
constexpr double kSpacing = 0.4;  // metres and radians between two views

/// Views that differ from each other, those of least drift first.
std::vector<SurroundingView> thinned(std::span<const SurroundingView> views) {
    std::vector<SurroundingView> sorted(views.begin(), views.end()), thinned;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.drift_m < b.drift_m; });
    for (const SurroundingView& view : sorted) {
        const bool beside = std::any_of(thinned.begin(), thinned.end(), [&](const SurroundingView& kept) {
            const Pose step = kept.world_from_camera.inverse(Eigen::Isometry) * view.world_from_camera;
            return step.translation().norm() < kSpacing && rotation_angle(step) < kSpacing;
        });
        if (!beside) thinned.push_back(view);
        if (thinned.size() == kMostViews) break;
    }
    return thinned;
}

double mutual_overlap(const SurroundingView& a, const SurroundingView& b, const Pose& a_from_b) {
    return std::min(overlap(*a.view, *b.view, a_from_b),
                    overlap(*b.view, *a.view, a_from_b.inverse(Eigen::Isometry)));
}

const SurroundingView* best_partner(std::span<const SurroundingView> older, const SurroundingView& b) {
    const SurroundingView* best = nullptr;
    double most = kMinOverlap;
    for (const SurroundingView& a : older) {
        const Pose a_from_b = a.world_from_camera.inverse(Eigen::Isometry) * b.world_from_camera;
        if (a_from_b.translation().norm() > kFarthest || a_from_b.linear()(2, 2) < 0.7) continue;
        const double shared = mutual_overlap(a, b, a_from_b);
        if (shared <= most) continue;
        most = shared;
        best = &a;
    }
    return best;
}

enum class Likeness { kUnknown, kAlike, kUnlike };

Likeness compare(const SurroundingView& a, const SurroundingView& b,
                 const places::VerificationOptions& options) {
    constexpr int kMinSamples = 20, kMinPoints = 60;
    constexpr double kAlikeShare = 0.08, kUnlikeShare = 0.02;
    const Pose a_from_b = a.world_from_camera.inverse(Eigen::Isometry) * b.world_from_camera;
    const double slack_m = std::max(kMinSlack, (a.drift_m + b.drift_m) / 2);
    const places::PlaneAgreement planes = compare_planes(*a.view, *b.view, a_from_b, slack_m);
    const int samples = planes.agree + planes.contradict;
    if (samples >= kMinSamples && planes.contradict > options.max_contradiction * samples)
        return Likeness::kUnlike;
    const places::PointAgreement points = compare_points(*a.view, *b.view, a_from_b, options, slack_m);
    if (points.visible < kMinPoints) return Likeness::kUnknown;
    if (points.agree > kAlikeShare * points.visible) return Likeness::kAlike;
    return points.agree < kUnlikeShare * points.visible ? Likeness::kUnlike : Likeness::kUnknown;
}

}  // namespace

Surroundings compare_surroundings(std::span<const SurroundingView> older,
                                  std::span<const SurroundingView> newer,
                                  const places::VerificationOptions& options) {
    const std::vector<SurroundingView> partners = thinned(older);
    Surroundings surroundings;
    for (const SurroundingView& view : thinned(newer)) {
        const SurroundingView* partner = best_partner(partners, view);
        if (partner == nullptr) continue;
        const Likeness likeness = compare(*partner, view, options);
        surroundings.alike += likeness == Likeness::kAlike;
        surroundings.unlike += likeness == Likeness::kUnlike;
    }
    return surroundings;
}

}  // namespace planemap::graph
