// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/plane_judge.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"
#include "core/geometry/outline_frame.hpp"
#include "core/geometry/same_plane.hpp"

namespace planemap::evaluation {

namespace {

constexpr double kParallel_deg = 5, kLeastDistance_m = 0.3, kSameRoom_m = 6;
constexpr double kMergeGap_m = kSamePlaneGap_m, kLeastShare_m2 = 0.05;

/// A plane of the map in the truth's world.
struct Candidate {
    int id = -1;
    Plane plane;
    Pose truth_from_plane = Pose::Identity();
    Outline outline;
    double area = 0;
};

std::vector<Candidate> candidates_of(const PlaneMap& map, const Pose& truth_from_map) {
    std::vector<Candidate> candidates;
    for (const MapPlane& plane : map.planes) {
        Candidate candidate{plane.id, truth_from_map * plane.plane(),
                            truth_from_map * plane.world_from_plane(), plane.outline.rings(), 0};
        candidate.area = area(candidate.outline);
        candidates.push_back(std::move(candidate));
    }
    return candidates;
}

/// The candidate's outline on the true plane.
PlaneRaster raster_on(const TruePlane& truth, const Candidate& candidate) {
    return rasterised(projected(truth.world_from_plane.inverse(Eigen::Isometry) * candidate.truth_from_plane,
                                candidate.outline));
}

/// Square metres of the true plane's visible surface that the candidate covers.
double overlap(const Candidate& candidate, const TruePlane& truth) {
    if (degrees(angle_between(candidate.plane.normal, truth.plane.normal)) > kMaxAngle_deg) return 0;
    const Plane seen_from_truth = truth.world_from_plane.inverse(Eigen::Isometry) * candidate.plane;
    std::size_t cells = 0;
    for_each_cell(raster_on(truth, candidate), [&](int x, int y) {
        if (!truth.visible.at(x, y)) return;
        const Eigen::Vector2d p = truth.visible.cell_centre(x, y);
        cells += std::abs(seen_from_truth.signed_distance({p.x(), p.y(), 0})) <= kMaxDistance_m;
    });
    return static_cast<double>(cells) * PlaneRaster::kCellArea_m2;
}

/// Areas of overlap; row: candidate, column: true plane.
std::vector<std::vector<double>> all_overlaps(const std::vector<Candidate>& candidates,
                                              const std::vector<TruePlane>& truth) {
    std::vector<std::vector<double>> overlaps;
    for (const Candidate& candidate : candidates) {
        std::vector<double>& row = overlaps.emplace_back();
        for (const TruePlane& plane : truth) row.push_back(overlap(candidate, plane));
    }
    return overlaps;
}

/// True for a cell on another part of the same plane: a map plane may well be on both.
bool is_elsewhere(const std::vector<TruePlane>& all, std::size_t column, int x, int y) {
    return std::any_of(all.begin(), all.end(), [&](const TruePlane& other) {
        return &other != &all[column] &&
               other.world_from_plane.matrix() == all[column].world_from_plane.matrix() &&
               other.visible.at(x, y);
    });
}

TruePlaneVerdict verdict_of(const std::vector<TruePlane>& all, std::size_t column,
                            const std::vector<Candidate>& candidates,
                            const std::vector<std::vector<double>>& overlaps) {
    const TruePlane& truth = all[column];
    TruePlaneVerdict verdict;
    verdict.name = truth.name;
    verdict.area = truth.visible.area();
    PlaneRaster outlines;
    std::size_t best = 0;
    double most = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const std::vector<double>& row = overlaps[i];
        if (row[column] <= 0) continue;
        if (row[column] > most) most = row[column], best = i;
        if (row[column] < *std::max_element(row.begin(), row.end())) continue;
        if (row[column] > kLeastArea_m2) verdict.parts.push_back(candidates[i].id);
        outlines = united(outlines, raster_on(truth, candidates[i]));
    }
    if (most == 0) {
        verdict.united_m2 = verdict.area;
        return verdict;
    }
    verdict.best = candidates[best].id;
    verdict.covered = most / verdict.area;
    verdict.found = verdict.covered >= 0.5;
    verdict.angle_deg = degrees(angle_between(candidates[best].plane.normal, truth.plane.normal));
    verdict.distance_m = -candidates[best].plane.signed_distance(truth.centre());
    outlines = united(outlines, raster_on(truth, candidates[best]));
    std::size_t common = 0, beside = 0;
    for_each_cell(outlines, [&](int x, int y) {
        if (truth.visible.at(x, y)) {
            ++common;
        } else {
            beside += !is_elsewhere(all, column, x, y);
        }
    });
    verdict.common_m2 = static_cast<double>(common) * PlaneRaster::kCellArea_m2;
    verdict.united_m2 = verdict.area + static_cast<double>(beside) * PlaneRaster::kCellArea_m2;
    verdict.iou = verdict.common_m2 / verdict.united_m2;
    return verdict;
}

std::vector<SpuriousPlane> spurious_among(const std::vector<Candidate>& candidates,
                                          const std::vector<std::vector<double>>& overlaps) {
    std::vector<SpuriousPlane> spurious;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (candidates[i].area <= kLeastArea_m2) continue;
        double on_true_plane = 0;
        for (const double area : overlaps[i]) on_true_plane += area;
        const double share = std::min(on_true_plane / candidates[i].area, 1.0);
        if (share < 0.5) spurious.push_back({candidates[i].id, candidates[i].area, share});
    }
    return spurious;
}

