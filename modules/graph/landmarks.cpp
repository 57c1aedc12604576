// SPDX-License-Identifier: BSD-3-Clause
#include "graph/landmarks.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"
#include "graph/node_index.hpp"

namespace planemap::graph {

namespace {

/// The box of both, with the first one's axes.
Box united(const Box& a, const Box& b) {
    std::vector<Eigen::Vector3d> corners;
    for (const auto& corner : a.corners()) corners.push_back(corner);
    for (const auto& corner : b.corners()) corners.push_back(corner);
    return bound(a.frame_from_box.linear(), corners);
}

double rms_distance(const std::array<Eigen::Vector3d, 4>& points, const Plane& plane) {
    double sum = 0;
    for (const auto& p : points) sum += plane.signed_distance(p) * plane.signed_distance(p);
    return std::sqrt(sum / 4);
}

}  // namespace

LandmarkOptions landmark_options(const GraphOptions& options) {
    LandmarkOptions out;
    out.min_extent_m = options.landmark_extent_m;
    out.max_angle_deg = options.landmark_angle_deg;
    out.max_distance_m = options.landmark_distance_m;
    out.max_gap_m = options.landmark_gap_m;
    out.sigma_m = options.landmark_sigma_m;
    return out;
}

Eigen::Vector4d sighting_error(const Sighting& sighting, const Pose& world_from_camera,
                               const Plane& plane_world) {
    Eigen::Vector4d error;
    for (int i = 0; i < 4; ++i) {
        const Eigen::Vector3d p_world = world_from_camera * sighting.points_camera[at(i)];
        error[i] = sighting.sqrt_weight * plane_world.signed_distance(p_world);
    }
    return error;
}

/// Not map/merging's rules: a wrong tie bends the whole trajectory, so it asks for less angle, and for the
/// distance where the sighting's points are.
bool Landmarks::fits(const Candidate& region, const Landmark& landmark) const {
    return angle_between(region.plane.normal, landmark.plane.normal) < radians(options_.max_angle_deg) &&
           rms_distance(region.points, landmark.plane) < options_.max_distance_m &&
           distance(region.box, landmark.box) < options_.max_gap_m;
}

double Landmarks::add(int node, const std::vector<PlanarRegion>& regions, const Pose& world_from_camera,
                      const DepthNoise& noise) {
    double worst = 0;
    for (const PlanarRegion& region : regions) {
        const PlaneFit fit = fit_plane(region.moments);
        if (!fit.valid || std::sqrt(fit.variances[1]) < options_.min_extent_m) continue;
        Sighting sighting;
        sighting.node = node;
        const Eigen::Vector3d centre = region.plane.project(region.moments.mean());
        const Eigen::Vector3d u = std::sqrt(fit.variances[2]) * fit.axes.col(2);
        const Eigen::Vector3d v = std::sqrt(fit.variances[1]) * fit.axes.col(1);
        sighting.points_camera = {centre + u, centre + v, centre - u, centre - v};
        for (auto& p : sighting.points_camera) p = region.plane.project(p);
        sighting.sqrt_weight = 1 / std::hypot(options_.sigma_m, noise.sigma(centre.z()));

        Candidate candidate{world_from_camera * region.plane, world_from_camera * region.box, {}};
        for (std::size_t i = 0; i < 4; ++i)
            candidate.points[i] = world_from_camera * sighting.points_camera[i];
        int fitting = 0;
        for (std::size_t i = 0; i < landmarks_.size(); ++i) {
            if (!same_.stands(static_cast<int>(i)) || !fits(candidate, landmarks_[i])) continue;
            ++fitting;
            sighting.landmark = static_cast<int>(i);
        }
        if (fitting > 1) continue;
        if (fitting == 0) {
            sighting.landmark = static_cast<int>(landmarks_.size());
            landmarks_.push_back({candidate.plane, candidate.box, 0});
            same_.resize(landmarks_.size());
        }
        Landmark& landmark = landmarks_[at(sighting.landmark)];
        landmark.box = united(landmark.box, candidate.box);
        ++landmark.sightings;
        sightings_.push_back(sighting);
        worst = std::max(worst, sighting_error(sighting, world_from_camera, landmark.plane).norm());
    }
    return worst;
}

void Landmarks::follow(const std::vector<Landmark>& optimised, const std::vector<Pose>& world_moves) {
    for (std::size_t i = 0; i < optimised.size(); ++i) landmarks_[i].plane = optimised[i].plane;
    std::size_t next = optimised.size();
    for (const Sighting& sighting : sightings_) {  // the first sighting of a landmark founded it
        if (next == landmarks_.size()) break;
        if (at(sighting.landmark) != next) continue;
        const Pose& move = world_moves[at(sighting.node)];
        landmarks_[next].plane = move * landmarks_[next].plane;
        landmarks_[next].box = move * landmarks_[next].box;
        ++next;
    }
}

void Landmarks::merge() {
    const int count = static_cast<int>(landmarks_.size());
    for (int i = 0; i < count; ++i) {
        if (!same_.stands(i)) continue;
        for (int j = 0; j < i; ++j) {
            if (!same_.stands(j)) continue;
            Landmark &older = landmarks_[at(j)], &newer = landmarks_[at(i)];
            Candidate candidate{newer.plane, newer.box, newer.box.face()};
            for (auto& p : candidate.points) p = newer.plane.project(p);  // the plane moved, the box did not
            if (!fits(candidate, older)) continue;
            older.box = united(older.box, newer.box);
            older.sightings += newer.sightings;
            same_.join(j, i);
            break;
        }
    }
    for (Sighting& sighting : sightings_) sighting.landmark = same_.find(sighting.landmark);
}

void Landmarks::hand_over(int gone, int keeper, const Pose& keeper_from_gone) {
    const auto sees = [&](int landmark) {
        return std::any_of(sightings_.begin(), sightings_.end(), [&](const Sighting& sighting) {
            return sighting.node == keeper && sighting.landmark == landmark;
        });
    };
    for (Sighting& sighting : sightings_) {
        if (sighting.node != gone) continue;
        sighting.node = sees(sighting.landmark) ? -1 : keeper;
        for (auto& p : sighting.points_camera) p = keeper_from_gone * p;
    }
    std::erase_if(sightings_, [](const Sighting& sighting) { return sighting.node < 0; });
    for (Sighting& sighting : sightings_) sighting.node -= sighting.node > gone;
    forget_unseen();
}

/// Landmarks that stand for nothing any more go, and the others are numbered and counted anew.
void Landmarks::forget_unseen() {
    for (Landmark& landmark : landmarks_) landmark.sightings = 0;
    for (Sighting& sighting : sightings_) {
        sighting.landmark = same_.find(sighting.landmark);
        ++landmarks_[at(sighting.landmark)].sightings;
    }
    std::vector<int> number(landmarks_.size(), -1);
    std::vector<Landmark> kept;
    for (std::size_t i = 0; i < landmarks_.size(); ++i) {
        if (landmarks_[i].sightings == 0) continue;
        number[i] = static_cast<int>(kept.size());
        kept.push_back(landmarks_[i]);
    }
    landmarks_ = std::move(kept);
    same_ = UnionFind<int>(landmarks_.size());
    for (Sighting& sighting : sightings_) sighting.landmark = number[at(sighting.landmark)];
}

std::vector<Sighting> Landmarks::shared() const {
    std::vector<Sighting> shared;
    for (const Sighting& sighting : sightings_) {
        if (landmarks_[at(sighting.landmark)].sightings > 1) shared.push_back(sighting);
    }
    return shared;
}

}  // namespace planemap::graph
