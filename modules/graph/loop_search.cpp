// SPDX-License-Identifier: BSD-3-Clause
#include "graph/loop_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "graph/surroundings.hpp"

namespace planemap::graph {

namespace {

constexpr double kRivalScore = 0.25;  // of the likeness of what was found, that a rival has at least

/// The nodes of the highest scores of at least `least`, none beside another.
std::vector<int> peaks(const std::vector<double>& scores, double least, int count) {
    std::vector<int> order;
    for (int i = 0; i < static_cast<int>(scores.size()); ++i) {
        if (scores[at(i)] >= least && scores[at(i)] > 0) order.push_back(i);
    }
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return scores[at(a)] > scores[at(b)]; });
    std::vector<int> chosen;
    for (const int node : order) {
        if (static_cast<int>(chosen.size()) >= count) break;
        const bool beside =
            std::any_of(chosen.begin(), chosen.end(), [&](int other) { return std::abs(other - node) <= 2; });
        if (!beside) chosen.push_back(node);
    }
    return chosen;
}

/// How far a loop closure moves the newest: metres plus radians.
double jump(const Pose& expected, const Pose& node_from_newest) {
    return (expected.translation() - node_from_newest.translation()).norm() +
           rotation_angle(expected.inverse(Eigen::Isometry) * node_from_newest);
}

}  // namespace

void LoopSearch::remove(int node, const places::KeyframeView& view) {
    index_.remove(place_of_[at(node)], view.descriptors);
    place_of_.erase(place_of_.begin() + node);
}

std::vector<int> LoopSearch::candidates(const Keyframes& keyframes, const Topology& topology,
                                        const std::vector<Drift>& drifts) const {
    const std::vector<bool> near = topology.within_steps(keyframes.newest(), options_.min_separation);
    std::vector<int> found = peaks(appearance_scores(keyframes.back().view, near), options_.min_appearance,
                                   options_.appearance_candidates);
    for (const int node :
         peaks(place_scores(keyframes, near, drifts), options_.min_overlap, options_.place_candidates)) {
        if (std::find(found.begin(), found.end(), node) == found.end()) found.push_back(node);
    }
    return found;
}

std::vector<double> LoopSearch::appearance_scores(const places::KeyframeView& view,
                                                  const std::vector<bool>& near) const {
    const std::vector<double> by_place = index_.scores(view.descriptors);
    std::vector<double> scores(place_of_.size(), 0.0);
    for (std::size_t i = 0; i < scores.size(); ++i) {
        if (!near[i]) scores[i] = by_place[at(place_of_[i])];
    }
    return scores;
}

/// Share of the newest view that each node should see too; 0 where drift leaves that open.
std::vector<double> LoopSearch::place_scores(const Keyframes& keyframes, const std::vector<bool>& near,
                                             const std::vector<Drift>& drifts) const {
    constexpr double kFarthest = 4.0;  // metres between two cameras that see the same from alike
    const int newest = keyframes.newest();
    std::vector<double> scores(place_of_.size(), 0.0);
    for (int i = 0; i <= newest; ++i) {
        if (near[at(i)] || drifts[at(i)].metres > options_.max_place_drift_m) continue;
        if ((keyframes.pose(i).translation() - keyframes.pose(newest).translation()).norm() > kFarthest)
            continue;
        const Pose node_from_newest = keyframes.between(i, newest);
        if (node_from_newest.linear()(2, 2) < 0.5) continue;  // optical axes more than 60 degrees apart
        scores[at(i)] = std::min(
            overlap(keyframes[i].view, keyframes.back().view, node_from_newest),
            overlap(keyframes.back().view, keyframes[i].view, node_from_newest.inverse(Eigen::Isometry)));
    }
    return scores;
}

std::optional<places::Verification> LoopSearch::verified(int node, const Keyframes& keyframes,
                                                         const Topology& topology,
                                                         const std::vector<Drift>& drifts) const {
    std::optional<places::Verification> found =
        closure(node, keyframes, topology, drifts, verification_options(options_));
    if (!found || has_rival(node, keyframes, topology, drifts, *found)) return std::nullopt;
    if (is_seen_elsewhere(node, keyframes, topology, *found)) return std::nullopt;
    return found;
}

/// What a node explains by itself.
std::optional<places::Verification> LoopSearch::closure(int node, const Keyframes& keyframes,
                                                        const Topology& topology,
                                                        const std::vector<Drift>& drifts,
                                                        const places::VerificationOptions& options) const {
    const auto seed = static_cast<std::uint64_t>(node) << 32 | static_cast<std::uint64_t>(keyframes.newest());
    const places::Verification found = verify(keyframes[node].view, keyframes.back().view, options, seed);
    if (found.verdict != places::Verdict::kAccepted) return std::nullopt;
    const Pose expected = keyframes.between(node, keyframes.newest());
    if (!fits_odometry(expected, drifts[at(node)], found.a_from_b)) return std::nullopt;
    if (!fits_surroundings(node, keyframes, topology, drifts, found.a_from_b)) return std::nullopt;
    return found;
}

