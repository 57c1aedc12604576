// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "core/camera.hpp"
#include "graph/matching.hpp"
#include "graph/view.hpp"

namespace planemap::graph {

struct VerificationOptions {
    MatchingOptions matching;
    double bearing_sigma = 0.003;  ///< of the points across their rays, radians
    int max_ransac_iterations = 300;
    int min_inliers = 25;             ///< matched points that agree with the pose
    double min_inlier_ratio = 0.35;   ///< of the matches
    double min_visible_ratio = 0.12;  ///< inliers, of the points of either view that the other should see
    int min_cells = 5;  ///< of a 4 by 4 grid over either view, how many the inliers must fall into
    double max_sigma_m = 0.05, max_sigma_rad = 0.03;  ///< of the pose in its worst direction
    double max_contradiction = 0.25;  ///< share of plane samples that the other view saw through
};

/// Why a loop closure was refused, or that it was not.
enum class Verdict {
    kAccepted,
    kFewMatches,     ///< fewer matches than min_inliers
    kFewInliers,     ///< no rigid motion that enough matches agree with
    kFewOfVisible,   ///< too few of the points that both should see agree
    kBadSpread,      ///< inliers in one corner of a view, or a pose that they do not determine
    kContradiction,  ///< one view saw through the other's planes
};

struct Verification {
    Verdict verdict = Verdict::kFewMatches;
    Pose a_from_b = Pose::Identity();        ///< meaningful when accepted
    Matrix6d covariance = Matrix6d::Zero();  ///< of a_from_b: translation, rotation; in b's camera frame
    int matches = 0;
    int inliers = 0;
    int planes = 0;  ///< pairs of regions that agree and were used
};

/// Looks for the one rigid motion that explains what two views share: descriptors matched, three-point
/// RANSAC, refinement over points weighted by depth noise and over pairs of planes, with robust weights; then
/// asks whether the evidence suffices and nothing contradicts it. The same views and seed give the same
/// answer.
Verification verify(const View& a, const View& b, const VerificationOptions& options, std::uint64_t seed);

/// Numbers of sample points of the regions of both views that agree with a surface of the other view, and
/// that lie clearly before one (the other view saw through them), if the pose errs by at most slack_m.
struct PlaneAgreement {
    int agree = 0, contradict = 0;
};
PlaneAgreement compare_planes(const View& a, const View& b, const Pose& a_from_b, double slack_m = 0);

/// Of the points of b that a should see, how many lie within slack_m and noise of one of a with a like
/// descriptor.
struct PointAgreement {
    int visible = 0, agree = 0;
};
PointAgreement compare_points(const View& a, const View& b, const Pose& a_from_b,
                              const VerificationOptions& options, double slack_m);

}  // namespace planemap::graph
