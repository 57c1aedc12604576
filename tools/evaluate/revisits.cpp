// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/revisits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/angle.hpp"

namespace planemap::evaluation {

namespace {

constexpr std::int64_t kCandidateStep_us = 100000;
constexpr std::int64_t kMaxGap_us = 500000;  // of a trajectory that is interpolated

/// How far a pose is from a place: up to 1 is there.
double offset_from(const Pose& place, const Pose& pose, double radius_m, double angle_deg) {
    const Pose between = place.inverse() * pose;
    return std::max(between.translation().norm() / radius_m, degrees(rotation_angle(between)) / angle_deg);
}

/// The moments at which the trajectory is nearest to a place, each time that it is there.
std::vector<std::int64_t> visits_to(const Pose& place, const Trajectory& trajectory,
                                    const PlaceOptions& options) {
    const auto away_us = static_cast<std::int64_t>(1e6 * options.away_s);
    std::vector<std::int64_t> visits;
    double nearest = 0;
    std::int64_t last_there = 0;
    for (const StampedPose& pose : trajectory) {
        const double offset = offset_from(place, pose.world_from_camera, options.radius_m, options.angle_deg);
        if (offset > 1) continue;
        const bool comes = visits.empty() || pose.utime - last_there >= away_us;
        if (comes) visits.push_back(pose.utime);
        if (comes || offset < nearest) {
            visits.back() = pose.utime;
            nearest = offset;
        }
        last_there = pose.utime;
    }
    return visits;
}

/// Every tenth of a second of a trajectory.
Trajectory thinned(const Trajectory& trajectory) {
    Trajectory result;
    for (const StampedPose& pose : trajectory)
        if (result.empty() || pose.utime - result.back().utime >= kCandidateStep_us) result.push_back(pose);
    return result;
}

}  // namespace

std::vector<VisitedPlace> find_places(const Trajectory& truth, const PlaceOptions& options) {
    const Trajectory poses = thinned(truth);
    std::vector<VisitedPlace> candidates;
    for (const StampedPose& pose : poses) {
        VisitedPlace place{pose.world_from_camera, visits_to(pose.world_from_camera, poses, options)};
        if (place.visits.size() >= 2) candidates.push_back(std::move(place));
    }
    std::stable_sort(candidates.begin(), candidates.end(), [](const VisitedPlace& a, const VisitedPlace& b) {
        return a.visits.size() > b.visits.size();
    });
    std::vector<VisitedPlace> places;
    for (const VisitedPlace& candidate : candidates) {
        if (static_cast<int>(places.size()) == options.places) break;
        const bool apart = std::all_of(places.begin(), places.end(), [&](const VisitedPlace& place) {
            return offset_from(place.world_from_camera, candidate.world_from_camera, options.apart_m,
                               options.apart_deg) > 1;
        });
        if (!apart) continue;
        places.push_back(candidate);
        places.back().visits = visits_to(candidate.world_from_camera, truth, options);
    }
    return places;
}

std::optional<RevisitErrors> revisit_errors(const Trajectory& truth, const Trajectory& estimate,
                                            const std::vector<VisitedPlace>& places) {
    RevisitErrors errors;
    Trajectory references, visits;
    for (const VisitedPlace& place : places) {
        const auto true_first = pose_at(truth, place.visits.front(), kMaxGap_us);
        const auto first = pose_at(estimate, place.visits.front(), kMaxGap_us);
        for (std::size_t i = 1; i < place.visits.size(); ++i) {
            const auto true_later = pose_at(truth, place.visits[i], kMaxGap_us);
            const auto later = pose_at(estimate, place.visits[i], kMaxGap_us);
            if (!true_first || !true_later || !first || !later) {
                ++errors.lost;
                continue;
            }
            references.push_back({place.visits[i], *first * true_first->inverse() * *true_later});
            visits.push_back({place.visits[i], *later});
        }
    }
    errors.revisits = static_cast<int>(visits.size());
    for (Trajectory* trajectory : {&references, &visits}) {
        std::stable_sort(trajectory->begin(), trajectory->end(),
                         [](const StampedPose& a, const StampedPose& b) { return a.utime < b.utime; });
    }
    const auto absolute = absolute_error(references, visits, associate(references, visits, {}));
    const auto relative = relative_error(references, visits, {1, DeltaUnit::frames}, {});
    if (!absolute || !relative) return std::nullopt;
    errors.metres = absolute->metres;
    errors.step_metres = relative->metres;
    errors.step_degrees = relative->degrees;
    return errors;
}

}  // namespace planemap::evaluation
