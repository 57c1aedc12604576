// SPDX-License-Identifier: BSD-3-Clause
// The paper's Table 2: how well a system knows a place again. The first passage at a place counts as the
// ground truth, later visits are compared with it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/trajectory.hpp"
#include "evaluate/evaluation.hpp"

namespace planemap::evaluation {

/// What counts as the same place.
struct PlaceOptions {
    int places = 5;
    double radius_m = 0.4, angle_deg = 30;  ///< a camera this near a place's, and turned so little, is there
    double apart_m = 0.4, apart_deg = 30;   ///< two places differ by one of these at least
    double away_s = 3;                      ///< between two visits
};

/// A place, and the moments of the visits to it: when the camera was nearest to it, each time it came.
struct VisitedPlace {
    Pose world_from_camera = Pose::Identity();
    std::vector<std::int64_t> visits;  ///< microseconds, ascending
};

/// Places of a true trajectory that were visited at least twice: the one with the most visits first, then
/// the one with the most among those apart from it, and so on.
std::vector<VisitedPlace> find_places(const Trajectory& truth, const PlaceOptions& options = {});

/// Errors of later visits against first ones.
struct RevisitErrors {
    int revisits = 0;         ///< compared
    int lost = 0;             ///< later visits without a pose, or without one at the place's first visit
    Statistics metres;        ///< ATE: positions after alignment
    Statistics step_metres;   ///< RPE from one later visit to the next: translation
    Statistics step_degrees;  ///< and rotation
};

/// Compares. As a hand does not come back to the same millimetre, a later visit's reference is the estimate
/// of the first visit times the true motion between the two. Nothing for fewer than four later visits.
std::optional<RevisitErrors> revisit_errors(const Trajectory& truth, const Trajectory& estimate,
                                            const std::vector<VisitedPlace>& places);

}  // namespace planemap::evaluation
