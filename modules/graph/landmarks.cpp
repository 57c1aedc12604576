// SPDX-License-Identifier: BSD-3-Clause
#include "graph/landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/geometry/angle.hpp"
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

/// A landmark as it is laid through what is seen of it.
class LandmarkSum {
  public:
    explicit LandmarkSum(bool is_surface) { landmark_.is_surface = is_surface; }

    void add(const Sighting& sighting, const Pose& world_from_camera) {
        constexpr double kHalfSide = 1.7320508;  // of a rectangle, in standard deviations
        const Eigen::Vector3d centre = 0.5 * (sighting.points_camera[0] + sighting.points_camera[2]);
        const double weight = sighting.sqrt_weight * sighting.sqrt_weight;
        Moments four;
        std::vector<Eigen::Vector3d> reach;
        for (const Eigen::Vector3d& p : sighting.points_camera) {
            four.add(world_from_camera * p);
            reach.push_back(world_from_camera * (centre + kHalfSide * (p - centre)));
        }
        const Eigen::Vector3d normal = fit_plane(four, world_from_camera.translation()).plane.normal;
        const Box box = bound(plane_axes(normal, reach[0] - reach[2]), reach);
        landmark_.box = landmark_.sightings++ == 0 ? box : united(landmark_.box, box);
        facing_ += weight * normal;
        points_ += Moments{weight * four.count, weight * four.sum, weight * four.scatter};
    }

    Landmark landmark() const {
        Landmark landmark = landmark_;
        landmark.plane = fit_plane(points_).plane;
        if (landmark.plane.normal.dot(facing_) < 0) landmark.plane = landmark.plane.flipped();
        return landmark;
    }

  private:
    Landmark landmark_;
    Moments points_;
    Eigen::Vector3d facing_ = Eigen::Vector3d::Zero();
};

}  // namespace

LandmarkOptions landmark_options(const GraphOptions& options) {
    return {.min_extent_m = options.landmark_extent_m,
            .max_angle_deg = options.landmark_angle_deg,
            .max_distance_m = options.landmark_distance_m,
            .max_gap_m = options.landmark_gap_m,
            .sigma_m = options.landmark_sigma_m};
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
                      const DepthNoise& noise, bool is_placed) {
    double worst = 0;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        const PlanarRegion& region = regions[r];
        const PlaneFit fit = fit_plane(region.moments);
        if (!fit.valid || std::sqrt(fit.variances[1]) < options_.min_extent_m) continue;
        Sighting sighting;
        sighting.node = node;
        sighting.region = static_cast<int>(r);
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
        if (fitting > 1 || !is_placed) {
            sighting.landmark = -1;
            sightings_.push_back(sighting);
            continue;
        }
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
        if (sighting.landmark < 0 || at(sighting.landmark) != next) continue;
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
            if (older.is_surface && newer.is_surface) continue;  // the map knows them for two
            Candidate candidate{newer.plane, newer.box, newer.box.face()};
            for (auto& p : candidate.points) p = newer.plane.project(p);  // the plane moved, the box did not
            if (!fits(candidate, older)) continue;
            older.box = united(older.box, newer.box);
            older.sightings += newer.sightings;
            older.is_surface = older.is_surface || newer.is_surface;
            same_.join(j, i);
            break;
        }
    }
    for (Sighting& sighting : sightings_)
        if (sighting.landmark >= 0) sighting.landmark = same_.find(sighting.landmark);
}

bool Landmarks::adopt(const std::vector<std::vector<int>>& surfaces, const std::vector<Pose>& poses) {
    const std::vector<int> surface_of = surfaces_of_sightings(surfaces);
    std::vector<int> before;
    for (const Sighting& sighting : sightings_) before.push_back(sighting.landmark);
    std::map<std::pair<bool, int>, int> number;  // of surfaces, and of landmarks that are none
    std::vector<LandmarkSum> sums;
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
        Sighting& sighting = sightings_[i];
        const bool is_surface = surface_of[i] >= 0;
        if (!is_surface && sighting.landmark < 0) continue;
        const auto [known, is_new] = number.try_emplace(
            {is_surface, is_surface ? surface_of[i] : sighting.landmark}, static_cast<int>(sums.size()));
        if (is_new) sums.emplace_back(is_surface);
        sighting.landmark = known->second;
        sums[at(sighting.landmark)].add(sighting, poses[at(sighting.node)]);
    }
    landmarks_.clear();
    for (const LandmarkSum& sum : sums) landmarks_.push_back(sum.landmark());
    same_ = UnionFind<int>(landmarks_.size());
    return !are_numbered_alike(before);
}

/// By sighting: what the map says, or else what it says of most others of the same landmark; -1 for nothing.
std::vector<int> Landmarks::surfaces_of_sightings(const std::vector<std::vector<int>>& surfaces) const {
    std::vector<int> surface_of(sightings_.size(), -1);
    std::vector<std::map<int, int>> votes(landmarks_.size());
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
        const Sighting& sighting = sightings_[i];
        const std::vector<int>& planes = surfaces[at(sighting.node)];
        if (sighting.region < 0 || at(sighting.region) >= planes.size()) continue;
        surface_of[i] = planes[at(sighting.region)];
        if (sighting.landmark >= 0 && surface_of[i] >= 0) ++votes[at(sighting.landmark)][surface_of[i]];
    }
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
        if (surface_of[i] >= 0 || sightings_[i].landmark < 0) continue;
        const std::map<int, int>& of_others = votes[at(sightings_[i].landmark)];
        const auto most = std::max_element(of_others.begin(), of_others.end(),
                                           [](auto& a, auto& b) { return a.second < b.second; });
        if (most != of_others.end()) surface_of[i] = most->first;
    }
    return surface_of;
}

/// Whether the sightings share landmarks as they did with other numbers.
bool Landmarks::are_numbered_alike(const std::vector<int>& before) const {
    std::map<int, int> now_of, before_of;
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
        const int now = sightings_[i].landmark;
        if ((now < 0) != (before[i] < 0)) return false;
        if (now < 0) continue;
        if (now_of.try_emplace(before[i], now).first->second != now) return false;
        if (before_of.try_emplace(now, before[i]).first->second != before[i]) return false;
    }
    return true;
}

double Landmarks::worst_error(const std::vector<Pose>& poses) const {
    double worst = 0;
    for (const Sighting& sighting : shared()) {
        const Plane& plane = landmarks_[at(sighting.landmark)].plane;
        worst = std::max(worst, sighting_error(sighting, poses[at(sighting.node)], plane).norm());
    }
    return worst;
}

void Landmarks::hand_over(int gone, int keeper, const Pose& keeper_from_gone) {
    const auto sees = [&](int landmark) {
        return std::any_of(sightings_.begin(), sightings_.end(), [&](const Sighting& sighting) {
            return sighting.node == keeper && sighting.landmark == landmark;
        });
    };
    for (Sighting& sighting : sightings_) {
        if (sighting.node != gone) continue;
        sighting.node = sighting.landmark < 0 || sees(sighting.landmark) ? -1 : keeper;
        sighting.region = -1;
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
        if (sighting.landmark < 0) continue;
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
    for (Sighting& sighting : sightings_)
        if (sighting.landmark >= 0) sighting.landmark = number[at(sighting.landmark)];
}

std::vector<Sighting> Landmarks::shared() const {
    std::vector<Sighting> shared;
    for (const Sighting& sighting : sightings_) {
        if (sighting.landmark >= 0 && landmarks_[at(sighting.landmark)].sightings > 1)
            shared.push_back(sighting);
    }
    return shared;
}

}  // namespace planemap::graph