std::vector<SharedPlane> shared_among(const std::vector<Candidate>& candidates,
                                      const std::vector<std::vector<double>>& overlaps) {
    std::vector<SharedPlane> shared;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        SharedPlane plane{candidates[i].id, {}};
        for (std::size_t column = 0; column < overlaps[i].size(); ++column)
            if (overlaps[i][column] > kLeastShare_m2) plane.shares.push_back({column, overlaps[i][column]});
        std::stable_sort(plane.shares.begin(), plane.shares.end(),
                         [](const auto& a, const auto& b) { return a.area > b.area; });
        if (plane.shares.size() > 1) shared.push_back(std::move(plane));
    }
    return shared;
}

/// Angle between the normals, or between one and the other's opposite if that is less.
double undirected_deg(const Plane& a, const Plane& b) {
    const double angle = degrees(angle_between(a.normal, b.normal));
    return std::min(angle, 180 - angle);
}

/// Mean distance from a point on each of two planes to the other plane.
double distance_between(const Plane& a, const Eigen::Vector3d& on_a, const Plane& b,
                        const Eigen::Vector3d& on_b) {
    return 0.5 * (std::abs(b.signed_distance(on_a)) + std::abs(a.signed_distance(on_b)));
}

/// A found plane with its counterpart.
struct Match {
    std::size_t index = 0;  // of the true plane
    Plane truth, map;
    Eigen::Vector3d centre;  // of the visible surface
};

void measure(const Match& a, const Match& b, Judgement& judgement) {
    if (undirected_deg(a.truth, b.truth) > kParallel_deg) {
        if ((a.centre - b.centre).norm() > kSameRoom_m) return;
        judgement.angles.push_back({a.index, b.index, degrees(angle_between(a.truth.normal, b.truth.normal)),
                                    degrees(angle_between(a.map.normal, b.map.normal))});
        return;
    }
    const double truth = distance_between(a.truth, a.centre, b.truth, b.centre);
    if (truth < kLeastDistance_m) return;
    judgement.distances.push_back(
        {a.index, b.index, truth,
         distance_between(a.map, a.map.project(a.centre), b.map, b.map.project(b.centre))});
}

