// SPDX-License-Identifier: BSD-3-Clause
#include "graph/redundancy.hpp"

#include <algorithm>

#include "graph/verification_options.hpp"
#include "places/comparison.hpp"

namespace planemap::graph {

std::optional<int> Redundancy::next(const Keyframes& keyframes) const {
    constexpr int kRecent = 24;  // newest keyframes, which all stay
    if (options_.max_alike == 0) return std::nullopt;
    for (int node = 0; node <= keyframes.newest() - kRecent; ++node) {
        if (keyframes[node].id > asked_up_to_) return node;
    }
    return std::nullopt;
}

std::vector<int> Redundancy::about(int node, const Keyframes& keyframes, const Topology& topology) {
    asked_up_to_ = keyframes[node].id;
    const std::vector<int> place = place_of(node, keyframes, topology);
    std::vector<int> ids;
    for (std::size_t i = 1; i < place.size(); ++i) {
        if (!is_alike(place[i], node, keyframes)) continue;
        std::vector<int>& alike = alike_[keyframes[place[i]].id];
        std::erase_if(alike, [&](int id) { return keyframes.node_of(id) < 0; });
        alike.push_back(keyframes[node].id);
        if (alike.size() >= at(options_.max_alike)) ids.push_back(keyframes[place[i]].id);
    }
    for (std::size_t i = place.size(); i-- > 1 && place.size() - ids.size() > at(options_.max_place);) {
        const int id = keyframes[place[i]].id;
        if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
    }
    return ids;
}

/// The keyframes that stood where this older one did, itself included, the newest first. Only where the poses
/// say so for certain.
std::vector<int> Redundancy::place_of(int node, const Keyframes& keyframes, const Topology& topology) const {
    const double reach = options_.place_share * mean_depth(keyframes[node].view);
    const std::vector<Drift> drifts = topology.drifts_from(node);
    std::vector<int> place;
    for (int i = node; i >= 0; --i) {
        const Pose apart = keyframes.between(i, node);
        const double metres = std::max(apart.translation().norm(), drifts[at(i)].metres);
        const double radians = std::max(rotation_angle(apart), drifts[at(i)].radians);
        if (i == node || (metres < reach && radians < options_.place_rad)) place.push_back(i);
    }
    return place;
}

/// Whether two keyframes of one place show the same: the same points or, where there are none, the same
/// planes; and neither saw through what the other saw.
bool Redundancy::is_alike(int a, int b, const Keyframes& keyframes) const {
    constexpr int kFewPoints = 20;
    constexpr double kSlack_m = 0.02;
    const places::KeyframeView &view_a = keyframes[a].view, &view_b = keyframes[b].view;
    const Pose a_from_b = keyframes.between(a, b);
    const places::PointAgreement points =
        compare_points(view_a, view_b, a_from_b, verification_options(options_), kSlack_m);
    const bool is_bare = view_a.points.size() < kFewPoints && view_b.points.size() < kFewPoints;
    if (!is_bare && points.agree < std::max<double>(kFewPoints, options_.min_alike_ratio * points.visible))
        return false;
    const places::PlaneAgreement planes = compare_planes(view_a, view_b, a_from_b, kSlack_m);
    if (is_bare && planes.agree == 0) return false;
    return planes.contradict <= options_.max_contradiction * (planes.agree + planes.contradict);
}

}  // namespace planemap::graph
