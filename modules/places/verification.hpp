// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "places/keyframe_view.hpp"
#include "places/verification_options.hpp"

namespace planemap::places {

/// Why a loop closure was refused, or that it was not.
enum class Verdict {
    kAccepted,
    kFewMatches,     ///< fewer matches than min_inliers
    kFewInliers,     ///< no rigid motion that enough matches agree with
    kFewOfVisible,   ///< too few of the points that both should see agree
    kBadSpread,      ///< inliers in one corner of a view, or a pose that they do not determine
    kContradiction,  ///< one view saw through the other's planes
    kAmbiguous,      ///< another pose explains what both see about as well
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
/// asks whether the evidence suffices, nothing contradicts it, and no other motion explains it about as well,
/// as a step along a pattern that comes again does. The same views and seed give the same answer.
Verification verify(const KeyframeView& a, const KeyframeView& b, const VerificationOptions& options,
                    std::uint64_t seed);

/// Poses of one camera farther apart are two places, not one with its error.
constexpr double kApart_m = 0.3, kApart_rad = 0.1745;  // 10 degrees
bool are_apart(const Pose& a, const Pose& b);

/// What another explanation of a view must stand up to so that `found` is not taken for the truth. A true
/// place may be seen from worse than one that only looks like it.
VerificationOptions rival_options(const VerificationOptions& options, const Verification& found);

}  // namespace planemap::places