/// Smallest distance between the visible surfaces of two nearly parallel planes is at most kMergeGap_m.
bool near_each_other(const TruePlane& a, const TruePlane& b) {
    constexpr int kReach = static_cast<int>(kMergeGap_m / PlaneRaster::kCell_m), kStride = 4;
    const Pose b_from_a = b.world_from_plane.inverse(Eigen::Isometry) * a.world_from_plane;
    bool near = false;
    int count = 0;
    for_each_cell(a.visible, [&](int x, int y) {
        if (near || count++ % kStride != 0) return;
        const Eigen::Vector2d p = a.visible.cell_centre(x, y);
        const Eigen::Vector3d q = b_from_a * Eigen::Vector3d(p.x(), p.y(), 0);
        const int column = static_cast<int>(std::floor(q.x() / PlaneRaster::kCell_m));
        const int row = static_cast<int>(std::floor(q.y() / PlaneRaster::kCell_m));
        for (int dy = -kReach; dy <= kReach && !near; dy += kStride)
            for (int dx = -kReach; dx <= kReach && !near; dx += kStride)
                near = dx * dx + dy * dy <= kReach * kReach && b.visible.at(column + dx, row + dy);
    });
    return near;
}

void find_look_alikes(const std::vector<TruePlane>& truth, Judgement& judgement) {
    for (std::size_t i = 0; i < truth.size(); ++i) {
        for (std::size_t j = i + 1; j < truth.size(); ++j) {
            if (!judgement.planes[i].counts() || !judgement.planes[j].counts()) continue;
            const Plane &a = truth[i].plane, &b = truth[j].plane;
            const double angle = degrees(angle_between(a.normal, b.normal));
            if (angle > kMaxAngle_deg) continue;
            const double apart = distance_between(a, truth[i].centre(), b, truth[j].centre());
            if (apart > kMaxDistance_m || !near_each_other(truth[i], truth[j])) continue;
            judgement.look_alikes.push_back({i, j, angle, apart});
        }
    }
}

}  // namespace

Eigen::Vector3d TruePlane::centre() const {
    const Eigen::Vector2d c = visible.centre();
    return world_from_plane * Eigen::Vector3d(c.x(), c.y(), 0);
}

double PairMeasure::error() const {
    return std::abs(map - truth);
}

std::size_t Judgement::seen() const {
    return static_cast<std::size_t>(
        std::count_if(planes.begin(), planes.end(), [](const auto& plane) { return plane.counts(); }));
}

std::size_t Judgement::found() const {
    return static_cast<std::size_t>(std::count_if(
        planes.begin(), planes.end(), [](const auto& plane) { return plane.counts() && plane.found; }));
}

std::size_t Judgement::split() const {
    std::size_t surplus = 0;
    for (const TruePlaneVerdict& plane : planes)
        if (plane.counts() && !plane.parts.empty()) surplus += plane.parts.size() - 1;
    return surplus;
}

std::optional<double> Judgement::outline_iou() const {
    double common = 0, all = 0;
    for (const TruePlaneVerdict& plane : planes) {
        if (!plane.counts() || !plane.found) continue;
        common += plane.common_m2;
        all += plane.united_m2;
    }
    if (all <= 0) return std::nullopt;
    return common / all;
}

Judgement judge(const std::vector<TruePlane>& truth, const PlaneMap& map, const Pose& truth_from_map) {
    const std::vector<Candidate> candidates = candidates_of(map, truth_from_map);
    const std::vector<std::vector<double>> overlaps = all_overlaps(candidates, truth);
    Judgement judgement;
    std::vector<Match> matches;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const TruePlaneVerdict& verdict =
            judgement.planes.emplace_back(verdict_of(truth, i, candidates, overlaps));
        if (!verdict.found || !verdict.counts()) continue;
        const auto best = std::find_if(candidates.begin(), candidates.end(),
                                       [&](const Candidate& c) { return c.id == verdict.best; });
        matches.push_back({i, truth[i].plane, best->plane, truth[i].centre()});
    }
    judgement.spurious = spurious_among(candidates, overlaps);
    judgement.shared = shared_among(candidates, overlaps);
    for (std::size_t i = 0; i < matches.size(); ++i)
        for (std::size_t j = i + 1; j < matches.size(); ++j) measure(matches[i], matches[j], judgement);
    find_look_alikes(truth, judgement);
    return judgement;
}

}  // namespace planemap::evaluation
