// SPDX-License-Identifier: BSD-3-Clause
// Whether two views show the same when one camera stands at a given pose in the frame of the other.
#pragma once

#include <span>
#include <vector>

#include "core/geometry/same_plane.hpp"
#include "places/keyframe_view.hpp"
#include "places/verification_options.hpp"

namespace planemap::places {

constexpr double kInlierSigmas = 3.5;  ///< of two points' distance, when they are one
/// Metres between planes that are one, as the map merges them (paper section 2.3).
constexpr double kPlaneDistance = kSamePlaneDistance_m;

/// Standard deviation of depth at z in the noisier of both views.
double worst_sigma(const KeyframeView& a, const KeyframeView& b, double z);

/// Numbers of sample points of the regions of both views that agree with a surface of the other view, and
/// that lie clearly before one (the other view saw through them), if the pose errs by at most slack_m.
struct PlaneAgreement {
    int agree = 0, contradict = 0;
};
PlaneAgreement compare_planes(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b,
                              double slack_m = 0);

/// A view beside another one.
struct PlacedView {
    const KeyframeView* view = nullptr;
    Pose other_from_view = Pose::Identity();  ///< the other: this view; the view: the one that is asked about
};

/// How much speaks against a view among others of one place: of its regions, the share of readings that one
/// of the others saw through and none has a surface at; or of the others' regions, the share that it saw
/// through itself, whichever is more. 0 where they look at nothing together.
double share_seen_through(const KeyframeView& view, std::span<const PlacedView> others, double slack_m);

/// Of the points of b that a should see, how many lie within slack_m and noise of one of a with a like
/// descriptor.
struct PointAgreement {
    int visible = 0, agree = 0;
};
PointAgreement compare_points(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b,
                              const VerificationOptions& options, double slack_m);

/// Points of a with points of b: each point of b with the one of a that is nearest in descriptor among those
/// that it lies on within slack_m and noise. A point takes part once.
std::vector<Match> match_at(const KeyframeView& a, const KeyframeView& b, const Pose& a_from_b,
                            const VerificationOptions& options, double slack_m = 0);

}  // namespace planemap::places