/// Whether another node, one that does not see what the found one sees, puts the newest elsewhere: farther
/// than drift between the two nodes explains. Asked only where a false closure would do harm: it moves the
/// newest far, or odometry does not know where it is.
bool LoopSearch::has_rival(int node, const Keyframes& keyframes, const Topology& topology,
                           const std::vector<Drift>& drifts, const places::Verification& found) const {
    const int newest = keyframes.newest();
    const bool is_open = drifts[at(node)].metres > options_.max_place_drift_m;
    if (!is_open && jump(keyframes.between(node, newest), found.a_from_b) < options_.surroundings_from_m)
        return false;
    const Pose world_from_newest = keyframes.pose(node) * found.a_from_b;
    std::vector<double> scores =
        appearance_scores(keyframes.back().view, topology.within_steps(newest, options_.min_separation));
    const double least = std::max(options_.min_appearance, kRivalScore * scores[at(node)]);
    for (int i = 0; i <= newest; ++i) {
        if (scores[at(i)] < least) continue;
        const Pose i_from_newest = keyframes.pose(i).inverse(Eigen::Isometry) * world_from_newest;
        if (i == node || looks_at_the_same(keyframes[i].view, keyframes.back().view, i_from_newest))
            scores[at(i)] = 0;
    }
    const places::VerificationOptions options = rival_options(verification_options(options_), found);
    const std::vector<Drift> of_node = topology.drifts_from(node);
    UnionFind<int> parts = topology.parts();
    for (const int other : peaks(scores, least, options_.appearance_candidates)) {
        const auto rival = closure(other, keyframes, topology, drifts, options);
        if (!rival) continue;
        // A component that nobody could tie to an older one is no witness of where its places are: it may be
        // an alias of what the older one saw.
        const int part = parts.find(other);
        if (part < parts.find(node) && part != parts.find(newest)) return true;
        if (!fits_odometry(world_from_newest, of_node[at(other)], keyframes.pose(other) * rival->a_from_b))
            return true;
    }
    return false;
}

/// Where a loop closure would join two components: whether another node of the newest one's component sees
/// what the node sees and puts that elsewhere. The other way round has_rival() asks.
bool LoopSearch::is_seen_elsewhere(int node, const Keyframes& keyframes, const Topology& topology,
                                   const places::Verification& found) const {
    UnionFind<int> parts = topology.parts();
    const int newest = keyframes.newest();
    if (parts.find(node) == parts.find(newest)) return false;
    const places::KeyframeView& view = keyframes[node].view;
    const Pose world_from_node = keyframes.pose(newest) * found.a_from_b.inverse(Eigen::Isometry);
    std::vector<double> scores = appearance_scores(view, std::vector<bool>(place_of_.size(), false));
    const double least = std::max(options_.min_appearance, kRivalScore * scores[at(newest)]);
    for (int i = 0; i <= newest; ++i) {
        const Pose i_from_node = keyframes.pose(i).inverse(Eigen::Isometry) * world_from_node;
        if (i == newest || parts.find(i) != parts.find(newest) ||
            looks_at_the_same(keyframes[i].view, view, i_from_node))
            scores[at(i)] = 0;
    }
    const places::VerificationOptions options = rival_options(verification_options(options_), found);
    for (const int other : peaks(scores, least, options_.appearance_candidates)) {
        const auto seed = static_cast<std::uint64_t>(other) << 32 | static_cast<std::uint64_t>(node);
        const places::Verification rival = verify(keyframes[other].view, view, options, seed);
        if (rival.verdict == places::Verdict::kAccepted &&
            places::are_apart(keyframes.pose(other) * rival.a_from_b, world_from_node))
            return true;
    }
    return false;
}

bool LoopSearch::fits_odometry(const Pose& expected, const Drift& drift, const Pose& node_from_newest) const {
    return (expected.translation() - node_from_newest.translation()).norm() <=
               options_.drift_base_m + drift.metres &&
           rotation_angle(expected.inverse(Eigen::Isometry) * node_from_newest) <=
               options_.drift_base_rad + drift.radians;
}

/// Whether what was seen about the node can be what was seen about the newest one, if these two are where the
/// closure says. Asked only of a closure that moves the newest so far that a false one would matter; the
/// farther it moves, the wider drift lets us look around.
bool LoopSearch::fits_surroundings(int node, const Keyframes& keyframes, const Topology& topology,
                                   const std::vector<Drift>& drifts, const Pose& node_from_newest) const {
    const int newest = keyframes.newest();
    const double moves_by = jump(keyframes.between(node, newest), node_from_newest);
    if (moves_by < options_.surroundings_from_m) return true;
    const double reach = std::min(1.0, moves_by / 3);
    const std::vector<Drift> of_node = topology.drifts_from(node);
    const Pose move =
        keyframes.pose(node) * node_from_newest * keyframes.pose(newest).inverse(Eigen::Isometry);
    // Where odometry may have gone astray all the way in between, a node belongs to the nearer end only.
    const bool apart = 2 * drifts[at(node)].metres > moves_by;
    std::vector<SurroundingView> older, newer;
    for (int i = 0; i < newest; ++i) {
        if (i == node) continue;
        const double to_newest = drifts[at(i)].metres, to_node = of_node[at(i)].metres;
        if (to_newest < reach && (!apart || to_newest < to_node))
            newer.push_back({&keyframes[i].view, move * keyframes.pose(i), to_newest});
        if (to_node < reach && (!apart || to_newest >= to_node))
            older.push_back({&keyframes[i].view, keyframes.pose(i), to_node});
    }
    return compare_surroundings(older, newer, verification_options(options_)).fit();
}

}  // namespace planemap::graph
